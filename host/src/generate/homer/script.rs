//! The scripts of HOMER: an activity, step by step.

use std::fs;
use std::ops::RangeInclusive;
use std::path::Path;

use coin_schemas::household::ClassLabel;

use super::data::class_label;
use super::error::HomerError;
use super::sampler::Second;
use crate::generate::sessions::{Action, Putting};

/// The ways of using HOMER's things, in the order in which [`Verb::action`] numbers them.
pub(super) const USES: &[&str] = &["turns on", "turns off", "opens", "closes", "reads", "drinks from"];

/// The lines that may stand before the first step: a title and a description.
const HEADER_LINES: usize = 2;

/// What a step does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Verb {
    /// Closes it.
    Close,
    /// Drinks from it.
    Drink,
    /// Looks for it.
    Find,
    /// Takes it.
    Grab,
    /// Looks at it.
    LookAt,
    /// Opens it.
    Open,
    /// Puts it on something.
    PutBack,
    /// Puts it into something.
    PutIn,
    /// Puts it where it was.
    PutObjBack,
    /// Reads it.
    Read,
    /// Sits down on it.
    Sit,
    /// Gets up.
    StandUp,
    /// Turns it off.
    SwitchOff,
    /// Turns it on.
    SwitchOn,
    /// Turns to it.
    TurnTo,
    /// Walks to it.
    Walk,
}

impl Verb {
    /// Every verb.
    pub(super) const ALL: [Self; 16] = [
        Self::Close,
        Self::Drink,
        Self::Find,
        Self::Grab,
        Self::LookAt,
        Self::Open,
        Self::PutBack,
        Self::PutIn,
        Self::PutObjBack,
        Self::Read,
        Self::Sit,
        Self::StandUp,
        Self::SwitchOff,
        Self::SwitchOn,
        Self::TurnTo,
        Self::Walk,
    ];

    /// The verb as scripts have it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Close => "CLOSE",
            Self::Drink => "DRINK",
            Self::Find => "FIND",
            Self::Grab => "GRAB",
            Self::LookAt => "LOOKAT",
            Self::Open => "OPEN",
            Self::PutBack => "PUTBACK",
            Self::PutIn => "PUTIN",
            Self::PutObjBack => "PUTOBJBACK",
            Self::Read => "READ",
            Self::Sit => "SIT",
            Self::StandUp => "STANDUP",
            Self::SwitchOff => "SWITCHOFF",
            Self::SwitchOn => "SWITCHON",
            Self::TurnTo => "TURNTO",
            Self::Walk => "WALK",
        }
    }

    /// The names of all verbs, as an error lists them.
    pub(super) fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }

    /// How many things a step with it has.
    fn things(self) -> usize {
        match self {
            Self::StandUp => 0,
            Self::PutBack | Self::PutIn => 2,
            _ => 1,
        }
    }

    /// The same in words.
    pub(super) fn takes(self) -> &'static str {
        match self.things() {
            0 => "no thing",
            1 => "one thing",
            _ => "a thing and where it goes",
        }
    }

    /// How long a step with it takes, at least and at most.
    ///
    /// The executable scripts say nothing of time. The ranges are ours, after those that HOMER's participants gave with
    /// the scripts as they wrote them: a handful of steps in one or two minutes, and by far the longest time where
    /// somebody sits down (at a meal, at the computer, before the television) or reads.
    pub(super) fn seconds(self) -> RangeInclusive<Second> {
        match self {
            Self::Sit => 15 * 60..=60 * 60,
            Self::Read => 10 * 60..=15 * 60,
            Self::Drink => 60..=3 * 60,
            _ => 20..=40,
        }
    }

    /// What is seen of a step with it. Walking, sitting, looking at a thing and turning to it do not handle it.
    pub(super) fn action(self) -> Option<Action> {
        match self {
            Self::Find => Some(Action::Search),
            Self::Grab => Some(Action::Take),
            Self::PutBack | Self::PutObjBack => Some(Action::Place(Putting::Back)),
            Self::PutIn => Some(Action::Place(Putting::Away)),
            Self::SwitchOn => Some(Action::Use(0)),
            Self::SwitchOff => Some(Action::Use(1)),
            Self::Open => Some(Action::Use(2)),
            Self::Close => Some(Action::Use(3)),
            Self::Read => Some(Action::Use(4)),
            Self::Drink => Some(Action::Use(5)),
            Self::LookAt | Self::Sit | Self::StandUp | Self::TurnTo | Self::Walk => None,
        }
    }
}

/// One step of a script.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ScriptStep {
    pub(super) verb: Verb,
    /// The class of the thing that is handled, where there is one.
    pub(super) class: Option<String>,
}

/// One way to do an activity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Script {
    /// The name of its file.
    pub(super) name: String,
    /// At least one.
    pub(super) steps: Vec<ScriptStep>,
}

impl Script {
    /// How long it takes at least.
    pub(super) fn shortest(&self) -> Second {
        self.steps.iter().map(|step| *step.verb.seconds().start()).sum()
    }

    /// How long it takes at most.
    pub(super) fn longest(&self) -> Second {
        self.steps.iter().map(|step| *step.verb.seconds().end()).sum()
    }

    /// When each step begins, from the beginning of the script, if the whole takes so long. What there is above the
    /// shortest time goes to the steps in the proportion of their ranges.
    pub(super) fn beginnings(&self, whole: Second) -> impl Iterator<Item = (Second, &ScriptStep)> {
        let shortest = self.shortest();
        let slack = u64::from(self.longest() - shortest).max(1);
        let extra = u64::from(whole.saturating_sub(shortest)).min(slack);
        let (mut least, mut most) = (0, 0);
        self.steps.iter().map(move |step| {
            let stretched = u64::from(most - least) * extra / slack;
            let begins = least + Second::try_from(stretched).unwrap_or(most - least);
            let range = step.verb.seconds();
            least += range.start();
            most += range.end();
            (begins, step)
        })
    }
}

/// Reads a text file, or says what is wrong with it.
pub(super) fn read_text(path: &Path) -> Result<String, HomerError> {
    let bytes = fs::read(path).map_err(|reason| HomerError::Read { path: path.to_owned(), reason })?;
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = good.iter().filter(|&&byte| byte == b'\n').count() + 1;
        HomerError::NotText { path: path.to_owned(), line }
    })
}

/// Reads one script: a title, a description, and the steps.
pub(super) fn read(path: &Path) -> Result<Script, HomerError> {
    let text = read_text(path)?;
    let mut steps: Vec<ScriptStep> = Vec::new();
    let mut header = 0;
    for (place, line) in text.lines().map(str::trim).enumerate().filter(|(_, line)| !line.is_empty()) {
        let looks_like_a_step = line.contains(['[', ']', '<', '>']);
        if steps.is_empty() && header < HEADER_LINES && !looks_like_a_step {
            header += 1;
            continue;
        }
        steps.push(step(line, path, place + 1)?);
    }
    if steps.is_empty() {
        return Err(HomerError::Empty { path: path.to_owned(), what: "no step" });
    }
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Script { name, steps })
}

/// `[VERB] <thing> (id) <other thing> (id) [number]`: the first thing is the one that is handled.
fn step(line: &str, path: &Path, number: usize) -> Result<ScriptStep, HomerError> {
    let refuse =
        || HomerError::Step { path: path.to_owned(), line: number, given: line.chars().take(80).collect() };
    let (verb, rest) = line.strip_prefix('[').and_then(|line| line.split_once(']')).ok_or_else(refuse)?;
    let verb =
        Verb::ALL.into_iter().find(|known| known.name() == verb).ok_or_else(|| HomerError::UnknownVerb {
            path: path.to_owned(),
            line: number,
            given: verb.chars().take(40).collect(),
        })?;
    let things = things(rest).ok_or_else(refuse)?;
    if things.len() != verb.things() {
        return Err(HomerError::Things { path: path.to_owned(), line: number, verb, given: things.len() });
    }
    Ok(ScriptStep { verb, class: things.into_iter().next() })
}

/// The things of a step, as classes; `None` where this is not their form.
fn things(text: &str) -> Option<Vec<String>> {
    let mut things = Vec::new();
    let mut rest = text.trim_start();
    while let Some(thing) = rest.strip_prefix('<') {
        let (name, after) = thing.split_once('>')?;
        let (id, after) = after.trim_start().strip_prefix('(')?.split_once(')')?;
        id.trim().parse::<u64>().ok()?;
        things.push(ClassLabel::new(class_label(name)).ok()?.as_str().to_owned());
        rest = after.trim_start();
    }
    let numbered = rest.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
    (rest.is_empty() || numbered.is_some_and(|number| number.parse::<u64>().is_ok())).then_some(things)
}
