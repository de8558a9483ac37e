//! Somebody at the terminal.
//!
//! The question is shown with the likeliest owners as numbered choices. A number (or several, as in `1 and 3`)
//! stands for those people; any other words are taken as they are and go to the model that reads answers. `skip`
//! passes the question over, the end of the input ends the questions.

mod lines;
#[cfg(test)]
mod tests;

use std::io::{BufRead, BufReader, Stderr, Stdin, Write};

use async_trait::async_trait;
use coin_schemas::household::UserName;

use self::lines::{Line, Lines};
use super::{Person, PersonError, PersonKind, PutQuestion, Response};
use crate::output::plain_text;

/// How many people are offered as numbered choices; the others can be named.
const MOST_CHOICES: usize = 9;

/// Words by which speakers mean themselves, so that an answer needs a name beside it.
const FIRST_PERSON: [&str; 4] = ["mine", "my", "me", "i"];

/// A person who reads questions and types answers.
#[derive(Debug)]
pub struct TerminalPerson<W> {
    lines: Lines,
    writer: W,
}

impl TerminalPerson<Stderr> {
    /// Asks on standard error and listens to standard input.
    ///
    /// # Errors
    /// If no thread can be started to wait for input.
    pub fn at_the_prompt() -> Result<Self, PersonError> {
        let input: BufReader<Stdin> = BufReader::new(std::io::stdin());
        Self::new(input, std::io::stderr())
    }
}

impl<W: Write + Send> TerminalPerson<W> {
    /// Asks by writing to `writer` and takes answers from `reader`, a line each.
    ///
    /// # Errors
    /// If no thread can be started to wait for input.
    pub fn new(reader: impl BufRead + Send + 'static, writer: W) -> Result<Self, PersonError> {
        Ok(Self { lines: Lines::of(reader).map_err(PersonError::Read)?, writer })
    }

    fn show(&mut self, text: &str) -> Result<(), PersonError> {
        self.writer.write_all(text.as_bytes()).and_then(|()| self.writer.flush()).map_err(PersonError::Show)
    }

    /// Shows a text and waits for a line, as often as it takes to get one that can be read.
    async fn prompt(&mut self, text: &str) -> Result<Option<String>, PersonError> {
        self.show(text)?;
        loop {
            match self.lines.next().await.map_err(PersonError::Read)? {
                Line::Text(line) => return Ok(Some(line.trim().to_owned())),
                Line::Unreadable(why) => self.show(&format!("       {why}\n  > "))?,
                Line::End => {
                    self.show("\n")?;
                    return Ok(None);
                }
            }
        }
    }

    /// Asks who speaks; an empty line leaves it open.
    async fn who_speaks(&mut self, choices: &[UserName]) -> Result<Option<UserName>, PersonError> {
        let mut text =
            format!("       And who are you?  {}  (Enter leaves it open)\n  > ", numbered(choices));
        loop {
            let Some(line) = self.prompt(&text).await? else { return Ok(None) };
            if line.is_empty() || line.eq_ignore_ascii_case("skip") {
                return Ok(None);
            }
            match choose(&line, choices) {
                Choice::Of(chosen) if chosen.len() == 1 => return Ok(chosen.into_iter().next()),
                _ => match choices.iter().find(|name| name.as_str().eq_ignore_ascii_case(&line)) {
                    Some(name) => return Ok(Some(name.clone())),
                    None => text = "       Please give one number or name.\n  > ".to_owned(),
                },
            }
        }
    }
}

#[async_trait]
impl<W: Write + Send> Person for TerminalPerson<W> {
    fn kind(&self) -> PersonKind {
        PersonKind::Terminal
    }

    async fn ask(&mut self, question: &PutQuestion<'_>) -> Result<Response, PersonError> {
        let choices = &question.candidates[..question.candidates.len().min(MOST_CHOICES)];
        let mut text = format!(
            "\n  {:<3}  {}\n       {}\n       A number, or your own words; \"skip\" passes it over.\n  > ",
            format!("Q{}", question.step),
            plain_text(question.question.trim()),
            numbered(choices),
        );
        let mut silences = 0;
        loop {
            let Some(line) = self.prompt(&text).await? else { return Ok(Response::NobodyLeft) };
            if line.is_empty() {
                silences += 1;
                if silences > 1 {
                    return Ok(Response::Declined);
                }
                text = "       Whose is it? Press Enter again to pass it over.\n  > ".to_owned();
                continue;
            }
            if line.eq_ignore_ascii_case("skip") {
                return Ok(Response::Declined);
            }
            match choose(&line, choices) {
                Choice::Of(chosen) => {
                    let names: Vec<&str> = chosen.iter().map(UserName::as_str).collect();
                    return Ok(Response::Said { answer: names.join(" and "), answered_by: None });
                }
                Choice::OutOfRange => {
                    text = format!("       The choices are 1 to {}.\n  > ", choices.len());
                }
                Choice::OwnWords => {
                    let answered_by = if speaks_of_self(&line) {
                        self.who_speaks(question.candidates).await?
                    } else {
                        None
                    };
                    return Ok(Response::Said { answer: line, answered_by });
                }
            }
        }
    }
}

/// `1 Tom   2 Mary`.
fn numbered(choices: &[UserName]) -> String {
    let choices: Vec<String> = choices
        .iter()
        .enumerate()
        .map(|(place, name)| format!("{} {}", place + 1, plain_text(name.as_str())))
        .collect();
    choices.join("   ")
}

#[derive(Debug, PartialEq)]
enum Choice {
    /// These people, by number.
    Of(Vec<UserName>),
    /// A number that stands for nobody.
    OutOfRange,
    /// No number.
    OwnWords,
}

/// Reads `2`, `1 3`, `1, 3`, `1 and 3`, `1+3`; anything with another word in it is the speaker's own words.
fn choose(line: &str, choices: &[UserName]) -> Choice {
    let parts: Vec<&str> = line
        .split(|letter: char| letter.is_whitespace() || ",;+&.".contains(letter))
        .filter(|part| !part.is_empty() && !part.eq_ignore_ascii_case("and"))
        .collect();
    if parts.is_empty() || !parts.iter().all(|part| part.bytes().all(|byte| byte.is_ascii_digit())) {
        return Choice::OwnWords;
    }
    let mut chosen: Vec<UserName> = Vec::new();
    for part in parts {
        let place = part.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
        match place.and_then(|place| choices.get(place)) {
            Some(name) if chosen.contains(name) => {}
            Some(name) => chosen.push(name.clone()),
            None => return Choice::OutOfRange,
        }
    }
    Choice::Of(chosen)
}

/// Whether the speaker's name is needed to understand the answer. "I don't know" and "I think" need none.
fn speaks_of_self(answer: &str) -> bool {
    const MANNERS: [&str; 8] =
        ["i don't", "i dont", "i don’t", "i do not", "i think", "i guess", "i believe", "i'm not sure"];
    let answer = answer.to_lowercase();
    let answer = MANNERS.iter().fold(answer, |answer, manner| answer.replace(manner, ""));
    answer.split(|letter: char| !letter.is_alphanumeric()).any(|word| FIRST_PERSON.contains(&word))
}
