//! `find_object`: the thing that a person's words mean, a question, or why nothing is handed out.

use std::collections::HashMap;

use coin::referring::{
    Decision, Finding, Interpretation, MappedThing, OwnerReference, Purpose, Relation, find,
};
use coin::roster::Roster;
use coin_schemas::episode::FEATURE_DIMENSIONS;
use coin_schemas::household::{ObjectId, UserName};
use coin_schemas::tools::{
    AskedFor, FindDecision, FindObject, FindObjectResult, FoundObject, MAX_K, ObjectMatch,
    RequestInterpretation, display_name,
};

use super::{Effect, Tool, ToolError, fields};
use crate::scene::{Judgement, Moment, Scene, four_decimals};
use crate::store::{Store, StoreError, StoredObject};

pub(super) struct FindObjectTool;

impl Tool for FindObjectTool {
    const NAME: &'static str = "find_object";
    const TITLE: &'static str = "Find a thing by words";
    const DESCRIPTION: &'static str = "Tells which thing somebody's words mean (\"my cup\", \"Mary's red book on the \
        desk\", \"whose mug is this?\") and whose it is. found: it is object. ambiguous: ask the person question, \
        then call again with fuller words. none: tell reason and hand out nothing.";
    const EXAMPLE: &'static str = r#"{"query": "bring me my cup"}"#;
    const EFFECT: Effect = Effect::Reads;

    type Arguments = FindObject;
    type Output = FindObjectResult;

    fn call(store: &Store, arguments: FindObject) -> Result<FindObjectResult, ToolError> {
        let query = fields::text("query", &arguments.query)?;
        let most = fields::within("k", arguments.k, &(1..=MAX_K))? as usize;
        let embedding = arguments.query_embedding.as_deref().map(direction).transpose()?;
        store.read(|reader| {
            let scene = Scene::new(reader)?;
            let roster = scene.household().roster();
            let speaker = arguments.speaker.as_deref();
            let speaker = speaker.map(|name| fields::user(scene.household(), "speaker", name)).transpose()?;
            let objects = scene.objects()?;
            let likenesses = match &embedding {
                Some(embedding) => scene.likenesses(embedding)?,
                None => vec![None; objects.len()],
            };
            let things: Vec<MappedThing<'_>> = objects
                .iter()
                .zip(likenesses)
                .map(|(object, likeness)| MappedThing {
                    id: &object.id,
                    class: object.class.as_str(),
                    room: object.room.as_deref(),
                    position: object.position,
                    likeness,
                })
                .collect();
            let mut judgements: HashMap<usize, Judgement> = HashMap::new();
            let finding = find(roster, &things, query, speaker, |thing| {
                reader.go_on()?;
                let judgement = scene.judge(&objects[thing], Moment::Present)?;
                let scores = judgement.scores.clone();
                judgements.insert(thing, judgement);
                Ok::<_, StoreError>(scores)
            })?;
            let place = |id: &ObjectId| objects.binary_search_by(|object| object.id.cmp(id)).ok();
            let found = match &finding.decision {
                Decision::Found(id) => place(id),
                Decision::Ambiguous { .. } | Decision::None { .. } => None,
            };
            let object = match found {
                Some(thing) => {
                    let judgement = match judgements.remove(&thing) {
                        Some(judgement) => judgement,
                        None => scene.judge(&objects[thing], Moment::Present)?,
                    };
                    Some(found_object(&scene, &objects[thing], &judgement))
                }
                None => None,
            };
            let matches = finding.matches.iter().take(most);
            let matches = matches.filter_map(|one| {
                let object = &objects[place(&one.id)?];
                Some(ObjectMatch {
                    id: object.id.clone(),
                    name: display_name(&object.class),
                    position: object.shown_position(),
                    matched: four_decimals(one.matched),
                    ownership: one.ownership.map(four_decimals),
                    score: four_decimals(one.score),
                })
            });
            Ok(result(&finding, roster, object, matches.collect(), most))
        })
    }
}

/// The embedding at length 1.
fn direction(embedding: &[f64]) -> Result<Vec<f32>, ToolError> {
    let refused = |problem: &str| {
        ToolError::field(
            "query_embedding",
            format!(
                "{problem}; {FEATURE_DIMENSIONS} finite numbers that are not all 0 are expected, from the encoder \
                 that made the features of the map"
            ),
        )
    };
    if embedding.len() != FEATURE_DIMENSIONS {
        return Err(refused(&format!("{} numbers were given", embedding.len())));
    }
    let length = embedding.iter().map(|component| component * component).sum::<f64>().sqrt();
    if length == 0.0 {
        return Err(refused("all numbers are 0, which points nowhere"));
    }
    if !length.is_finite() {
        return Err(refused("a number is too large"));
    }
    Ok(embedding.iter().map(|component| (component / length) as f32).collect())
}

fn found_object(scene: &Scene<'_>, object: &StoredObject, judgement: &Judgement) -> FoundObject {
    FoundObject {
        id: object.id.clone(),
        name: display_name(&object.class),
        position: object.shown_position(),
        room: object.room.clone(),
        owners: scene.household().roster().owners(judgement.reading.owners),
        confidence: judgement.confidence,
        settled: judgement.is_settled(),
        explanation: scene.explanation(object, judgement),
    }
}

fn result(
    finding: &Finding,
    roster: &Roster,
    object: Option<FoundObject>,
    matches: Vec<ObjectMatch>,
    most: usize,
) -> FindObjectResult {
    let first = |ids: &[ObjectId]| ids.iter().take(most).cloned().collect();
    let none = FindObjectResult {
        decision: FindDecision::None,
        object: None,
        question: None,
        candidates: Vec::new(),
        reason: None,
        instead: Vec::new(),
        interpretation: interpretation(&finding.interpretation, roster),
        matches,
    };
    match &finding.decision {
        Decision::Found(_) => FindObjectResult { decision: FindDecision::Found, object, ..none },
        Decision::Ambiguous { candidates, question } => FindObjectResult {
            decision: FindDecision::Ambiguous,
            question: Some(question.clone()),
            candidates: first(candidates),
            ..none
        },
        Decision::None { instead, reason } => {
            FindObjectResult { reason: Some(reason.clone()), instead: first(instead), ..none }
        }
    }
}

fn interpretation(interpretation: &Interpretation, roster: &Roster) -> RequestInterpretation {
    let places = interpretation.hints.iter().map(|hint| {
        let relation = match hint.relation {
            Relation::Near => "near",
            Relation::Above => "on or above",
            Relation::Below => "under",
            Relation::In => "in",
        };
        format!("{relation} {}", hint.place.join(" "))
    });
    RequestInterpretation {
        class: interpretation.thing.class.join(" "),
        owner: owner(interpretation.thing.owner, roster),
        words: interpretation.thing.said.clone(),
        places: places.collect(),
        asked_for: match interpretation.purpose {
            Purpose::Thing => AskedFor::Object,
            Purpose::Owner => AskedFor::Owner,
        },
    }
}

fn owner(reference: OwnerReference, roster: &Roster) -> String {
    let names = |members, between: &str| {
        roster.owners(members).iter().map(UserName::as_str).collect::<Vec<_>>().join(between)
    };
    match reference {
        OwnerReference::Anybody => "anybody".to_owned(),
        OwnerReference::Members(members) => names(members, " and "),
        OwnerReference::OneOf(members) => names(members, " or "),
        OwnerReference::Ours(Some(speaker)) => format!("{} with somebody else", roster.name(speaker)),
        OwnerReference::Ours(None) => "several, and it is not known who speaks".to_owned(),
        OwnerReference::Outside => "somebody outside the household".to_owned(),
        OwnerReference::Speaker => "the speaker, and it is not known who speaks".to_owned(),
        OwnerReference::Unknown => "somebody whom the household does not know".to_owned(),
    }
}
