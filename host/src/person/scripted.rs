//! A person whose answers stand in a file.
//!
//! The file is JSON Lines. A line is an answer about one thing, or says that nobody answers about it:
//! ```json
//! {"object_id": "3", "answer": "It's mine", "answered_by": "Mary"}
//! {"object_id": "5", "declined": true}
//! ```
//! Answers about one thing are used in their order. The whole file is checked before the first question; white
//! lines are skipped.

#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use async_trait::async_trait;
use coin::gate::compare_ids;
use coin_schemas::household::{ObjectId, UserName, Users};
use serde::Deserialize;
use thiserror::Error;

use super::{Person, PersonError, PersonKind, PutQuestion, Response};

/// The longest line that is read, in bytes. No answer to "whose is this?" needs more.
pub const MAX_LINE_BYTES: usize = 65_536;

/// How many known ids or names an error lists.
const LISTED: usize = 10;

/// Why a file of answers is refused.
#[derive(Debug, Error)]
pub enum ScriptError {
    /// The file cannot be read.
    #[error("the answers in {} cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A line is no answer of this household.
    #[error("{}:{line}: {problem}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        problem: LineProblem,
    },
}

/// What is wrong with a line of answers.
#[derive(Debug, Error)]
pub enum LineProblem {
    /// It is longer than [`MAX_LINE_BYTES`].
    #[error("the line has more than {MAX_LINE_BYTES} bytes; an answer is a sentence or two")]
    TooLong,
    /// It is no UTF-8.
    #[error("the line is not UTF-8 text (byte {position} is the first that is not)")]
    NotUtf8 {
        /// The place of the first bad byte, from 1.
        position: usize,
    },
    /// It is no JSON object with the right keys.
    #[error(
        "{0}; a line is {{\"object_id\": …, \"answer\": …, \"answered_by\"?: …}} \
         or {{\"object_id\": …, \"declined\": true}}"
    )]
    Malformed(#[source] serde_json::Error),
    /// It says neither or both.
    #[error("a line has either \"answer\" or \"declined\": true, and this one has {given}")]
    NotOneOf {
        /// What it has.
        given: &'static str,
    },
    /// It says who declined.
    #[error("\"answered_by\" belongs to an \"answer\", and this line has none")]
    DeclinedBySomebody,
    /// The answer is empty.
    #[error("\"answer\" is empty; for a question that nobody answers write \"declined\": true")]
    EmptyAnswer,
    /// The thing is not in the episode.
    #[error("object_id {given:?} is not in the episode; it has {}", listed(known))]
    UnknownObject {
        /// The id.
        given: String,
        /// The ids that there are.
        known: Vec<String>,
    },
    /// The person is not of the household.
    #[error("answered_by {given:?} is not a member of the household; its members are {}", listed(known))]
    UnknownUser {
        /// The name.
        given: String,
        /// The names that there are.
        known: Vec<String>,
    },
}

fn listed(known: &[String]) -> String {
    match known.len() {
        0 => "none".to_owned(),
        count if count > LISTED => format!("{} … ({count} in all)", known[..LISTED].join(", ")),
        _ => known.join(", "),
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    object_id: String,
    answer: Option<String>,
    answered_by: Option<String>,
    declined: Option<bool>,
}

/// A person who says what a file says.
///
/// A thing that no line is left for is declined, so that the run goes on with the next one. Once every line of
/// the file is used there is nobody left to ask.
#[derive(Debug, Clone)]
pub struct ScriptedPerson {
    responses: BTreeMap<ObjectId, VecDeque<Response>>,
}

impl ScriptedPerson {
    /// Reads and checks the whole file against the things and people of the episode.
    ///
    /// # Errors
    /// If the file cannot be read, or a line is not of the form above, or names a thing or a person that the
    /// episode does not know.
    pub fn from_file(
        path: impl AsRef<Path>,
        objects: &BTreeSet<ObjectId>,
        users: &Users,
    ) -> Result<Self, ScriptError> {
        let path = path.as_ref();
        let read_error = |source| ScriptError::Read { path: path.to_owned(), source };
        let mut reader = BufReader::new(File::open(path).map_err(read_error)?);
        let mut responses: BTreeMap<ObjectId, VecDeque<Response>> = BTreeMap::new();
        let mut bytes = Vec::new();
        for line in 1.. {
            bytes.clear();
            let most = MAX_LINE_BYTES as u64 + 1;
            if reader.by_ref().take(most).read_until(b'\n', &mut bytes).map_err(read_error)? == 0 {
                break;
            }
            let parsed = parse_line(&bytes, objects, users).map_err(|problem| ScriptError::Line {
                path: path.to_owned(),
                line,
                problem,
            })?;
            if let Some((object, response)) = parsed {
                responses.entry(object).or_default().push_back(response);
            }
        }
        Ok(Self { responses })
    }
}

fn parse_line(
    bytes: &[u8],
    objects: &BTreeSet<ObjectId>,
    users: &Users,
) -> Result<Option<(ObjectId, Response)>, LineProblem> {
    let bytes = bytes.strip_suffix(b"\n").unwrap_or(bytes);
    if bytes.len() > MAX_LINE_BYTES {
        return Err(LineProblem::TooLong);
    }
    let text = std::str::from_utf8(bytes)
        .map_err(|error| LineProblem::NotUtf8 { position: error.valid_up_to() + 1 })?;
    if text.trim().is_empty() {
        return Ok(None);
    }
    let Line { object_id, answer, answered_by, declined } =
        serde_json::from_str(text).map_err(LineProblem::Malformed)?;
    let Some(object) = objects.get(object_id.as_str()) else {
        let mut known: Vec<&ObjectId> = objects.iter().collect();
        known.sort_by(|left, right| compare_ids(left, right));
        let known = known.into_iter().map(ToString::to_string).collect();
        return Err(LineProblem::UnknownObject { given: object_id, known });
    };
    let response = match (answer, declined) {
        (Some(answer), None) if answer.trim().is_empty() => return Err(LineProblem::EmptyAnswer),
        (Some(answer), None) => {
            Response::Said { answer, answered_by: answered_by.map(|name| member(name, users)).transpose()? }
        }
        (None, Some(true)) if answered_by.is_some() => return Err(LineProblem::DeclinedBySomebody),
        (None, Some(true)) => Response::Declined,
        (None, Some(false)) => return Err(LineProblem::NotOneOf { given: "\"declined\": false" }),
        (Some(_), Some(_)) => return Err(LineProblem::NotOneOf { given: "both" }),
        (None, None) => return Err(LineProblem::NotOneOf { given: "neither" }),
    };
    Ok(Some((object.clone(), response)))
}

fn member(name: String, users: &Users) -> Result<UserName, LineProblem> {
    match users.get_key_value(name.as_str()) {
        Some((user, _)) => Ok(user.clone()),
        None => Err(LineProblem::UnknownUser {
            given: name,
            known: users.keys().map(ToString::to_string).collect(),
        }),
    }
}

#[async_trait]
impl Person for ScriptedPerson {
    fn kind(&self) -> PersonKind {
        PersonKind::Scripted
    }

    async fn ask(&mut self, question: &PutQuestion<'_>) -> Result<Response, PersonError> {
        if self.responses.values().all(VecDeque::is_empty) {
            return Ok(Response::NobodyLeft);
        }
        let prepared = self.responses.get_mut(&question.object.id).and_then(VecDeque::pop_front);
        Ok(prepared.unwrap_or(Response::Declined))
    }

    fn recall(&mut self, object: &ObjectId) {
        if let Some(responses) = self.responses.get_mut(object) {
            responses.pop_front();
        }
    }
}
