//! The embedded model: the evidence model behind the chat-model interface. It needs no service and no key.
//!
//! It knows nothing but the conversation. Given a task it asks for the tools that it needs, reads their results
//! from the conversation, and answers in the form that a language model is asked for.

use std::collections::BTreeMap;

use async_trait::async_trait;
use coin::calibration::EMBEDDED_MODEL;
use coin::common_sense::{Tendency, expect, tendency};
use coin::dialogue::{QuestionContext, read_answer, word_question};
use coin::evidence::{EvidenceParameters, Opinion, WeighedContext};
use coin::roster::Roster;
use coin_schemas::model::{
    GivenContext, OwnershipReply, OwnershipsReply, ReadingReply, SharingReply, Task, TaskObject,
    ThingInContext,
};
use coin_schemas::tools::{NearbyObjectsResult, SimilarObjectsResult, UsageSummary};
use jiff::civil::DateTime;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value, json};

use super::{ChatModel, ChatReply, ChatRequest, Message, ModelError, ToolArguments, ToolCall};

/// The tools that the evidence model reads.
const USAGE: &str = "get_usage_summary";
const NEARBY: &str = "nearby_objects";
const SIMILAR: &str = "similar_objects";

/// The evidence model as a chat model.
#[derive(Debug, Clone, Default)]
pub struct EmbeddedModel {
    parameters: EvidenceParameters,
}

impl EmbeddedModel {
    /// With other constants than the default ones, for experiments.
    pub fn with_parameters(parameters: EvidenceParameters) -> Self {
        Self { parameters }
    }

    fn infer(
        &self,
        request: &ChatRequest<'_>,
        roster: &Roster,
        object: &TaskObject,
        as_of: DateTime,
    ) -> Result<ChatReply, ModelError> {
        let wanted: Vec<ToolCall> = [USAGE, NEARBY, SIMILAR]
            .into_iter()
            .filter(|tool| request.tools.iter().any(|offered| offered.name == *tool))
            .filter(|tool| !request.conversation.iter().any(|message| is_result_of(message, tool)))
            .map(|tool| ToolCall {
                id: format!("{tool}-{}", object.id),
                tool: tool.to_owned(),
                arguments: ToolArguments::Object(arguments(tool, object, as_of)),
            })
            .collect();
        if !wanted.is_empty() {
            return Ok(ChatReply::calls(wanted));
        }

        let context = GivenContext {
            usage: result::<UsageSummary>(request, USAGE)?,
            nearby_objects: result::<NearbyObjectsResult>(request, NEARBY)?
                .map_or_else(Vec::new, |result| result.nearby_objects),
            similar_objects: result::<SimilarObjectsResult>(request, SIMILAR)?
                .map_or_else(Vec::new, |result| result.similar_objects),
        };
        say(&self.judge(roster, object, &context)?)
    }

    fn judge(
        &self,
        roster: &Roster,
        object: &TaskObject,
        context: &GivenContext,
    ) -> Result<OwnershipReply, ModelError> {
        let expectation = expect(object.class.as_str(), roster);
        let opinion = Opinion::from(expectation.as_ref());
        let weighed = WeighedContext::new(roster, &object.class, context).map_err(malformed)?;
        let distribution = weighed.posterior(opinion, &self.parameters);
        Ok(OwnershipReply {
            ownership_distribution: roster.scores(&distribution.marginals(roster.len())),
            owner_sets: Some(distribution.to_named(roster)),
        })
    }
}

#[async_trait]
impl ChatModel for EmbeddedModel {
    fn name(&self) -> &str {
        EMBEDDED_MODEL
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        match task(request)? {
            Task::InferOwnership { household, as_of, object, context: None } => {
                self.infer(request, &roster(&household)?, &object, as_of)
            }
            Task::InferOwnership { household, object, context: Some(context), .. } => {
                say(&self.judge(&roster(&household)?, &object, &context)?)
            }
            Task::InferSeveral { household, things, .. } => {
                let roster = roster(&household)?;
                let scores = |thing: &ThingInContext| {
                    let reply = self.judge(&roster, &thing.object, &thing.context)?;
                    Ok((thing.object.id.clone(), reply.ownership_distribution))
                };
                let ownership_distributions =
                    things.iter().map(scores).collect::<Result<BTreeMap<_, _>, ModelError>>()?;
                say(&OwnershipsReply { ownership_distributions })
            }
            Task::AskQuestion { household, object, scores, times_asked } => {
                let roster = roster(&household)?;
                let scores = roster.score_vector(&scores).map_err(malformed)?;
                Ok(ChatReply::words(word_question(&QuestionContext {
                    roster: &roster,
                    class: object.class.as_str(),
                    room: object.room.as_deref(),
                    position: object.position.metres(),
                    scores: &scores,
                    times_asked,
                })))
            }
            Task::ReadAnswer { household, question, answer, answered_by } => {
                let roster = roster(&household)?;
                let speaker =
                    answered_by.map(|name| roster.index_of(name.as_str())).transpose().map_err(malformed)?;
                let reading = read_answer(&roster, &question, &answer, speaker);
                say(&ReadingReply {
                    ownership_boolean: roster.ownership(reading.owners),
                    owner_outside_household: reading.outside_household,
                })
            }
            Task::JudgeSharing { classes } => say(&SharingReply {
                shared_classes: classes
                    .into_iter()
                    .map(|class| {
                        let shared = tendency(class.as_str()) == Some(Tendency::Shared);
                        (class, shared)
                    })
                    .collect(),
            }),
        }
    }
}

fn malformed(reason: impl std::fmt::Display) -> ModelError {
    ModelError::Conversation { reason: format!("{reason}") }
}

fn say(reply: &impl serde::Serialize) -> Result<ChatReply, ModelError> {
    Ok(ChatReply::words(serde_json::to_string(reply).map_err(malformed)?))
}

/// The task is the last thing that the user side said.
fn task(request: &ChatRequest<'_>) -> Result<Task, ModelError> {
    let text = request
        .conversation
        .iter()
        .rev()
        .find_map(|message| match message {
            Message::User { text } => Some(text),
            _ => None,
        })
        .ok_or_else(|| malformed("it holds no task"))?;
    serde_json::from_str(text).map_err(malformed)
}

fn roster(household: &coin_schemas::household::Users) -> Result<Roster, ModelError> {
    Roster::new(household).map_err(malformed)
}

fn arguments(tool: &str, object: &TaskObject, as_of: DateTime) -> Map<String, Value> {
    let mut arguments = Map::new();
    arguments.insert("object_id".to_owned(), json!(object.id));
    if tool == USAGE {
        arguments.insert("as_of".to_owned(), json!(as_of));
        // The counts are enough for the evidence model; it reads no captions.
        arguments.insert("max_examples".to_owned(), json!(0));
    }
    arguments
}

fn is_result_of(message: &Message, name: &str) -> bool {
    matches!(message, Message::Tool { tool, .. } if tool == name)
}

/// The latest answer of a tool; `None` where it was not offered or answered with an error, so that the other
/// evidence still counts.
fn result<T: DeserializeOwned>(request: &ChatRequest<'_>, name: &str) -> Result<Option<T>, ModelError> {
    request
        .conversation
        .iter()
        .rev()
        .find_map(|message| match message {
            Message::Tool { tool, text, is_error: false, .. } if tool == name => Some(text),
            _ => None,
        })
        .map(|text| {
            serde_json::from_str(text)
                .map_err(|error| malformed(format!("the answer of {name} is not in its form: {error}")))
        })
        .transpose()
}
