//! What goes wrong at a scripted provider, and when.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::brain::Turn;

/// Something that goes wrong. One that does not fit the turn, such as wrong scores where a tool is called, does not
/// happen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The JSON stands in a fenced block.
    CodeFences,
    /// The JSON stands between sentences.
    Prose,
    /// The JSON has commas before closing braces.
    TrailingCommas,
    /// One member of the household is left out.
    MissingPeople,
    /// Somebody is named who is no member.
    InventedPeople,
    /// Scores are texts, such as `"0.8"`.
    ScoresAsText,
    /// Scores are percentages, such as `"80%"`.
    ScoresAsPercentages,
    /// Scores are above 1.
    ScoresAboveOne,
    /// Scores are `NaN`, which is no JSON.
    ScoresNotNumbers,
    /// All scores are the same.
    ScoresAllEqual,
    /// A tool is called that was not offered.
    UnknownTool,
    /// A tool is called with arguments that it does not have.
    WrongArguments,
    /// A tool is called with arguments that are no JSON object.
    MalformedArguments,
    /// The first call is made again, whatever it was answered.
    SameCallAgain,
    /// Nothing is said.
    Empty,
    /// The model refuses.
    Refusal,
    /// The turn is cut in the middle, because it is too long.
    CutShort,
    /// An error of this HTTP status.
    Status(u16),
    /// 429, with or without the time to wait.
    RateLimited(Option<RetryAfter>),
    /// 429 because nothing is left of what was paid; for Anthropic 400.
    QuotaUsedUp,
    /// The connection is reset in the middle of the answer.
    Reset,
    /// The answer never ends.
    EndlessBody,
    /// The answer never begins.
    Silence,
    /// 200, with a web page.
    Html,
    /// 200, with JSON that is no answer.
    OtherJson,
    /// 307 to another place.
    Redirect,
}

/// How a provider says how long it wants to be left alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RetryAfter {
    /// `Retry-After` in seconds.
    Seconds(u64),
    /// `retry-after-ms`.
    Milliseconds(u64),
    /// `Retry-After` as a date so long from now; dates know whole seconds only.
    Date(Duration),
}

/// How a parameter is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manner {
    /// The error names it.
    Named,
    /// The error names nothing.
    Unnamed,
}

/// A request for which a plan decides what goes wrong.
#[derive(Debug)]
pub struct Occasion<'a> {
    /// Which request it is, from 1.
    pub number: usize,
    /// How often the very same request came before.
    pub repetitions: usize,
    /// What is asked.
    pub turn: &'a Turn,
    /// Chance that follows from the script's seed, from what is asked and from the repetitions, so that requests
    /// may come in any order.
    pub chance: ChaCha8Rng,
}

type Decide = dyn Fn(&mut Occasion<'_>) -> Option<Fault> + Send + Sync;

/// Decides what goes wrong.
#[derive(Clone)]
pub struct FaultPlan(Arc<Decide>);

impl FaultPlan {
    /// Decides by a function.
    pub fn of(decide: impl Fn(&mut Occasion<'_>) -> Option<Fault> + Send + Sync + 'static) -> Self {
        Self(Arc::new(decide))
    }

    /// Nothing goes wrong.
    pub fn none() -> Self {
        Self::of(|_| None)
    }

    /// The same goes wrong every time.
    pub fn always(fault: Fault) -> Self {
        Self::of(move |_| Some(fault))
    }

    /// The same goes wrong with the first so many requests.
    pub fn first(count: usize, fault: Fault) -> Self {
        Self::of(move |occasion| (occasion.number <= count).then_some(fault))
    }

    /// The same goes wrong every time that something is asked for the first time.
    pub fn once_each(fault: Fault) -> Self {
        Self::of(move |occasion| (occasion.repetitions == 0).then_some(fault))
    }

    /// What goes wrong with the first requests, one after the other; after that, nothing.
    pub fn script(faults: Vec<Option<Fault>>) -> Self {
        Self::of(move |occasion| faults.get(occasion.number - 1).copied().flatten())
    }

    /// One of these goes wrong in so large a share of all requests.
    pub fn share(share: f64, faults: Vec<Fault>) -> Self {
        assert!(!faults.is_empty(), "a share of no faults");
        Self::of(move |occasion| {
            let happens = occasion.chance.random_bool(share);
            let which = occasion.chance.random_range(0..faults.len());
            happens.then(|| faults[which])
        })
    }

    pub(super) fn decide(&self, occasion: &mut Occasion<'_>) -> Option<Fault> {
        (self.0)(occasion)
    }
}

impl fmt::Debug for FaultPlan {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("FaultPlan")
    }
}
