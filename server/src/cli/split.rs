//! `coin-server split`: one thing was two.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::{ArgGroup, Args};
use coin::map::detection::Sighting;
use coin::map::entry::SightingId;
use coin_schemas::tools::display_name;
use jiff::civil::DateTime;

use super::{Failure, failed, open, print, refused, say};
use crate::display::plain_text;
use crate::store::{Access, SplitFailure, StoreError, StoredObject};

/// So many sightings are listed, the latest ones.
const LISTED: u32 = 1_000;

const EXAMPLES: &str = "\
Examples:
  coin-server split thing-7 --db home.db                       # list its sightings; nothing is changed
  coin-server split thing-7 --sightings 31,40-52 --db home.db  # make another thing of these
  coin-server split thing-7 --since 2025-01-19T19:00:00        # or of all since then

The thing keeps its id, its owner and what was seen to be done with it. The map never joins the two again.

Exit status: 0 done; 1 failed; 2 wrong use, an unknown thing, or sightings that it does not have.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, group = ArgGroup::new("which"))]
pub(super) struct Split {
    /// The id of the thing
    #[arg(value_name = "OBJECT")]
    object: String,
    /// The sightings of the other thing: numbers and ranges with commas between them
    #[arg(long, value_name = "N,N-M", group = "which")]
    sightings: Option<Numbers>,
    /// All sightings since this local time are of the other thing
    #[arg(long, value_name = "TIME", group = "which")]
    since: Option<DateTime>,
    /// The home's database [default: home.db in the user's data folder]
    #[arg(long, value_name = "FILE")]
    db: Option<PathBuf>,
}

/// Numbers of sightings.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Numbers(Vec<std::ops::RangeInclusive<u64>>);

impl std::str::FromStr for Numbers {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| {
            text.trim().parse::<u64>().map_err(|_| format!("{text:?} is no number; give them as in 31,40-52"))
        };
        let ranges = text.split(',').map(|part| match part.split_once('-') {
            Some((first, last)) => {
                let (first, last) = (number(first)?, number(last)?);
                if first > last { Err(format!("{part:?} ends before it begins")) } else { Ok(first..=last) }
            }
            None => number(part).map(|number| number..=number),
        });
        ranges.collect::<Result<_, _>>().map(Self)
    }
}

pub(super) fn run(arguments: &Split) -> Result<(), Failure> {
    let is_look = arguments.sightings.is_none() && arguments.since.is_none();
    let store = open(arguments.db.as_deref(), if is_look { Access::ReadOnly } else { Access::ReadWrite })?;
    let (object, sightings) = store
        .read(|reader| {
            let Some(object) = reader.object(&arguments.object)? else { return Ok(None) };
            let sightings = reader.latest_sightings(object.key, u32::MAX)?;
            Ok::<_, StoreError>(Some((object, sightings)))
        })
        .map_err(failed)?
        .ok_or_else(|| {
            refused(format!(
                "there is no object {:?}; coin-server map lists the things and their ids",
                arguments.object
            ))
        })?;
    if is_look {
        return print(&listed(&object, &sightings));
    }
    let is_meant = |number: SightingId, sighting: &Sighting| match (&arguments.sightings, arguments.since) {
        (Some(Numbers(ranges)), _) => ranges.iter().any(|range| range.contains(&number.0)),
        (None, Some(since)) => sighting.at >= since,
        (None, None) => false,
    };
    let meant: BTreeSet<SightingId> = sightings
        .iter()
        .filter(|(number, sighting)| is_meant(*number, sighting))
        .map(|(number, _)| *number)
        .collect();
    if meant.is_empty() || meant.len() == sightings.len() {
        let some = if meant.is_empty() { "none" } else { "all" };
        return Err(refused(format!(
            "{some} of the {} sightings of {:?} are meant, and both things need one; list them with \
             coin-server split {:?}",
            sightings.len(),
            object.id.as_str(),
            object.id.as_str(),
        )));
    }
    let id = store.split(object.key, &meant).map_err(|source| match source {
        SplitFailure::Refused(reason) => refused(reason),
        other => failed(other),
    })?;
    say(&format!(
        "{} of {} sightings of {} are now the thing {}.",
        meant.len(),
        sightings.len(),
        object.id,
        id
    ));
    print(&format!("{id}\n"))
}

fn listed(object: &StoredObject, sightings: &[(SightingId, Sighting)]) -> String {
    if sightings.is_empty() {
        return format!(
            "{} ({}) was recorded and has not been detected since.\n",
            plain_text(object.id.as_str()),
            plain_text(&display_name(&object.class))
        );
    }
    let omitted = sightings.len().saturating_sub(LISTED as usize);
    let mut text =
        format!("{:>9}  {:<23}  {:>24}  {:<16}  view\n", "sighting", "seen at", "position, m", "class");
    for (number, Sighting { class, position, at, view, .. }) in &sightings[omitted..] {
        let [x, y, z] = position.metres();
        let view = view.as_ref().map_or("–".into(), |view| plain_text(&view.0));
        let place = format!("{x:.3}, {y:.3}, {z:.3}");
        let (at, class) = (at.to_string(), plain_text(class.as_str()));
        text += &format!("{:>9}  {at:<23}  {place:>24}  {class:<16}  {view}\n", number.0);
    }
    if omitted > 0 {
        text += &format!("{omitted} earlier ones are not listed.\n");
    }
    text
}
