//! Somebody at the terminal.
//!
//! The question is shown with the likeliest owners as numbered choices. Numbers and names, also several of them,
//! `e` for everybody and `o` for somebody else are choices, which mean what they say. Any other words are taken as
//! they are and go to the model that reads answers. `?` says that the person does not know, `skip` passes the
//! question over, `undo` takes the last answer back, `stop` ends the questions, and so does the end of the input.

mod choices;
mod lines;
mod screen;
#[cfg(test)]
mod tests;

use std::io::{BufRead, BufReader, Stderr, Stdin, Write};

use async_trait::async_trait;
use coin_schemas::household::{Owners, UserName};

use self::choices::{Besides, Choices, FIRST_PERSON, Picked, Typed};
use self::lines::{Line, Lines};
use super::{Person, PersonError, PersonKind, PutQuestion, Response};
use crate::output::Style;

/// What is taken as the answer of a person who picks `?`.
const UNSURE: &str = "I don't know.";

/// A person who reads questions and types answers.
#[derive(Debug)]
pub struct TerminalPerson<W> {
    lines: Lines,
    writer: W,
    style: Style,
    /// Who last said so, where "mine" was said.
    speaker: Option<UserName>,
}

impl TerminalPerson<Stderr> {
    /// Asks on standard error and listens to standard input.
    ///
    /// # Errors
    /// If no thread can be started to wait for input.
    pub fn at_the_prompt() -> Result<Self, PersonError> {
        let input: BufReader<Stdin> = BufReader::new(std::io::stdin());
        Self::new(input, std::io::stderr(), Style::of_stderr())
    }
}

/// Who says "mine".
enum Speaker {
    /// This member, or somebody unknown.
    Is(Option<UserName>),
    /// The words were a slip; the question is put again.
    TakenBack,
    /// Somebody who wants to stop.
    Leaving,
}

impl<W: Write + Send> TerminalPerson<W> {
    /// Asks by writing to `writer`, set in this style, and takes answers from `reader`, a line each.
    ///
    /// # Errors
    /// If no thread can be started to wait for input.
    pub fn new(reader: impl BufRead + Send + 'static, writer: W, style: Style) -> Result<Self, PersonError> {
        Ok(Self { lines: Lines::of(reader).map_err(PersonError::Read)?, writer, style, speaker: None })
    }

    fn show(&mut self, text: &str) -> Result<(), PersonError> {
        self.writer.write_all(text.as_bytes()).and_then(|()| self.writer.flush()).map_err(PersonError::Show)
    }

    fn remark(&mut self, text: &str) -> Result<(), PersonError> {
        self.show(&screen::remark(self.style, text))
    }

    /// Shows a text and waits for a line, as often as it takes to get one that can be read.
    async fn prompt(&mut self, text: &str) -> Result<Option<String>, PersonError> {
        self.show(text)?;
        loop {
            self.show(screen::PROMPT)?;
            match self.lines.next().await.map_err(PersonError::Read)? {
                Line::Text(line) => return Ok(Some(line.trim().to_owned())),
                Line::Unreadable(why) => self.remark(&why)?,
                Line::End => {
                    self.show("\n")?;
                    return Ok(None);
                }
            }
        }
    }

    /// Asks who speaks. An empty line means whoever spoke before, or leaves it open.
    async fn who_speaks(&mut self, all: Choices<'_>) -> Result<Speaker, PersonError> {
        let mut text = screen::who_speaks(self.style, &all, self.speaker.as_ref());
        loop {
            let Some(line) = self.prompt(&text).await? else { return Ok(Speaker::Is(None)) };
            match all.read(&line) {
                Typed::Nothing => return Ok(Speaker::Is(self.speaker.clone())),
                Typed::Unsure | Typed::Skip => return Ok(Speaker::Is(None)),
                Typed::Undo => return Ok(Speaker::TakenBack),
                Typed::Stop => return Ok(Speaker::Leaving),
                Typed::Picked(Picked { members, besides: Besides::Nobody }) if members.len() == 1 => {
                    self.speaker = members.into_iter().next();
                    return Ok(Speaker::Is(self.speaker.clone()));
                }
                Typed::Ambiguous(names) => text = screen::remark(self.style, &ambiguous(&names)),
                _ => text = screen::remark(self.style, "Please give one number or name."),
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
        let style = self.style;
        let (likeliest, all) = (Choices::likeliest(question.candidates), Choices::all(question.candidates));
        let mut choices = likeliest;
        // Who was picked together with somebody who has no number.
        let mut picked_before: Option<Vec<UserName>> = None;
        let mut text = screen::question(style, question, &choices);
        let mut silences = 0;
        loop {
            let Some(line) = self.prompt(&text).await? else { return Ok(Response::NobodyLeft) };
            text = match choices.read(&line) {
                Typed::Nothing => {
                    silences += 1;
                    if silences > 1 {
                        return Ok(Response::Declined);
                    }
                    screen::remark(style, "Whose is it? Press Enter again to pass it over.")
                }
                Typed::Picked(picked) => {
                    let asked_who = picked_before.is_some();
                    let picked = picked.after(picked_before.take().unwrap_or_default());
                    if picked.besides == Besides::SomebodyElse
                        && !asked_who
                        && choices.hides_others_than(&picked.members)
                    {
                        choices = all;
                        picked_before = Some(picked.members);
                        screen::who_else(style, &likeliest, &all)
                    } else {
                        return self.chose(picked, question);
                    }
                }
                Typed::Unsure => {
                    self.remark("Noted: you do not know.")?;
                    return Ok(Response::Said { answer: UNSURE.to_owned(), answered_by: None });
                }
                Typed::Skip => return Ok(Response::Declined),
                Typed::Stop => return Ok(Response::Stop),
                Typed::Undo if picked_before.is_some() => {
                    picked_before = None;
                    choices = likeliest;
                    screen::question(style, question, &choices)
                }
                Typed::Undo if question.before.is_some() => return Ok(Response::Undo),
                Typed::Undo => screen::remark(style, "There is no answer yet that could be taken back."),
                Typed::Help => screen::help(style, &choices),
                Typed::OutOfRange => screen::remark(style, &out_of_range(&choices)),
                Typed::Ambiguous(names) => screen::remark(style, &ambiguous(&names)),
                Typed::Meaningless => screen::remark(
                    style,
                    "That means nothing here. Please give a number, a name or a sentence; help says more.",
                ),
                Typed::OwnWords if speaks_of_self(&line) => match self.who_speaks(all).await? {
                    Speaker::Is(answered_by) => {
                        return Ok(Response::Said {
                            answer: together(picked_before.as_deref(), line),
                            answered_by,
                        });
                    }
                    Speaker::Leaving => return Ok(Response::Stop),
                    Speaker::TakenBack => {
                        picked_before = None;
                        choices = likeliest;
                        screen::question(style, question, &choices)
                    }
                },
                Typed::OwnWords => {
                    return Ok(Response::Said {
                        answer: together(picked_before.as_deref(), line),
                        answered_by: None,
                    });
                }
            };
        }
    }
}

impl<W: Write + Send> TerminalPerson<W> {
    /// Says what was understood of a choice, and hands it on.
    fn chose(&mut self, picked: Picked, question: &PutQuestion<'_>) -> Result<Response, PersonError> {
        let household: Owners = question.candidates.iter().map(|candidate| candidate.name.clone()).collect();
        let response = Response::Chose {
            owners: picked.members.into_iter().collect(),
            owner_outside_household: picked.besides == Besides::SomebodyElse,
            answered_by: None,
        };
        self.remark(&format!("Noted: {}.", response.in_words(&household).unwrap_or_default()))?;
        Ok(response)
    }
}

/// Words that say who owns a thing besides those who were picked.
fn together(picked: Option<&[UserName]>, words: String) -> String {
    let picked: Vec<String> = picked.unwrap_or_default().iter().map(ToString::to_string).collect();
    if picked.is_empty() { words } else { format!("{} and {words}", picked.join(", ")) }
}

fn out_of_range(choices: &Choices<'_>) -> String {
    let numbers = match choices.numbered().len() {
        0 => return "There are no numbers to choose from.".to_owned(),
        1 => "The only number is 1".to_owned(),
        last => format!("The numbers are 1 to {last}"),
    };
    if choices.hides_others_than(&[]) {
        format!("{numbers}; o shows who else there is, and every name will do.")
    } else {
        format!("{numbers}.")
    }
}

fn ambiguous(names: &[UserName]) -> String {
    let names: Vec<&str> = names.iter().map(UserName::as_str).collect();
    format!("That may be {}; please give the number, or the name just so.", names.join(" or "))
}

/// Whether the speaker's name is needed to understand the answer. "I don't know" and "I think" need none.
fn speaks_of_self(answer: &str) -> bool {
    const MANNERS: [&str; 8] =
        ["i don't", "i dont", "i don’t", "i do not", "i think", "i guess", "i believe", "i'm not sure"];
    let answer = answer.to_lowercase();
    let answer = MANNERS.iter().fold(answer, |answer, manner| answer.replace(manner, ""));
    answer.split(|letter: char| !letter.is_alphanumeric()).any(|word| FIRST_PERSON.contains(&word))
}
