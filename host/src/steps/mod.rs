//! The three model-driven steps of the paper, each one conversation: LLM-INFER with its tool-calling loop,
//! QUESTION-GENERATION and UNDERSTAND-ANSWER.

mod conversation;
mod formats;
mod meter;

use std::collections::{BTreeMap, BTreeSet};

use coin::dialogue::Reading;
use coin::owners::{OwnerSet, OwnerSetDistribution};
use coin::roster::Roster;
use coin_schemas::household::{Background, ClassLabel, ObjectId, Score, Scores, UserName, Users};
use coin_schemas::model::{
    OwnershipReply, OwnershipsReply, ReadingReply, RelatedObjects, SharingReply, Task,
};
use coin_schemas::report::{ContextSource, Cost, Estimator, Scoring, Withheld};
use coin_server::display::excerpt;
use serde::de::DeserializeOwned;
use thiserror::Error;

use crate::client::{ServerError, ToolOutcome, ToolServer};
use crate::model::{
    ChatModel, ChatReply, ChatRequest, Ending, ModelError, ReplyFormat, ToolArguments, ToolCall,
    ToolDefinition,
};
use crate::prompts;
use crate::reply::{read_json, read_sentence};
use conversation::{Conversation, Shown};
use formats::Formats;
use meter::Meter;

pub use conversation::SeenResult;

/// A model that has not come to an answer after so many turns will not.
const MOST_TURNS: usize = 8;

/// A tool called with the same arguments so often is answered from then on with a reminder.
const MOST_EQUAL_CALLS: usize = 2;

/// A turn that wants more tools called than this gets the rest answered with a reminder.
const MOST_CALLS_IN_A_TURN: usize = 16;

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

impl StepError {
    /// Whether no further step can succeed, so that the run has to end.
    pub fn ends_run(&self) -> bool {
        matches!(self, Self::Server(_) | Self::Model(ModelError::Unusable { .. }))
    }
}

/// A tool call that a model made, for the event log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CalledTool {
    /// The tool.
    pub tool: String,
    /// Whether it answered with an error.
    pub is_error: bool,
}

/// What a model said of one thing.
#[derive(Debug, Clone, PartialEq)]
pub struct Scored {
    /// Its score of every member, in the order of the roster.
    pub scores: Vec<Score>,
    /// The probabilities of owner sets: its own, or those that the scores imply.
    pub distribution: OwnerSetDistribution,
    /// What was made good in its reply.
    pub remark: Option<String>,
}

/// What became of one LLM-INFER conversation.
#[derive(Debug)]
pub struct InferStep<T = Scored> {
    /// The tools that the model called, in order.
    pub called: Vec<CalledTool>,
    /// The results that it saw.
    pub seen: Vec<SeenResult>,
    /// The things whose known owners it could see.
    pub related: RelatedObjects,
    /// What it concluded.
    pub outcome: Result<T, StepError>,
}

/// Whether a reply may still be corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Attempt {
    First,
    Last,
}

/// The steps of one run: a model, the server whose tools it may call, and the household.
pub struct Steps<'a> {
    model: &'a dyn ChatModel,
    server: &'a ToolServer,
    roster: &'a Roster,
    scoring: Scoring,
    /// What the model may call while it scores.
    tools: Vec<ToolDefinition>,
    /// The people as the model is told of them while it scores.
    household: Users,
    meter: Meter,
    formats: Formats,
}

/// The tools that tell what may be withheld.
const TELLS_USAGE: &str = "get_usage_summary";
const TELLS_BACKGROUND: &str = "list_users";

/// The tools that tell of a thing's surroundings (the paper's LLM-INFER has these two and that of the usage).
const TELLS_SURROUNDINGS: [&str; 2] = ["nearby_objects", "similar_objects"];

impl<'a> Steps<'a> {
    /// Steps that cost nothing yet. What is withheld is withheld from LLM-INFER alone: a question may still name a
    /// role, and an answer that does can still be read. Where scores are fused, the model is not offered what the
    /// evidence model weighs, because it would count twice, nor what the task tells already. No tool of the server that
    /// judges by itself, such as `whose_is`, is offered: the model would repeat its judgement, and learn what is withheld.
    pub fn new(
        model: &'a dyn ChatModel,
        server: &'a ToolServer,
        roster: &'a Roster,
        withheld: &BTreeSet<Withheld>,
        scoring: Scoring,
    ) -> Self {
        let fused = scoring.estimator == Estimator::Fused;
        let told = |tool: &ToolDefinition| match (scoring.context, tool.name.as_str()) {
            (ContextSource::Given, _) => false,
            (_, TELLS_USAGE) => !fused && !withheld.contains(&Withheld::Usage),
            (_, TELLS_BACKGROUND) => !fused && !withheld.contains(&Withheld::Background),
            (_, name) => TELLS_SURROUNDINGS.contains(&name),
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
            scoring,
            meter: Meter::default(),
            formats: Formats::of(roster),
        }
    }

    /// What the steps have cost so far, without the time.
    pub fn cost(&self) -> Cost {
        self.meter.cost()
    }

    /// Whether the tokens that may be spent are spent.
    pub fn is_out_of_budget(&self) -> bool {
        self.meter.is_out_of_budget()
    }

    /// The people as the model is told of them while it scores.
    pub fn household(&self) -> &Users {
        &self.household
    }

    /// The household.
    pub fn roster(&self) -> &'a Roster {
        self.roster
    }

    /// The server whose tools are called.
    pub fn server(&self) -> &'a ToolServer {
        self.server
    }

    /// How scores are made.
    pub fn scoring(&self) -> Scoring {
        self.scoring
    }

    /// LLM-INFER: the model scores every member, for one thing. It collects its evidence by tool calls, or finds it in
    /// the task.
    pub async fn infer(&self, task: &Task) -> InferStep {
        let instructions = prompts::infer_ownership(Scoring { batch: 1, ..self.scoring });
        self.score(&instructions, task, &self.formats.ownership(), |reply: OwnershipReply, attempt| {
            let scored = self.read_scores(&reply.ownership_distribution, attempt)?;
            Ok(match &reply.owner_sets {
                Some(sets) => Scored {
                    distribution: OwnerSetDistribution::from_named(self.roster, sets)
                        .map_err(|error| error.to_string())?,
                    ..scored
                },
                None => scored,
            })
        })
        .await
    }

    /// LLM-INFER for several things in one conversation.
    pub async fn infer_several(
        &self,
        task: &Task,
        things: &[ObjectId],
    ) -> InferStep<BTreeMap<ObjectId, Scored>> {
        let instructions = prompts::infer_ownership(Scoring { batch: things.len().max(2), ..self.scoring });
        let format = self.formats.ownerships(things);
        self.score(&instructions, task, &format, |mut reply: OwnershipsReply, attempt| {
            let scored = things
                .iter()
                .map(|thing| {
                    let scores = reply
                        .ownership_distributions
                        .remove(thing)
                        .ok_or_else(|| format!("the thing {thing} has no scores"))?;
                    let scored = self.read_scores(&scores, attempt);
                    Ok((thing.clone(), scored.map_err(|reason| format!("thing {thing}: {reason}"))?))
                })
                .collect::<Result<BTreeMap<ObjectId, Scored>, String>>()?;
            match reply.ownership_distributions.keys().next() {
                Some(other) => Err(format!("nobody asked about a thing {other}")),
                None => Ok(scored),
            }
        })
        .await
    }

    async fn score<Reply: DeserializeOwned, T>(
        &self,
        instructions: &str,
        task: &Task,
        format: &ReplyFormat,
        read: impl Fn(Reply, Attempt) -> Result<T, String>,
    ) -> InferStep<T> {
        let shown = match self.scoring.estimator {
            Estimator::Fused => Shown::WithoutOwners,
            Estimator::Model | Estimator::Evidence => Shown::AsTheServerGaveIt,
        };
        let mut conversation = match Conversation::new(instructions, task, shown) {
            Ok(conversation) => conversation,
            Err(error) => {
                let (called, seen) = (Vec::new(), Vec::new());
                return InferStep { called, seen, related: RelatedObjects::new(), outcome: Err(error) };
            }
        };
        let outcome = self.converse(&mut conversation, &self.tools, format, read).await;
        let Conversation { called, seen, related, .. } = conversation;
        InferStep { called, seen, related, outcome }
    }

    /// A member without a score is asked for once, and counts as 0 then.
    fn read_scores(&self, scores: &Scores, attempt: Attempt) -> Result<Scored, String> {
        for name in scores.keys() {
            self.roster.index_of(name.as_str()).map_err(|error| error.to_string())?;
        }
        let missing: Vec<&str> =
            self.roster.names().filter(|name| !scores.contains_key(*name)).map(UserName::as_str).collect();
        let remark = match (missing.is_empty(), attempt) {
            (true, _) => None,
            (false, Attempt::First) => return Err(format!("there is no score for {}", missing.join(", "))),
            (false, Attempt::Last) => {
                Some(format!("the model gave no score for {}, which counts as 0", missing.join(", ")))
            }
        };
        let scores: Vec<Score> =
            self.roster.names().map(|name| scores.get(name).copied().unwrap_or(Score::ZERO)).collect();
        Ok(Scored { distribution: OwnerSetDistribution::from_scores(&scores), scores, remark })
    }

    /// QUESTION-GENERATION: one sentence that names a likely owner.
    pub async fn word_question(&self, task: &Task) -> Result<String, StepError> {
        let mut conversation = Conversation::new(prompts::ASK_QUESTION, task, Shown::AsTheServerGaveIt)?;
        let likeliest = match task {
            Task::AskQuestion { scores, times_asked: 0, .. } => likeliest(scores),
            _ => Vec::new(),
        };
        let mut corrections = 0;
        loop {
            let reply = self.turn(&conversation, &[], &ReplyFormat::Text).await?;
            let text = reply.text.clone().unwrap_or_default();
            let reason = match usable(&reply).and_then(|()| Ok(read_sentence(&text)?)) {
                Ok(question)
                    if likeliest.is_empty() || likeliest.iter().any(|name| question.contains(name)) =>
                {
                    return Ok(question);
                }
                Ok(_) => Unfit(format!("the question names none of {}", likeliest.join(", "))),
                Err(reason) => reason,
            };
            if corrections == MOST_CORRECTIONS {
                return Err(reason.into());
            }
            corrections += 1;
            conversation.correct(text, &format!("{}. Answer with the question alone.", reason.0));
        }
    }

    /// UNDERSTAND-ANSWER: who the answer makes an owner.
    pub async fn read_answer(&self, task: &Task) -> Result<Reading, StepError> {
        let mut conversation = Conversation::new(prompts::READ_ANSWER, task, Shown::AsTheServerGaveIt)?;
        self.converse(&mut conversation, &[], &self.formats.reading(), |reply: ReadingReply, _| {
            let named = reply.ownership_boolean.iter().filter(|(_, owner)| **owner).map(|(name, _)| name);
            let owners: OwnerSet = self.roster.owner_set(named).map_err(|error| error.to_string())?;
            if reply.owner_outside_household && !owners.is_empty() {
                return Err("the owner cannot be a member and somebody outside at once".to_owned());
            }
            Ok(Reading { owners, outside_household: reply.owner_outside_household })
        })
        .await
    }

    /// The first step of Active Ownership Learning: which classes are everybody's.
    pub async fn judge_sharing(&self, classes: BTreeSet<ClassLabel>) -> Result<SharingReply, StepError> {
        let format = self.formats.sharing(&classes);
        let task = Task::JudgeSharing { classes };
        let mut conversation = Conversation::new(prompts::JUDGE_SHARING, &task, Shown::AsTheServerGaveIt)?;
        self.converse(&mut conversation, &[], &format, |reply, _| Ok(reply)).await
    }

    /// Lets the model call tools until it gives a reply that `read` accepts.
    async fn converse<Reply: DeserializeOwned, T>(
        &self,
        conversation: &mut Conversation,
        tools: &[ToolDefinition],
        format: &ReplyFormat,
        read: impl Fn(Reply, Attempt) -> Result<T, String>,
    ) -> Result<T, StepError> {
        let mut corrections = 0;
        for _ in 0..MOST_TURNS {
            let reply = self.turn(conversation, tools, format).await?;
            let text = reply.text.clone().unwrap_or_default();
            if !reply.tool_calls.is_empty() && reply.ending == Ending::Finished {
                self.call_tools(conversation, reply.text, reply.tool_calls).await?;
                continue;
            }
            let attempt = if corrections == MOST_CORRECTIONS { Attempt::Last } else { Attempt::First };
            let value = usable(&reply)
                .and_then(|()| Ok(read_json::<Reply>(&text)?))
                .and_then(|parsed| read(parsed, attempt).map_err(Unfit));
            let reason = match value {
                Ok(value) => return Ok(value),
                Err(reason) => reason,
            };
            if attempt == Attempt::Last {
                return Err(reason.into());
            }
            corrections += 1;
            conversation.correct(text, &format!("{}. Answer again with JSON only.", reason.0));
        }
        Err(StepError::Unusable { reason: format!("the model gave no answer within {MOST_TURNS} turns") })
    }

    async fn turn(
        &self,
        conversation: &Conversation,
        tools: &[ToolDefinition],
        reply: &ReplyFormat,
    ) -> Result<ChatReply, ModelError> {
        let request = ChatRequest { conversation: &conversation.messages, tools, reply };
        let answered = self.model.complete(&request).await;
        self.meter.note(&answered);
        answered
    }

    async fn call_tools(
        &self,
        conversation: &mut Conversation,
        text: Option<String>,
        calls: Vec<ToolCall>,
    ) -> Result<(), ServerError> {
        conversation.say(text, calls.clone());
        for (place, call) in calls.into_iter().enumerate() {
            let outcome = self.call_tool(conversation, place, &call).await?;
            conversation.take_result(call, outcome);
        }
        Ok(())
    }

    /// A call that cannot be made is answered in words that help to make a better one.
    async fn call_tool(
        &self,
        conversation: &mut Conversation,
        place: usize,
        call: &ToolCall,
    ) -> Result<ToolOutcome, ServerError> {
        let refused = |text: String| Ok(ToolOutcome { text, is_error: true });
        if !self.tools.iter().any(|tool| tool.name == call.tool) {
            let names: Vec<&str> = self.tools.iter().map(|tool| tool.name.as_str()).collect();
            return refused(format!("there is no tool {:?}; the tools are {}", call.tool, names.join(", ")));
        }
        if conversation.count_call(call) > MOST_EQUAL_CALLS {
            return refused(
                "this call was answered before; use that answer and come to a conclusion".to_owned(),
            );
        }
        if place >= MOST_CALLS_IN_A_TURN {
            return refused(format!("at most {MOST_CALLS_IN_A_TURN} calls are answered in one turn"));
        }
        self.meter.note_tool_call();
        match &call.arguments {
            ToolArguments::Object(arguments) => self.server.call_raw(&call.tool, arguments.clone()).await,
            ToolArguments::Malformed(text) => {
                refused(format!("the arguments must be a JSON object, not {:?}", excerpt(text)))
            }
        }
    }
}

/// What is wrong with a reply, in words for the model.
struct Unfit(String);

impl From<crate::reply::UnreadableReply> for Unfit {
    fn from(error: crate::reply::UnreadableReply) -> Self {
        Self(error.to_string())
    }
}

impl From<Unfit> for StepError {
    fn from(unfit: Unfit) -> Self {
        Self::Unusable { reason: unfit.0 }
    }
}

/// Whether the turn ended so that its words count.
fn usable(reply: &ChatReply) -> Result<(), Unfit> {
    match &reply.ending {
        Ending::Finished => Ok(()),
        Ending::CutShort => Err(Unfit("the reply was cut short at the largest length".to_owned())),
        Ending::Refused { reason } => Err(Unfit(format!("the model would not answer: {}", excerpt(reason)))),
    }
}

/// The two members with the highest scores.
fn likeliest(scores: &Scores) -> Vec<&str> {
    let mut ranked: Vec<(&UserName, &Score)> = scores.iter().collect();
    ranked.sort_by(|left, right| right.1.value().total_cmp(&left.1.value()));
    ranked.into_iter().take(2).map(|(name, _)| name.as_str()).collect()
}

#[cfg(test)]
mod tests;
