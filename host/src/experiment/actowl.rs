//! Active Ownership Learning in a home: the model calls classes shared or owned and words and reads the questions, the
//! generative model of `coin` decides what is asked.

use std::collections::{BTreeMap, BTreeSet};

use coin::baselines::actowl::{ActOwl, Priors, Sampling, Things, visual_words};
use coin::owners::OwnerSet;
use coin_schemas::household::{ClassLabel, ObjectId, Score, UserName};
use coin_schemas::model::{Task, TaskObject};
use coin_schemas::report::Scoring;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::JudgedHome;
use super::methods::MethodOutcome;
use crate::client::ServerAddress;
use crate::driver::DriveError;
use crate::home::Home;
use crate::model::ChatModel;
use crate::person::{Candidate, Person, PutQuestion, Response, SimulatedPerson};
use crate::run::RunError;
use crate::steps::Steps;

/// One run, with the classes judged anew as every run of the paper's comparison did.
pub(super) async fn run(
    judged: &JudgedHome,
    model: &dyn ChatModel,
    seed: u64,
) -> Result<MethodOutcome, RunError> {
    let home = Home::open(judged.loaded.clone(), None, &ServerAddress::InProcess).await?;
    let steps = Steps::new(model, &home.server, &home.roster, &BTreeSet::new(), Scoring::default());
    let mut person = judged.person(seed);

    let objects = &judged.loaded.episode.objects;
    let classes: BTreeSet<ClassLabel> = objects.iter().map(|object| object.class.clone()).collect();
    let shared = steps.judge_sharing(classes).await.map_err(DriveError::from)?.shared_classes;
    let owned: Vec<usize> = (0..objects.len())
        .filter(|&place| !shared.get(&objects[place].class).copied().unwrap_or(false))
        .collect();
    let things = things(judged, &owned);
    let priors = Priors::around(&things.positions);
    let generator = ChaCha8Rng::seed_from_u64(seed);
    let mut actowl = ActOwl::new(things, priors, Sampling::default(), home.roster.len(), generator);

    let believed = |actowl: &ActOwl<ChaCha8Rng>| -> BTreeMap<ObjectId, OwnerSet> {
        let mut owners: BTreeMap<ObjectId, OwnerSet> =
            objects.iter().map(|object| (object.id.clone(), home.roster.everyone())).collect();
        for (thing, &place) in owned.iter().enumerate() {
            owners.insert(objects[place].id.clone(), actowl.owners(thing));
        }
        owners
    };
    let mut history = vec![believed(&actowl)];
    while let Some(thing) = actowl.next_question() {
        let object = &objects[owned[thing]];
        let scores: Vec<Score> = actowl
            .probabilities(thing)
            .iter()
            .map(|&probability| Score::new(probability.clamp(0.0, 1.0)).unwrap_or(Score::ZERO))
            .collect();
        let owners = ask(object, &scores, history.len(), &home, &steps, &mut person).await?;
        actowl.answer(thing, owners);
        history.push(believed(&actowl));
    }
    let cost = steps.cost();
    home.server.close().await;
    Ok(MethodOutcome { history, cost })
}

/// Positions, and as attributes class, room and look.
fn things(judged: &JudgedHome, owned: &[usize]) -> Things {
    let episode = &judged.loaded.episode;
    let numbered = |words: Vec<String>| -> Vec<usize> {
        let distinct: BTreeSet<String> = words.iter().cloned().collect();
        let numbers: BTreeMap<String, usize> =
            distinct.into_iter().enumerate().map(|(number, word)| (word, number)).collect();
        words.iter().map(|word| numbers[word]).collect()
    };
    let of_owned = |word: &dyn Fn(&TaskObject) -> String| -> Vec<usize> {
        numbered(owned.iter().map(|&place| word(&episode.objects[place])).collect())
    };
    let mut kinds = vec![of_owned(&|object| object.class.as_str().to_lowercase())];
    if episode.objects.iter().any(|object| object.room.is_some()) {
        kinds.push(of_owned(&|object| object.room.clone().unwrap_or_default()));
    }
    if let Some(features) = &judged.loaded.features {
        let features: Vec<&[f32]> = owned.iter().map(|&place| features[place].as_slice()).collect();
        kinds.push(visual_words(&features));
    }
    Things {
        positions: owned.iter().map(|&place| episode.objects[place].position.metres()).collect(),
        attributes: (0..owned.len()).map(|thing| kinds.iter().map(|kind| kind[thing]).collect()).collect(),
    }
}

/// Has the question worded, the person asked and the answer read.
async fn ask(
    object: &TaskObject,
    scores: &[Score],
    step: usize,
    home: &Home,
    steps: &Steps<'_>,
    person: &mut SimulatedPerson,
) -> Result<OwnerSet, RunError> {
    let question = steps
        .word_question(&Task::AskQuestion {
            household: home.roster.users(),
            object: object.clone(),
            scores: home.roster.scores(scores),
            times_asked: 0,
        })
        .await
        .map_err(DriveError::from)?;
    let candidate = |(name, &score): (&UserName, &Score)| Candidate { name: name.clone(), score };
    let candidates: Vec<Candidate> = home.roster.names().zip(scores).map(candidate).collect();
    let put = PutQuestion {
        step,
        object,
        also: &[],
        question: &question,
        candidates: &candidates,
        times_asked: 0,
        before: None,
        remaining: None,
    };
    let Response::Said { answer, answered_by } = person.ask(&put).await? else {
        return Ok(OwnerSet::EMPTY);
    };
    let task = Task::ReadAnswer { household: home.roster.users(), question, answer, answered_by };
    Ok(steps.read_answer(&task).await.map_err(DriveError::from)?.owners)
}
