//! The story of a run, told on stderr while it happens.

#[cfg(test)]
mod tests;

use std::io::{self, Write};

use coin_schemas::household::{ClassLabel, ObjectId, Owners, UserName, Users};
use coin_schemas::report::AnswerStatus;
use coin_server::display::{count, names_with_and, owners_in_words, percent, plain_text};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::Style;
use super::layout::labelled;
use crate::person::PersonKind;

/// How many changed things a line lists.
const CHANGES_LISTED: usize = 6;

/// How many things that the model faltered on are named in a pass.
const FALTERS_TOLD: usize = 3;

/// A belief as it was before an answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Belief<'a> {
    /// The most probable owner set.
    pub owners: &'a Owners,
    /// Its probability.
    pub confidence: f64,
}

/// A thing whose owners are seen differently after an answer about another thing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Changed {
    /// The thing.
    pub object_id: ObjectId,
    /// Its class label.
    pub class: ClassLabel,
    /// Its owners before.
    pub before: Owners,
    /// Its owners now.
    pub after: Owners,
}

/// An answer and what came of it.
#[derive(Debug, Clone, Copy)]
pub struct AnswerRead<'a> {
    /// The number of the question, from 1.
    pub step: usize,
    /// The answer as it was given.
    pub answer: &'a str,
    /// Who gave it, where known.
    pub answered_by: Option<&'a UserName>,
    /// The owners that it names; none where the owner is somebody outside the household.
    pub owners: &'a Owners,
    /// What became of it.
    pub status: AnswerStatus,
    /// What was believed before; `None` where the model had failed.
    pub before: Option<Belief<'a>>,
    /// Whom an earlier answer named, where this one was to confirm it.
    pub said_before: Option<&'a Owners>,
    /// The other things that the answer changed.
    pub changed: &'a [Changed],
}

/// Tells a person what happens. That nobody can read it stops nothing: a closed stderr is ignored.
pub struct Narration {
    writer: Box<dyn Write + Send>,
    style: Style,
    person: PersonKind,
    bars: Bars,
    bar: Option<ProgressBar>,
    household: Owners,
    /// How many things the model faltered on in this pass.
    faltered: usize,
}

/// Whether progress is drawn while a model works.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bars {
    /// Drawn on stderr.
    Drawn,
    /// Not drawn: nobody is watching.
    Hidden,
}

impl Narration {
    /// A story that is told to `writer`. A question that a person sees at the terminal is not told again.
    pub(super) fn new(writer: Box<dyn Write + Send>, style: Style, person: PersonKind, bars: Bars) -> Self {
        Self { writer, style, person, bars, bar: None, household: Owners::new(), faltered: 0 }
    }

    /// A story that nobody hears.
    pub fn silent() -> Self {
        let style = Style { width: super::style::DEFAULT_WIDTH, colour: super::Colour::Never };
        Self::new(Box::new(io::sink()), style, PersonKind::Simulated, Bars::Hidden)
    }

    /// The run begins: where, with whom, and with how many things.
    pub fn run_started(&mut self, name: &str, users: &Users, objects: usize) {
        self.household = users.keys().cloned().collect();
        let people: Vec<&UserName> = users.keys().collect();
        let live = if people.len() == 1 { "lives" } else { "live" };
        self.tell(&format!(
            "{}: {} {live} here, with {}.\n",
            self.style.heading(plain_text(name)),
            names_with_and(&people),
            count(objects as u64, "thing", "things"),
        ));
    }

    /// A model begins to score things. Pass 0 precedes the first question.
    pub fn inference_started(&mut self, pass: usize, things: usize) {
        let things_in_words = count(things as u64, "thing", "things");
        if self.bars == Bars::Hidden {
            if pass == 0 {
                self.tell(&format!("Inferring the owners of {things_in_words} …\n"));
            }
            return;
        }
        let bar = ProgressBar::with_draw_target(Some(things as u64), ProgressDrawTarget::stderr());
        if let Ok(template) = ProgressStyle::with_template("  {bar:30} {pos}/{len} {msg}") {
            bar.set_style(template.progress_chars("━━─"));
        }
        bar.set_message(if pass == 0 { "things inferred" } else { "things seen anew" });
        self.bar = Some(bar);
    }

    /// One more thing is scored.
    pub fn object_inferred(&mut self) {
        if let Some(bar) = &self.bar {
            bar.inc(1);
        }
    }

    /// The model failed on a thing or had to be corrected. A server that is gone fails on everything, so that only the
    /// first things of a pass are named.
    pub fn model_faltered(&mut self, object_id: &ObjectId, class: &ClassLabel, reason: &str) {
        self.faltered += 1;
        if self.faltered <= FALTERS_TOLD {
            self.warning(&format!("{}: {reason}", thing(object_id, class)));
        }
    }

    /// Every thing of the pass is scored.
    pub fn inference_finished(&mut self) {
        let faltered = std::mem::take(&mut self.faltered);
        if faltered > FALTERS_TOLD {
            let more = count((faltered - FALTERS_TOLD) as u64, "thing", "things");
            self.warning(&format!("so it went with {more} more; the report names them"));
        }
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }

    /// A question is put.
    pub fn question_asked(&mut self, step: usize, question: &str) {
        if self.person == PersonKind::Terminal {
            return;
        }
        let question = plain_text(question.trim()).into_owned();
        let text = labelled(&[(&format!("Q{step}"), question)], 2, 3, self.style.width);
        self.tell(&format!("\n{text}"));
    }

    /// A question of an earlier part of the run, which nobody sees now. Where a person answers at the terminal the
    /// answer is told as well, because it is not told with what came of it.
    pub fn question_recalled(&mut self, step: usize, question: &str, answer: &str) {
        let label = format!("Q{step}");
        let question = plain_text(question.trim()).into_owned();
        let mut rows = vec![(label.as_str(), question)];
        if self.person == PersonKind::Terminal && !answer.is_empty() {
            rows.push(("", format!("“{}”", plain_text(answer.trim()))));
        }
        let text = labelled(&rows, 2, 3, self.style.width);
        self.tell(&format!("\n{text}"));
    }

    /// An answer was read.
    pub fn answer_read(&mut self, read: &AnswerRead<'_>) {
        let speaker = read.answered_by.map(|name| format!("{}: ", plain_text(name.as_str())));
        let said = format!("{}“{}”", speaker.unwrap_or_default(), plain_text(read.answer.trim()));
        let mut rows = match self.person {
            PersonKind::Terminal => vec![("", format!("→  {}", self.outcome(read)))],
            PersonKind::Simulated | PersonKind::Scripted => {
                vec![("", format!("{said}  →  {}", self.outcome(read)))]
            }
        };
        if !read.changed.is_empty() {
            rows.push(("", format!("This also changes {}.", self.changes(read.changed))));
        }
        let text = labelled(&rows, 2, 3, self.style.width);
        self.tell(&text);
    }

    fn outcome(&self, read: &AnswerRead<'_>) -> String {
        let thought = read.before.map(|belief| {
            (belief.owners, owners_in_words(belief.owners, &self.household), percent(belief.confidence))
        });
        if let (AnswerStatus::Answered, Some(said)) = (read.status, read.said_before) {
            let owners = owners_in_words(read.owners, &self.household);
            return match said == read.owners {
                true => format!("{owners}, as said before"),
                false => format!("{owners} (said before: {})", owners_in_words(said, &self.household)),
            };
        }
        match (read.status, thought) {
            (AnswerStatus::Unresolved, _) => "leaves it open".to_owned(),
            (AnswerStatus::Answered, None) => owners_in_words(read.owners, &self.household),
            (AnswerStatus::Answered, Some((before, _, sure))) if before == read.owners => {
                format!("{}, as thought ({sure})", owners_in_words(read.owners, &self.household))
            }
            (AnswerStatus::Answered, Some((_, before, sure))) => {
                format!("{} (was {before}, {sure})", owners_in_words(read.owners, &self.household))
            }
        }
    }

    fn changes(&self, changed: &[Changed]) -> String {
        let mut texts: Vec<String> = changed
            .iter()
            .take(CHANGES_LISTED)
            .map(|change| {
                format!(
                    "{} ({} → {})",
                    thing(&change.object_id, &change.class),
                    owners_in_words(&change.before, &self.household),
                    owners_in_words(&change.after, &self.household),
                )
            })
            .collect();
        if changed.len() > CHANGES_LISTED {
            texts.push(format!("{} more", changed.len() - CHANGES_LISTED));
        }
        texts.join(", ")
    }

    /// A person would not answer.
    pub fn declined(&mut self) {
        self.tell_aside("No answer.");
    }

    /// An answer was taken back.
    pub fn answer_undone(&mut self, step: usize) {
        self.tell_aside(&format!("The answer to Q{step} is taken back."));
    }

    /// Nobody is left to ask.
    pub fn nobody_left(&mut self) {
        self.tell_aside("Nobody is left to ask.");
    }

    fn tell_aside(&mut self, remark: &str) {
        let text = labelled(&[("", remark.to_owned())], 2, 3, self.style.width);
        self.tell(&text);
    }

    /// Something that the person should know and that stops nothing.
    pub fn warning(&mut self, text: &str) {
        let warning = format!("{} {}\n", self.style.caution("warning:"), plain_text(text));
        self.tell(&warning);
    }

    fn tell(&mut self, text: &str) {
        let writer = &mut self.writer;
        let mut write = || {
            let _ = writer.write_all(text.as_bytes()).and_then(|()| writer.flush());
        };
        match &self.bar {
            Some(bar) => bar.suspend(write),
            None => write(),
        }
    }
}

fn thing(object_id: &ObjectId, class: &ClassLabel) -> String {
    format!("{} {}", plain_text(class.as_str()), plain_text(object_id.as_str()))
}
