//! The home as the evidence model sees it: fetched once in a run, and judged as a whole after every answer.

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZero;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use coin::common_sense::{Expectation, expect};
use coin::evidence::home::{HomeEvidence, HomeJudgement, SeenThing, ThingEvidence, Told};
use coin::evidence::{EvidenceParameters, Opinion};
use coin::owners::{OwnerSet, OwnerSetDistribution};
use coin::roster::{Roster, RosterError};
use coin_schemas::household::{ObjectId, Score};
use coin_schemas::model::TaskObject;
use coin_schemas::report::Withheld;
use futures::{StreamExt, TryStreamExt};
use jiff::civil::DateTime;
use tokio::sync::OnceCell;

use crate::evidence::whole_context;
use crate::steps::{StepError, Steps};

/// How many things are fetched at once, so that neither this program nor the server waits for the other.
const FETCHED_AT_ONCE: usize = 16;

/// Fewer things are worked out sooner than a thread is started.
const WORTH_A_THREAD: usize = 64;

/// Whom people named as owners so far, by thing; nobody where somebody outside the household owns it.
pub type Answers = BTreeMap<ObjectId, OwnerSet>;

/// All things of a home, as far as the server tells of them.
pub(super) struct SeenHome<'a> {
    steps: &'a Steps<'a>,
    things: &'a BTreeMap<ObjectId, TaskObject>,
    /// The household as the evidence model is told of it.
    roster: Roster,
    withheld: BTreeSet<Withheld>,
    as_of: DateTime,
    parameters: EvidenceParameters,
    seen: OnceCell<Seen>,
    judged: Mutex<Option<(Answers, Arc<HomeJudgement>)>>,
}

/// What was fetched.
struct Seen {
    evidence: HomeEvidence,
    places: BTreeMap<ObjectId, usize>,
    /// What the file of classes expects of each thing.
    expectations: Vec<Option<Expectation>>,
}

impl<'a> SeenHome<'a> {
    /// # Errors
    /// If the household cannot be told without what is withheld, which is a fault of this program.
    pub(super) fn new(
        steps: &'a Steps<'a>,
        things: &'a BTreeMap<ObjectId, TaskObject>,
        withheld: BTreeSet<Withheld>,
        as_of: DateTime,
        parameters: EvidenceParameters,
    ) -> Result<Self, RosterError> {
        Ok(Self {
            roster: Roster::new(steps.household())?,
            steps,
            things,
            withheld,
            as_of,
            parameters,
            seen: OnceCell::new(),
            judged: Mutex::new(None),
        })
    }

    /// The household as the evidence model is told of it.
    pub(super) fn roster(&self) -> &Roster {
        &self.roster
    }

    /// The home with these answers.
    pub(super) async fn with(&self, answers: &Answers) -> Result<JudgedHome<'_>, StepError> {
        let seen = self.seen().await?;
        Ok(JudgedHome { seen, judgement: self.judged(seen, answers) })
    }

    /// The doubt that is expected to be left after an answer about each of these things.
    pub(super) async fn doubt_left(
        &self,
        things: &[ObjectId],
        answers: &Answers,
        settled_from: f64,
    ) -> Result<Vec<f64>, StepError> {
        let seen = self.seen().await?;
        let judgement = self.judged(seen, answers);
        let home = JudgedHome { seen, judgement: Arc::clone(&judgement) };
        let places = things.iter().map(|thing| home.place(thing)).collect::<Result<Vec<_>, _>>()?;
        let told = self.told(seen, answers);
        let left = |place| seen.evidence.doubt_left(&told, &judgement, place, settled_from);
        Ok(places.into_iter().map(left).collect())
    }

    async fn seen(&self) -> Result<&Seen, StepError> {
        self.seen.get_or_try_init(|| self.look()).await
    }

    /// Fetches what the tools tell of every thing.
    async fn look(&self) -> Result<Seen, StepError> {
        let things: Vec<ObjectId> = self.things.keys().cloned().collect();
        let contexts: Vec<_> = futures::stream::iter(things)
            .map(|thing| async move {
                whole_context(self.steps.server(), &thing, self.as_of, &self.withheld).await
            })
            .buffered(FETCHED_AT_ONCE)
            .try_collect()
            .await?;
        let places: BTreeMap<ObjectId, usize> = self.things.keys().cloned().zip(0..).collect();
        let things = self
            .things
            .values()
            .zip(&contexts)
            .map(|(thing, context)| SeenThing::in_context(&self.roster, &thing.class, context, &places));
        let things = things.collect::<Result<Vec<_>, _>>().map_err(unusable)?;
        let expectations = self.things.values().map(|thing| expect(thing.class.as_str(), &self.roster));
        Ok(Seen {
            evidence: HomeEvidence::of(worked_out(things, self.parameters), self.parameters),
            expectations: expectations.collect(),
            places,
        })
    }

    /// What is told of every thing, with the file of classes for common sense.
    fn told<'b>(&self, seen: &'b Seen, answers: &Answers) -> Vec<Told<'b>> {
        let told = self.things.keys().zip(&seen.expectations).map(|(thing, expectation)| Told {
            answer: answers.get(thing).copied(),
            opinion: expectation.as_ref().into(),
        });
        told.collect()
    }

    /// The home with these answers, which is judged once as long as there is no other one.
    fn judged(&self, seen: &Seen, answers: &Answers) -> Arc<HomeJudgement> {
        let mut judged = self.judged.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((before, judged)) = &*judged
            && before == answers
        {
            return Arc::clone(judged);
        }
        let told = self.told(seen, answers);
        let now = Arc::new(match &*judged {
            Some((_, judged)) => seen.evidence.judge_again(&told, judged),
            None => seen.evidence.judge(&told),
        });
        *judged = Some((answers.clone(), Arc::clone(&now)));
        now
    }
}

/// A home judged with some answers.
pub(super) struct JudgedHome<'a> {
    seen: &'a Seen,
    judgement: Arc<HomeJudgement>,
}

impl JudgedHome<'_> {
    /// What the evidence makes of a thing, with the file of classes for common sense.
    pub(super) fn by_evidence(&self, thing: &ObjectId) -> Result<OwnerSetDistribution, StepError> {
        Ok(self.judgement.distributions()[self.place(thing)?].clone())
    }

    /// The same with a model's common sense in place of the file's, or with none.
    pub(super) fn with_opinion(
        &self,
        thing: &ObjectId,
        opinion: Option<&[Score]>,
    ) -> Result<OwnerSetDistribution, StepError> {
        let opinion = opinion.map_or(Opinion::None, Opinion::OfModel);
        Ok(self.seen.evidence.reconsidered(&self.judgement, self.place(thing)?, opinion))
    }

    /// The least probability that the best owner set of a thing can be left with, whatever a language model says of it.
    pub(super) fn least_confidence(&self, thing: &ObjectId) -> Result<f64, StepError> {
        Ok(self.seen.evidence.least_confidence(&self.judgement, self.place(thing)?))
    }

    fn place(&self, thing: &ObjectId) -> Result<usize, StepError> {
        let place = self.seen.places.get(thing).copied();
        place.ok_or_else(|| unusable(format!("thing {thing} is not in the home")))
    }
}

/// Works out what was seen of each thing. Where there are many, several threads share the work; the result is the same.
fn worked_out(mut seen: Vec<SeenThing>, parameters: EvidenceParameters) -> Vec<ThingEvidence> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let share = seen.len().div_ceil(threads).max(WORTH_A_THREAD);
    let mut shares = Vec::new();
    while !seen.is_empty() {
        let rest = seen.split_off(share.min(seen.len()));
        shares.push(std::mem::replace(&mut seen, rest));
    }
    let work = |share: Vec<SeenThing>| -> Vec<ThingEvidence> {
        share.into_iter().map(|seen| ThingEvidence::new(seen, &parameters)).collect()
    };
    if shares.len() < 2 {
        return shares.into_iter().flat_map(work).collect();
    }
    thread::scope(|scope| {
        let workers: Vec<_> = shares.into_iter().map(|share| scope.spawn(move || work(share))).collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}

fn unusable(reason: impl std::fmt::Display) -> StepError {
    StepError::Unusable { reason: reason.to_string() }
}
