//! Turns that a model gets wrong.

use coin_host::model::{ChatReply, Ending, Message, ToolArguments, ToolCall};
use serde_json::{Map, Value, json};

use super::brain::Turn;
use super::faults::Fault;

/// The name of somebody who lives in no test's household.
const INVENTED: &str = "Zebediah";

/// The turn with something wrong; `None` where the fault does not fit it.
pub(super) fn spoil(reply: &ChatReply, turn: &Turn, fault: Fault) -> Option<ChatReply> {
    let words = |text: String| Some(ChatReply { text: Some(text), ..reply.clone() });
    match fault {
        Fault::CodeFences => words(format!("```json\n{}\n```", json_text(reply)?)),
        Fault::Prose => {
            let json = json_text(reply)?;
            words(format!("Here is what I think:\n\n{json}\n\nLet me know if I can help with anything else."))
        }
        Fault::TrailingCommas => words(json_text(reply)?.replace('}', ",}")),
        Fault::MissingPeople => {
            with_people(reply, |people| people.pop().is_some()).and_then(|value| words(value.to_string()))
        }
        Fault::InventedPeople => {
            let value = with_people(reply, |people| {
                let like = people.first().map(|(_, value)| value.clone());
                people.extend(like.map(|value| (INVENTED.to_owned(), value)));
                true
            });
            words(value?.to_string())
        }
        Fault::ScoresAsText => words(with_scores(reply, |score| json!(score.to_string()))?.to_string()),
        Fault::ScoresAsPercentages => {
            words(with_scores(reply, |score| json!(format!("{:.0}%", 100.0 * score)))?.to_string())
        }
        Fault::ScoresAboveOne => words(with_scores(reply, |score| json!(1.0 + score))?.to_string()),
        Fault::ScoresNotNumbers => {
            words(with_scores(reply, |_| json!("NaN"))?.to_string().replace("\"NaN\"", "NaN"))
        }
        Fault::ScoresAllEqual => words(with_scores(reply, |_| json!(0.5))?.to_string()),
        Fault::UnknownTool => with_first_call(reply, |call| call.tool = "find_owner".to_owned()),
        Fault::WrongArguments => with_first_call(reply, |call| {
            call.arguments = ToolArguments::Object(Map::from_iter([("objectId".to_owned(), json!(42))]));
        }),
        Fault::MalformedArguments => with_first_call(reply, |call| {
            call.arguments = ToolArguments::Malformed(half(&call.arguments.to_text()).to_owned());
        }),
        Fault::SameCallAgain => {
            let call = first_call(turn).or_else(|| reply.tool_calls.first())?;
            Some(ChatReply::calls(vec![call.clone()]))
        }
        Fault::Empty => Some(ChatReply { text: None, tool_calls: Vec::new(), ..reply.clone() }),
        Fault::Refusal => {
            let reason = "I can't help with judging people.".to_owned();
            Some(ChatReply {
                text: None,
                tool_calls: Vec::new(),
                ending: Ending::Refused { reason },
                ..reply.clone()
            })
        }
        Fault::CutShort => {
            let mut cut = ChatReply { ending: Ending::CutShort, ..reply.clone() };
            cut.text = cut.text.map(|text| half(&text).to_owned());
            if let Some(last) = cut.tool_calls.last_mut() {
                last.arguments = ToolArguments::Malformed(half(&last.arguments.to_text()).to_owned());
            }
            Some(cut)
        }
        _ => None,
    }
}

fn half(text: &str) -> &str {
    &text[..text.floor_char_boundary(text.len() / 2)]
}

/// The words, if they are a JSON object and no tool is called.
fn json_text(reply: &ChatReply) -> Option<&str> {
    let text = reply.text.as_deref().filter(|_| reply.tool_calls.is_empty())?;
    serde_json::from_str::<Map<String, Value>>(text).is_ok().then_some(text)
}

/// The words with the entries for people changed; `None` where there are none, or `change` does not fit.
fn with_people(reply: &ChatReply, change: impl FnOnce(&mut Vec<(String, Value)>) -> bool) -> Option<Value> {
    let mut words: Value = serde_json::from_str(json_text(reply)?).ok()?;
    let people = ["ownership_distribution", "ownership_boolean"]
        .into_iter()
        .find(|key| words.get(key).is_some_and(Value::is_object))?;
    let mut entries: Vec<(String, Value)> = words[people].as_object()?.clone().into_iter().collect();
    if !change(&mut entries) {
        return None;
    }
    words[people] = Value::Object(entries.into_iter().collect());
    Some(words)
}

fn with_scores(reply: &ChatReply, change: impl Fn(f64) -> Value) -> Option<Value> {
    with_people(reply, |people| {
        people.iter_mut().all(|(_, score)| {
            score.as_f64().is_some_and(|number| {
                *score = change(number);
                true
            })
        })
    })
}

fn with_first_call(reply: &ChatReply, change: impl FnOnce(&mut ToolCall)) -> Option<ChatReply> {
    let mut spoilt = reply.clone();
    change(spoilt.tool_calls.first_mut()?);
    Some(spoilt)
}

/// The first call of the conversation.
fn first_call(turn: &Turn) -> Option<&ToolCall> {
    turn.conversation.iter().find_map(|message| match message {
        Message::Assistant { tool_calls, .. } => tool_calls.first(),
        _ => None,
    })
}
