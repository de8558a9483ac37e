//! The map of the home, to be looked at: whose every thing is held to be, as a page, as text or as JSON.

mod page;
#[cfg(test)]
mod tests;
mod text;

use coin_schemas::household::{Owners, Source};
use coin_schemas::map::{HomeMap, MappedObject};

use crate::display::{belief_in_words, count, owners_in_words, percent};
use crate::scene::Scene;
use crate::store::{Store, StoreError};

pub(crate) use page::page;
pub(crate) use text::text;

/// Judges every thing of the home as `whose_is` does, in one look at it.
///
/// # Errors
/// If nobody lives there, and failures of the database.
pub(crate) fn survey(store: &Store) -> Result<HomeMap, StoreError> {
    store.read(|reader| {
        let scene = Scene::new(reader)?;
        let roster = scene.household().roster();
        let judged = scene.judgements()?.map(|judged| {
            let (object, judgement) = judged?;
            Ok(MappedObject {
                id: object.id.clone(),
                class: object.class.clone(),
                room: object.room.clone(),
                position: object.shown_position(),
                owners: roster.owners(judgement.reading.owners),
                owner_outside_household: judgement.reading.outside_household,
                confidence: judgement.confidence,
                settled: judgement.is_settled(),
                source: judgement.source(),
            })
        });
        let mut objects = judged.collect::<Result<Vec<MappedObject>, StoreError>>()?;
        objects.sort_by(|left, right| {
            let place =
                |object: &MappedObject| (object.room.is_none(), object.room.clone(), object.class.clone());
            place(left).cmp(&place(right))
        });
        Ok(HomeMap { name: reader.recording()?, as_of: scene.present()?, users: roster.users(), objects })
    })
}

/// The owners in words.
fn whose(object: &MappedObject, household: &Owners) -> String {
    let named = owners_in_words(&object.owners, household);
    match object.owner_outside_household && !object.owners.is_empty() {
        true => format!("{named} and somebody outside"),
        false => named,
    }
}

/// Whose it is and how sure that is.
fn said(object: &MappedObject, household: &Owners) -> String {
    belief_in_words(&whose(object, household), object.confidence, object.source)
}

/// What the conclusion rests on, and what is left open.
fn basis(object: &MappedObject) -> &'static str {
    match (object.source, object.settled) {
        (Source::Answer, _) => "by answer",
        (Source::Inferred, true) => "inferred",
        (Source::Inferred, false) => "inferred; worth a question",
    }
}

/// The place in metres, to a tenth.
fn place(object: &MappedObject) -> String {
    let [x, y, z] = object.position.metres().map(|metres| format!("{metres:.1}"));
    format!("{x}, {y}, {z}")
}

/// How many things are known from what.
struct Counts {
    things: u64,
    by_answer: u64,
    inferred: u64,
    open: u64,
}

impl Counts {
    fn of(objects: &[MappedObject]) -> Self {
        let number =
            |is_meant: fn(&MappedObject) -> bool| objects.iter().filter(|object| is_meant(object)).count();
        Self {
            things: objects.len() as u64,
            by_answer: number(|object| object.source == Source::Answer) as u64,
            inferred: number(|object| object.source == Source::Inferred && object.settled) as u64,
            open: number(|object| !object.settled) as u64,
        }
    }

    fn in_words(&self) -> String {
        let Self { things, by_answer, inferred, open } = *self;
        let number = |number, what| count(number, what, what);
        [
            format!("{}: {}", count(things, "thing", "things"), number(by_answer, "by answer")),
            number(inferred, "inferred"),
            format!("{}.", number(open, "worth a question")),
        ]
        .join(", ")
    }
}
