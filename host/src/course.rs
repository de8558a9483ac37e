//! How the agent goes through a home, from its first look to its last question.

use std::collections::{BTreeMap, BTreeSet};

use coin::agent::{Agent, AgentSettings, QuestionChoice, Reinference};
use coin::dialogue::Reading;
use coin::evidence::EvidenceParameters;
use coin::owners::OwnerSet;
use coin::roster::RosterError;
use coin_schemas::household::{ObjectId, Owners};
use coin_schemas::journal::JournalHeading;
use coin_schemas::report::{Cost, Estimator, Gate, Scoring, Withheld};
use coin_schemas::tools::{RetractAnswer, RetractAnswerResult};
use tokio_util::sync::CancellationToken;

use crate::calibrate::scored_by;
use crate::driver::{DriveError, Driver, Observer, Outcome};
use crate::estimation::Estimation;
use crate::home::Home;
use crate::journal::Journal;
use crate::model::ChatModel;
use crate::person::{Person, PersonKind};
use crate::steps::Steps;

/// Where every answer bears on every thing, a home is judged anew after one answer for so many of its things.
const THINGS_PER_ANSWER: usize = 100;

/// How the agent goes through a home.
pub(crate) struct Course {
    settings: AgentSettings,
    withheld: BTreeSet<Withheld>,
    scoring: Scoring,
    parameters: EvidenceParameters,
    concurrency: usize,
    journal: Journal,
    /// The answers from before the run; those that the server knows, where nothing is said.
    answered_before: Option<BTreeMap<ObjectId, Owners>>,
    stop: CancellationToken,
}

impl Course {
    /// From the start to the end, with nothing kept for later.
    pub(crate) fn new(
        settings: AgentSettings,
        withheld: BTreeSet<Withheld>,
        scoring: Scoring,
        concurrency: usize,
    ) -> Self {
        let (journal, stop) = (Journal::none(), CancellationToken::new());
        let parameters = EvidenceParameters::default();
        Self { settings, withheld, scoring, parameters, concurrency, journal, answered_before: None, stop }
    }

    /// With other terms of the evidence model than the usual ones.
    pub(crate) fn with_parameters(self, parameters: EvidenceParameters) -> Self {
        Self { parameters, ..self }
    }

    pub(crate) fn until(self, stop: CancellationToken) -> Self {
        Self { stop, ..self }
    }

    pub(crate) fn going_on(mut self, journal: Journal, heading: &JournalHeading) -> Self {
        // Fewer questions may be allowed now, but those that were put stay put.
        self.settings.max_questions = self.settings.max_questions.max(journal.past_questions().count());
        Self { journal, answered_before: Some(heading.answered.clone()), ..self }
    }

    /// The answers that the agent knows when it starts. What the journal will tell again is not among them; what was
    /// answered another way since is.
    fn answered(&self, home: &Home) -> Result<BTreeMap<ObjectId, OwnerSet>, RosterError> {
        let mut answered = home.answered.clone();
        if let Some(before) = &self.answered_before {
            for question in self.journal.past_questions() {
                question.objects().for_each(|object| {
                    answered.remove(object);
                });
            }
            for (object, owners) in before {
                answered.insert(object.clone(), home.roster.owner_set(owners)?);
            }
        }
        Ok(answered)
    }
}

/// Runs the agent in a home and says what it cost, without the time.
pub(crate) async fn drive(
    home: &Home,
    course: Course,
    model: &dyn ChatModel,
    person: &mut dyn Person,
    observer: &mut dyn Observer,
) -> Result<(Outcome, Cost), DriveError> {
    let malformed = |error: RosterError| DriveError::Malformed(error.to_string());
    let mut answered = course.answered(home).map_err(malformed)?;
    let before = course.answered_before.as_ref();
    for object in course.journal.withdrawn() {
        // The run ended between taking the answer back and telling the server.
        if home.answered.contains_key(object) && before.is_some_and(|before| !before.contains_key(object)) {
            let arguments = RetractAnswer { object_id: object.to_string() };
            let _: RetractAnswerResult = home.server.call("retract_answer", &arguments).await?;
            answered.remove(object);
        }
    }
    let Course { mut settings, withheld, scoring, parameters, concurrency, journal, stop, .. } = course;
    let reinference = settings.reinference;
    // The evidence of one thing bears on every other one, and to weigh it again costs nothing.
    if scoring.estimator != Estimator::Model {
        settings.reinference = Reinference::EveryUnasked;
        settings.answers_per_pass = home.things.len().div_ceil(THINGS_PER_ANSWER).max(1);
    }
    // What an answer would change can be told before it is given, where no model is asked, and in a home that is judged soon.
    let may_weigh = scoring.estimator == Estimator::Evidence && settings.answers_per_pass == 1;
    if !(may_weigh && goes_by_doubt(settings.gate)) {
        settings.choice = QuestionChoice::LeastSure;
    }
    let alike = if asks_together(settings.gate, person.kind()) { home.alike() } else { Vec::new() };
    let mut agent = Agent::new(settings, home.things.keys().cloned()).asking_together(alike);
    for (object, owners) in answered {
        agent.remember_answer(&object, Reading { owners, outside_household: owners.is_empty() });
    }
    let steps = Steps::new(model, &home.server, &home.roster, &withheld, scoring);
    let estimation =
        Estimation::new(&steps, &home.things, withheld, home.episode.now, reinference, parameters)
            .map_err(malformed)?;
    let (scored_by, _) = scored_by(model.name(), scoring);
    let driver = Driver {
        steps: &steps,
        estimation: &estimation,
        server: &home.server,
        model: scored_by,
        roster: &home.roster,
        things: &home.things,
        as_of: home.episode.now,
        concurrency,
        person,
        observer,
        journal,
        stop,
    };
    let outcome = driver.run(agent).await?;
    Ok((outcome, steps.cost()))
}

/// Whether a gate settles things by how sure it is of their best owner set.
fn goes_by_doubt(gate: Gate) -> bool {
    matches!(gate, Gate::Risk | Gate::Adaptive)
}

/// Whether several things may be asked about at once. Prepared answers are about one thing each.
fn asks_together(gate: Gate, person: PersonKind) -> bool {
    matches!(gate, Gate::Risk | Gate::Adaptive | Gate::Set) && person != PersonKind::Scripted
}
