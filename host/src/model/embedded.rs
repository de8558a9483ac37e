//! The embedded model: the evidence model behind the chat-model interface. It needs no service and no key.
//!
//! It knows nothing but the conversation. Given a task it asks for the tools that it needs, reads their results
//! from the conversation, and answers in the form that a language model is asked for.

use async_trait::async_trait;
use coin::calibration::EMBEDDED_MODEL;
use coin::common_sense::{Tendency, expect, tendency};
use coin::dialogue::{QuestionContext, read_answer, word_question};
use coin::evidence::{EvidenceParameters, KnownRelative, Relation, likeness_counts, posterior};
use coin::roster::Roster;
use coin_schemas::household::{Owners, Source};
use coin_schemas::model::{OwnershipReply, ReadingReply, SharingReply, Task, TaskObject};
use coin_schemas::tools::{KnownOwnership, NearbyObjectsResult, SimilarObjectsResult, UsageSummary};
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

        let sessions = sessions(roster, result::<UsageSummary>(request, USAGE)?)?;
        let mut relatives = Vec::new();
        if let Some(nearby) = result::<NearbyObjectsResult>(request, NEARBY)? {
            for neighbour in nearby.nearby_objects {
                let relation = Relation::Near { weight: neighbour.weight };
                relatives.extend(answered(roster, neighbour.known_ownership, relation)?);
            }
        }
        if let Some(similar) = result::<SimilarObjectsResult>(request, SIMILAR)? {
            let own_class = similar.object.name;
            for look_alike in similar.similar_objects {
                if !likeness_counts(&own_class, &look_alike.name) {
                    continue;
                }
                let relation = Relation::LooksAlike { similarity: look_alike.similarity };
                relatives.extend(answered(roster, look_alike.known_ownership, relation)?);
            }
        }
        let expectation = expect(object.class.as_str(), roster);
        let distribution = posterior(&sessions, expectation.as_ref().into(), &relatives, &self.parameters);
        let reply = OwnershipReply {
            ownership_distribution: roster.scores(&distribution.marginals(roster.len())),
            owner_sets: Some(distribution.to_named(roster)),
        };
        say(&reply)
    }
}

#[async_trait]
impl ChatModel for EmbeddedModel {
    fn name(&self) -> &str {
        EMBEDDED_MODEL
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        match task(request)? {
            Task::InferOwnership { household, object, as_of } => {
                self.infer(request, &roster(&household)?, &object, as_of)
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
                    ownership_boolean: roster
                        .indices()
                        .map(|user| (roster.name(user).clone(), reading.owners.contains(user)))
                        .collect(),
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

fn sessions(roster: &Roster, summary: Option<UsageSummary>) -> Result<Vec<u64>, ModelError> {
    let mut sessions = vec![0; roster.len()];
    for usage in summary.into_iter().flat_map(|summary| summary.user_summary) {
        let user = roster.index_of(usage.user_id.as_str()).map_err(malformed)?;
        sessions[user.place()] = usage.sessions;
    }
    Ok(sessions)
}

/// Only what a person said is passed on: an inferred owner rests on the same evidence as the thing in question,
/// and feeding it back would count that evidence twice.
fn answered(
    roster: &Roster,
    known: Option<KnownOwnership>,
    relation: Relation,
) -> Result<Option<KnownRelative>, ModelError> {
    let owners: Owners = match known {
        Some(KnownOwnership { owners, source: Source::Answer, .. }) => owners,
        _ => return Ok(None),
    };
    let owners = roster.owner_set(&owners).map_err(malformed)?;
    Ok(Some(KnownRelative { owners, relation }))
}
