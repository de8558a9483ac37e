//! `record_scores`: what a model concluded about the owner of a thing.

use coin::owners::OwnerSetDistribution;
use coin::sharing::ShareThresholds;
use coin_schemas::household::{MAX_NAME_BYTES, Score};
use coin_schemas::tools::{RecordScores, RecordScoresResult};

use super::fields;
use super::{Effect, Tool, ToolError};
use crate::scene::thresholds_of;
use crate::store::{Belief, Household, Inference, Store};

pub(super) struct RecordScoresTool;

impl Tool for RecordScoresTool {
    const NAME: &'static str = "record_scores";
    const TITLE: &'static str = "Record a model's scores";
    const DESCRIPTION: &'static str = "Stores how strongly you hold each member of the household to be an owner \
        of a thing, 0 to 1, each on its own, after you have looked at get_usage_summary, nearby_objects and \
        similar_objects. It tells the most probable owners, how sure that is, and whether the thing is \
        settled; if it is not, ask a person and call record_answer. Where a person has answered, the answer \
        stays what is believed.";
    const EXAMPLE: &'static str =
        r#"{"object_id": "3", "scores": {"Bob": 0.9, "Mary": 0.1}, "model": "my-model"}"#;
    const EFFECT: Effect = Effect::Records;

    type Arguments = RecordScores;
    type Output = RecordScoresResult;

    fn call(store: &Store, arguments: RecordScores) -> Result<RecordScoresResult, ToolError> {
        if let Some(model) = arguments.model.as_ref().filter(|model| model.len() > MAX_NAME_BYTES) {
            let length = model.len();
            return Err(ToolError::field(
                "model",
                format!("it has {length} bytes; at most {MAX_NAME_BYTES} are allowed"),
            ));
        }
        store.write(|writer| {
            let object = fields::object(writer, &arguments.object_id)?;
            let household = fields::household(writer)?;
            let roster = household.roster();
            let scores = read_scores(&arguments, &household)?;
            let distribution = match &arguments.owner_sets {
                Some(sets) => OwnerSetDistribution::from_named(roster, sets)
                    .map_err(|source| ToolError::field("owner_sets", source.to_string()))?,
                None => OwnerSetDistribution::from_scores(&scores),
            };
            let thought = thresholds_of(arguments.model.as_deref()).assess(
                &scores,
                &distribution,
                &ShareThresholds::default(),
            );
            let inference = Inference {
                model: arguments.model.clone(),
                scores: roster.scores(&scores),
                owner_sets: arguments.owner_sets.clone(),
                owners: roster.owners(thought.owners),
                confidence: thought.confidence,
                settled: thought.settled,
            };
            writer.put_inference(object.key, &inference)?;
            let belief = writer.belief(object.key)?.unwrap_or(Belief::Inferred(inference));
            Ok(RecordScoresResult {
                object: fields::object_ref(&object),
                owners: belief.owners().clone(),
                shared: thought.shared,
                prediction_set: roster.owners(thought.prediction_set),
                uncertainty: thought.uncertainty,
                confidence: belief.confidence(),
                settled: belief.is_settled(),
            })
        })
    }
}

/// The scores in the order of the roster.
fn read_scores(arguments: &RecordScores, household: &Household) -> Result<Vec<Score>, ToolError> {
    let roster = household.roster();
    for name in arguments.scores.keys() {
        fields::user(household, "scores", name)?;
    }
    roster
        .names()
        .map(|name| {
            let field = || format!("scores.{name}");
            let &given = arguments.scores.get(name.as_str()).ok_or_else(|| {
                ToolError::field(
                    field(),
                    "it is missing; every member of the household needs a score, if only 0",
                )
            })?;
            Score::new(given).map_err(|source| ToolError::field(field(), source.to_string()))
        })
        .collect()
}
