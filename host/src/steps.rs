//! The three model-driven steps of the paper, each one conversation: LLM-INFER with its tool-calling loop,
//! QUESTION-GENERATION and UNDERSTAND-ANSWER.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicU64, Ordering};

use coin::agent::Inference;
use coin::dialogue::Reading;
use coin::owners::{OwnerSet, OwnerSetDistribution};
use coin::roster::Roster;
use coin_schemas::catalogue::strip_number_formats;
use coin_schemas::household::{Background, ClassLabel, Scores, Users};
use coin_schemas::model::{OwnershipReply, ReadingReply, RelatedObjects, SharingReply, Task};
use coin_schemas::report::{Cost, Withheld};
use coin_schemas::tools::{NearbyObjectsResult, SimilarObjectsResult};
use schemars::{JsonSchema, SchemaGenerator, generate::SchemaSettings};
use serde::de::DeserializeOwned;
use thiserror::Error;

use crate::client::{ServerError, ToolOutcome, ToolServer};
use crate::model::{
    ChatModel, ChatRequest, Message, ModelError, ReplyFormat, ToolArguments, ToolCall, ToolDefinition,
};
use crate::prompts;

/// A model that has not come to an answer after so many turns will not.
const MOST_TURNS: usize = 8;

/// A tool called with the same arguments so often is answered from then on with a reminder.
const MOST_EQUAL_CALLS: usize = 2;

/// A tool result that is longer is cut before the model sees it, in bytes.
const MOST_RESULT_BYTES: usize = 64 * 1024;

/// How often a reply in the wrong form is asked for again.
const MOST_CORRECTIONS: usize = 1;

/// Why a step came to nothing.
#[derive(Debug, Error)]
pub enum StepError {
    /// The model gave no usable reply.
    #[error("{reason}")]
    Unusable {
        /// What was wrong with the last one.
        reason: String,
    },
    /// The model could not be reached or could not work.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The tool server is gone. Nothing can go on without it.
    #[error(transparent)]
    Server(#[from] ServerError),
}

/// A tool call that a model made, for the event log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CalledTool {
    /// The tool.
    pub tool: String,
    /// Whether it answered with an error.
    pub is_error: bool,
}

/// What became of one LLM-INFER conversation.
#[derive(Debug)]
pub struct InferStep {
    /// The tools that the model called, in order.
    pub called: Vec<CalledTool>,
    /// What it concluded.
    pub outcome: Result<Inference, StepError>,
}

/// What the steps have cost so far. They run concurrently, so the counts are atomic.
#[derive(Debug, Default)]
struct Meter {
    model_calls: AtomicU64,
    tool_calls: AtomicU64,
    prompt_tokens: AtomicU64,
    completion_tokens: AtomicU64,
}

/// The steps of one run: a model, the server whose tools it may call, and the household.
pub struct Steps<'a> {
    model: &'a dyn ChatModel,
    server: &'a ToolServer,
    roster: &'a Roster,
    /// What the model may call while it scores.
    tools: Vec<ToolDefinition>,
    /// The people as the model is told of them while it scores.
    household: Users,
    meter: Meter,
    ownership_format: ReplyFormat,
    reading_format: ReplyFormat,
    sharing_format: ReplyFormat,
}

/// The tools that tell what may be withheld.
const TELLS_USAGE: &str = "get_usage_summary";
const TELLS_BACKGROUND: &str = "list_users";

impl<'a> Steps<'a> {
    /// Steps that cost nothing yet. What is withheld is withheld from LLM-INFER alone: a question may still name a
    /// role, and an answer that does can still be read.
    pub fn new(
        model: &'a dyn ChatModel,
        server: &'a ToolServer,
        roster: &'a Roster,
        withheld: &BTreeSet<Withheld>,
    ) -> Self {
        let told = |tool: &ToolDefinition| match tool.name.as_str() {
            TELLS_USAGE => !withheld.contains(&Withheld::Usage),
            TELLS_BACKGROUND => !withheld.contains(&Withheld::Background),
            _ => true,
        };
        let mut household = roster.users();
        if withheld.contains(&Withheld::Background) {
            household.values_mut().for_each(|background| *background = Background::default());
        }
        Self {
            tools: server.reading_tools().iter().filter(|tool| told(tool)).cloned().collect(),
            household,
            model,
            server,
            roster,
            meter: Meter::default(),
            ownership_format: json_format::<OwnershipReply>("ownership"),
            reading_format: json_format::<ReadingReply>("reading"),
            sharing_format: json_format::<SharingReply>("sharing"),
        }
    }

    /// What the steps have cost so far, without the time.
    pub fn cost(&self) -> Cost {
        Cost {
            model_calls: self.meter.model_calls.load(Ordering::Relaxed),
            tool_calls: self.meter.tool_calls.load(Ordering::Relaxed),
            prompt_tokens: self.meter.prompt_tokens.load(Ordering::Relaxed),
            completion_tokens: self.meter.completion_tokens.load(Ordering::Relaxed),
            seconds: 0.0,
        }
    }

    /// LLM-INFER: the model collects evidence by tool calls and scores every member.
    pub async fn infer(&self, task: &Task) -> InferStep {
        let mut conversation = match Conversation::new(prompts::INFER_OWNERSHIP, task) {
            Ok(conversation) => conversation,
            Err(error) => return InferStep { called: Vec::new(), outcome: Err(error) },
        };
        let outcome = self
            .converse(&mut conversation, &self.ownership_format, |reply: OwnershipReply| {
                self.read_scores(&reply)
            })
            .await
            .map(|(scores, distribution)| Inference {
                scores,
                distribution,
                related: std::mem::take(&mut conversation.related),
            });
        InferStep { called: conversation.called, outcome }
    }

    /// QUESTION-GENERATION: one sentence.
    pub async fn word_question(&self, task: &Task) -> Result<String, StepError> {
        let mut conversation = Conversation::new(prompts::ASK_QUESTION, task)?;
        for _ in 0..=MOST_CORRECTIONS {
            let reply = self.turn(&conversation, &[], &ReplyFormat::Text).await?;
            let text = reply.text.unwrap_or_default().trim().to_owned();
            if !text.is_empty() {
                return Ok(text);
            }
            conversation.correct(String::new(), "Your reply was empty. Answer with the question alone.");
        }
        Err(StepError::Unusable { reason: "the model worded no question".to_owned() })
    }

    /// UNDERSTAND-ANSWER: who the answer makes an owner.
    pub async fn read_answer(&self, task: &Task) -> Result<Reading, StepError> {
        let mut conversation = Conversation::new(prompts::READ_ANSWER, task)?;
        self.converse(&mut conversation, &self.reading_format, |reply: ReadingReply| {
            let named = reply.ownership_boolean.iter().filter(|(_, owner)| **owner).map(|(name, _)| name);
            let owners: OwnerSet = self.roster.owner_set(named).map_err(|error| error.to_string())?;
            Ok(Reading { owners, outside_household: reply.owner_outside_household })
        })
        .await
    }

    /// The first step of Active Ownership Learning: which classes are everybody's.
    pub async fn judge_sharing(&self, classes: BTreeSet<ClassLabel>) -> Result<SharingReply, StepError> {
        let task = Task::JudgeSharing { classes };
        let mut conversation = Conversation::new(prompts::JUDGE_SHARING, &task)?;
        self.converse(&mut conversation, &self.sharing_format, Ok).await
    }

    /// The people as the model is told of them while it scores.
    pub fn household(&self) -> &Users {
        &self.household
    }

    fn read_scores(
        &self,
        reply: &OwnershipReply,
    ) -> Result<(Vec<coin_schemas::household::Score>, OwnerSetDistribution), String> {
        let scores: &Scores = &reply.ownership_distribution;
        let scores = self.roster.score_vector(scores).map_err(|error| error.to_string())?;
        let distribution = match &reply.owner_sets {
            Some(sets) => {
                OwnerSetDistribution::from_named(self.roster, sets).map_err(|error| error.to_string())?
            }
            None => OwnerSetDistribution::from_scores(&scores),
        };
        Ok((scores, distribution))
    }

    /// Lets the model call tools until it gives a reply that `read` accepts.
    async fn converse<Reply: DeserializeOwned, T>(
        &self,
        conversation: &mut Conversation,
        format: &ReplyFormat,
        read: impl Fn(Reply) -> Result<T, String>,
    ) -> Result<T, StepError> {
        let tools: &[ToolDefinition] = if conversation.may_call_tools() { &self.tools } else { &[] };
        let mut corrections = 0;
        for _ in 0..MOST_TURNS {
            let reply = self.turn(conversation, tools, format).await?;
            if !reply.tool_calls.is_empty() {
                self.call_tools(conversation, reply.text, reply.tool_calls).await?;
                continue;
            }
            let text = reply.text.unwrap_or_default();
            let reason = match serde_json::from_str::<Reply>(text.trim()) {
                Ok(parsed) => match read(parsed) {
                    Ok(value) => return Ok(value),
                    Err(reason) => reason,
                },
                Err(error) => format!("the reply is not the JSON that was asked for: {error}"),
            };
            if corrections == MOST_CORRECTIONS {
                return Err(StepError::Unusable { reason });
            }
            corrections += 1;
            conversation.correct(text, &format!("{reason}. Answer again with JSON only."));
        }
        Err(StepError::Unusable { reason: format!("the model gave no answer within {MOST_TURNS} turns") })
    }

    async fn turn(
        &self,
        conversation: &Conversation,
        tools: &[ToolDefinition],
        reply: &ReplyFormat,
    ) -> Result<crate::model::ChatReply, ModelError> {
        self.meter.model_calls.fetch_add(1, Ordering::Relaxed);
        let request = ChatRequest { conversation: &conversation.messages, tools, reply };
        let answered = self.model.complete(&request).await?;
        self.meter.prompt_tokens.fetch_add(answered.usage.prompt_tokens, Ordering::Relaxed);
        self.meter.completion_tokens.fetch_add(answered.usage.completion_tokens, Ordering::Relaxed);
        Ok(answered)
    }

    async fn call_tools(
        &self,
        conversation: &mut Conversation,
        text: Option<String>,
        calls: Vec<ToolCall>,
    ) -> Result<(), ServerError> {
        conversation.messages.push(Message::Assistant { text, tool_calls: calls.clone() });
        for call in calls {
            let outcome = if !self.tools.iter().any(|tool| tool.name == call.tool) {
                let names: Vec<&str> = self.tools.iter().map(|tool| tool.name.as_str()).collect();
                let text = format!("there is no tool {:?}; the tools are {}", call.tool, names.join(", "));
                ToolOutcome { text, is_error: true }
            } else if conversation.count_call(&call) > MOST_EQUAL_CALLS {
                let text =
                    "this call was answered before; use that answer and come to a conclusion".to_owned();
                ToolOutcome { text, is_error: true }
            } else {
                self.meter.tool_calls.fetch_add(1, Ordering::Relaxed);
                match call.arguments {
                    ToolArguments::Object(arguments) => self.server.call_raw(&call.tool, arguments).await?,
                    ToolArguments::Malformed(text) => ToolOutcome {
                        text: format!("the arguments must be a JSON object, not {}", excerpt(&text)),
                        is_error: true,
                    },
                }
            };
            conversation.take_result(call.id, call.tool, outcome);
        }
        Ok(())
    }
}

/// The messages of one step and what is remembered of them.
struct Conversation {
    messages: Vec<Message>,
    task_allows_tools: bool,
    calls: BTreeMap<String, usize>,
    called: Vec<CalledTool>,
    related: RelatedObjects,
}

impl Conversation {
    fn new(instructions: &str, task: &Task) -> Result<Self, StepError> {
        let slots = serde_json::to_string(task).map_err(|error| StepError::Unusable {
            reason: format!("the task cannot be written: {error}"),
        })?;
        Ok(Self {
            messages: vec![Message::System { text: instructions.to_owned() }, Message::User { text: slots }],
            task_allows_tools: matches!(task, Task::InferOwnership { .. }),
            calls: BTreeMap::new(),
            called: Vec::new(),
            related: RelatedObjects::new(),
        })
    }

    fn may_call_tools(&self) -> bool {
        self.task_allows_tools
    }

    /// How often this very call was made, this time included.
    fn count_call(&mut self, call: &ToolCall) -> usize {
        let key = format!("{} {}", call.tool, call.arguments.to_text());
        let count = self.calls.entry(key).or_insert(0);
        *count += 1;
        *count
    }

    fn take_result(&mut self, call_id: String, tool: String, outcome: ToolOutcome) {
        let ToolOutcome { mut text, is_error } = outcome;
        if !is_error {
            self.related.extend(related_objects(&tool, &text));
        }
        if text.len() > MOST_RESULT_BYTES {
            let end = text.floor_char_boundary(MOST_RESULT_BYTES);
            text.truncate(end);
            text.push_str("… (cut: the result is too long)");
        }
        self.called.push(CalledTool { tool: tool.clone(), is_error });
        self.messages.push(Message::Tool { call_id, tool, text, is_error });
    }

    /// Shows the model its own words and what is wrong with them. The last user message stays the task, so
    /// the correction comes as an instruction.
    fn correct(&mut self, text: String, reason: &str) {
        self.messages.push(Message::Assistant { text: Some(text), tool_calls: Vec::new() });
        self.messages.push(Message::System { text: reason.to_owned() });
    }
}

/// The things whose known owners a tool result shows.
fn related_objects(tool: &str, text: &str) -> RelatedObjects {
    match tool {
        "nearby_objects" => serde_json::from_str::<NearbyObjectsResult>(text)
            .map(|result| result.nearby_objects.into_iter().map(|neighbour| neighbour.id).collect())
            .unwrap_or_default(),
        "similar_objects" => serde_json::from_str::<SimilarObjectsResult>(text)
            .map(|result| result.similar_objects.into_iter().map(|look_alike| look_alike.id).collect())
            .unwrap_or_default(),
        _ => RelatedObjects::new(),
    }
}

/// As much of a text as an error may quote.
fn excerpt(text: &str) -> String {
    const LONGEST: usize = 200;
    if text.len() <= LONGEST {
        return format!("{text:?}");
    }
    format!("{:?} and {} bytes more", &text[..text.floor_char_boundary(LONGEST)], text.len() - LONGEST)
}

fn json_format<T: JsonSchema>(name: &str) -> ReplyFormat {
    let mut schema = SchemaGenerator::from(SchemaSettings::draft2020_12()).into_root_schema_for::<T>();
    strip_number_formats(&mut schema);
    ReplyFormat::Json { name: name.to_owned(), schema: schema.to_value() }
}

#[cfg(test)]
mod tests;
