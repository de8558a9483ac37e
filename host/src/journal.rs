//! The journal of a run: what was concluded and answered, in a file beside the database, so that a run goes on where
//! it ended, also after a crash.
//!
//! An answer is written here and forced to the disk before it is recorded in the database: between the two nothing is
//! lost, and recording it once more when the run goes on changes nothing.

use std::collections::{BTreeMap, VecDeque};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use coin::agent::{Inference, Parts};
use coin::owners::{DistributionError, OwnerSetDistribution};
use coin::roster::{Roster, RosterError};
use coin_schemas::household::ObjectId;
use coin_schemas::journal::{JOURNAL_VERSION, JournalEntry, JournalHeading};
use coin_schemas::report::{AnswerStatus, QuestionReport, ScoreParts};
use thiserror::Error;

/// What is added to the name of the database.
const SUFFIX: &str = ".run.jsonl";

/// How long a run that is just ending is waited for. A program that is being started holds its parent's locks for a moment.
const LOCK_PATIENCE: Duration = Duration::from_millis(500);

/// How often it is looked whether it has ended.
const LOOK_EVERY: Duration = Duration::from_millis(10);

/// Why a journal cannot be used.
#[derive(Debug, Error)]
pub enum JournalError {
    /// The file cannot be read or written.
    #[error("the journal of the run, {}, cannot be used: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Another run is under way with the same database.
    #[error("another run is under way with this database ({} is locked); wait for it or name another --db", path.display())]
    Locked {
        /// The file.
        path: PathBuf,
    },
    /// A line is no entry.
    #[error("{}, line {line}: {source}; start anew without --resume", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: usize,
        /// Why.
        source: serde_json::Error,
    },
    /// The journal is of another run.
    #[error(
        "the run in {} cannot go on: {difference}; give the same settings, or start anew without --resume",
        path.display()
    )]
    OtherRun {
        /// The file.
        path: PathBuf,
        /// What differs.
        difference: String,
    },
    /// An entry does not fit the household.
    #[error("an entry of the journal does not fit the household: {0}; start anew without --resume")]
    Roster(#[from] RosterError),
    /// Nor does this one.
    #[error("an entry of the journal does not fit the household: {0}; start anew without --resume")]
    Distribution(#[from] DistributionError),
}

/// How a question of an earlier part of the run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum PastQuestion {
    /// It was answered.
    Answered {
        /// The question and its answer.
        question: QuestionReport,
        /// Whether the answer may not have reached the database.
        recorded: Recorded,
        /// The owner is somebody outside the household.
        owner_outside_household: bool,
    },
    /// Somebody would not answer it.
    Declined {
        /// The question.
        question: QuestionReport,
    },
}

/// Whether an answer has reached the database.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Recorded {
    /// Later entries show that it has.
    Surely,
    /// The run ended right after it was written here.
    Perhaps,
}

/// What an earlier part of the run brought: the inferences of a pass, and the question after it.
#[derive(Debug, Default)]
struct Pass {
    inferred: BTreeMap<ObjectId, Inference>,
    question: Option<PastQuestion>,
}

/// The journal of a run, or of none: a run without a database keeps nothing.
#[derive(Debug, Default)]
pub struct Journal {
    file: Option<(PathBuf, File)>,
    past: VecDeque<Pass>,
    /// The thing whose answer was taken back right before the run ended.
    withdrawn: Vec<ObjectId>,
}

/// How a run begins.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Beginning {
    /// From the start; the journal of an earlier run is given up.
    #[default]
    Anew,
    /// Where the run of the journal ended.
    WhereItEnded,
}

fn lock(file: &File) -> Result<(), TryLockError> {
    let deadline = Instant::now() + LOCK_PATIENCE;
    loop {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) if Instant::now() < deadline => thread::sleep(LOOK_EVERY),
            outcome => return outcome,
        }
    }
}

/// The journal that belongs to a database.
pub fn beside(db: &Path) -> PathBuf {
    let mut name = db.as_os_str().to_owned();
    name.push(SUFFIX);
    PathBuf::from(name)
}

impl Journal {
    /// Keeps nothing.
    pub fn none() -> Self {
        Self::default()
    }

    /// Opens the journal beside a database for the run of this heading. Where the run goes on, `heading` gets the
    /// answers from before its beginning, and what has been concluded since is handed out by [`Self::past_inference`]
    /// and [`Self::past_question`].
    ///
    /// # Errors
    /// If the file cannot be used, another run uses it, or it is of another run.
    pub fn open(
        db: &Path,
        beginning: Beginning,
        heading: &mut JournalHeading,
        roster: &Roster,
    ) -> Result<Self, JournalError> {
        let path = beside(db);
        let failed = |source| JournalError::File { path: path.clone(), source };
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        let mut file = options.open(&path).map_err(failed)?;
        lock(&file).map_err(|error| match error {
            TryLockError::WouldBlock => JournalError::Locked { path: path.clone() },
            TryLockError::Error(source) => failed(source),
        })?;
        let mut text = String::new();
        let (mut past, mut withdrawn) = (VecDeque::new(), Vec::new());
        if beginning == Beginning::WhereItEnded {
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).map_err(failed)?;
            // A last line without its end was being written when the run crashed; nothing rests on it.
            bytes.truncate(bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1));
            text = String::from_utf8(bytes)
                .map_err(|error| failed(std::io::Error::new(std::io::ErrorKind::InvalidData, error)))?;
            let entries = read_entries(&path, &text)?;
            if let Some((JournalEntry::Run(of_run), entries)) = entries.split_first() {
                if let Some(difference) = difference(of_run, heading) {
                    return Err(JournalError::OtherRun { path, difference });
                }
                heading.answered.clone_from(&of_run.answered);
                (past, withdrawn) = read_past(entries, roster)?;
            }
        }
        file.set_len(text.len() as u64).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        let mut journal = Self { file: Some((path, file)), past, withdrawn };
        if text.is_empty() {
            journal.write(&JournalEntry::Run(heading.clone()))?;
        }
        Ok(journal)
    }

    /// The thing whose answer was taken back right before the run ended, so that the database may not know of it.
    pub fn withdrawn(&self) -> &[ObjectId] {
        &self.withdrawn
    }

    /// What an earlier part of the run concluded of a thing in the pass that is under way.
    pub fn past_inference(&mut self, object: &ObjectId) -> Option<Inference> {
        self.past.front_mut()?.inferred.remove(object)
    }

    /// How an earlier part of the run fared with its next question, if that was about this thing and these others. The pass is
    /// over then.
    pub fn past_question(&mut self, object: &ObjectId, also: &[ObjectId]) -> Option<PastQuestion> {
        let question = self.past.pop_front()?.question?;
        let (PastQuestion::Answered { question: report, .. } | PastQuestion::Declined { question: report }) =
            &question;
        if report.object_id == *object && report.also == also {
            return Some(question);
        }
        // Something has changed since, such as an answer that came another way; the rest fits no more.
        self.past.clear();
        None
    }

    /// The things that were answered or declined in earlier parts of the run and are still to come.
    pub fn past_questions(&self) -> impl Iterator<Item = &QuestionReport> {
        self.past.iter().filter_map(|pass| match &pass.question {
            Some(PastQuestion::Answered { question, .. } | PastQuestion::Declined { question }) => {
                Some(question)
            }
            None => None,
        })
    }

    /// Notes that a thing was inferred.
    pub fn inferred(
        &mut self,
        object: &ObjectId,
        inference: &Inference,
        roster: &Roster,
    ) -> Result<(), JournalError> {
        if self.file.is_none() {
            return Ok(());
        }
        self.write(&JournalEntry::Inferred {
            object_id: object.clone(),
            scores: roster.scores(&inference.scores),
            owner_sets: inference.distribution.to_named(roster),
            related: inference.related.clone(),
            parts: inference.parts.as_ref().map(|parts| named_parts(parts, roster)),
            problem: inference.problem.clone(),
        })
    }

    /// Notes an answer. It is on the disk when this returns.
    pub fn answered(
        &mut self,
        question: &QuestionReport,
        owner_outside_household: bool,
    ) -> Result<(), JournalError> {
        self.write(&JournalEntry::Answered { question: question.clone(), owner_outside_household })?;
        self.force()
    }

    /// Notes that somebody would not answer.
    pub fn declined(&mut self, question: &QuestionReport) -> Result<(), JournalError> {
        self.write(&JournalEntry::Declined { question: question.clone() })?;
        self.force()
    }

    /// Notes that the last question's answer was taken back.
    pub fn undone(&mut self) -> Result<(), JournalError> {
        self.write(&JournalEntry::Undone)?;
        self.force()
    }

    fn write(&mut self, entry: &JournalEntry) -> Result<(), JournalError> {
        let Some((path, file)) = &mut self.file else { return Ok(()) };
        let line = serde_json::to_string(entry).map_err(std::io::Error::from);
        line.and_then(|line| file.write_all(format!("{line}\n").as_bytes()))
            .map_err(|source| JournalError::File { path: path.clone(), source })
    }

    fn force(&mut self) -> Result<(), JournalError> {
        let Some((path, file)) = &mut self.file else { return Ok(()) };
        file.sync_data().map_err(|source| JournalError::File { path: path.clone(), source })
    }
}

/// The parts of fused scores by name.
pub(crate) fn named_parts(parts: &Parts, roster: &Roster) -> ScoreParts {
    ScoreParts {
        model: parts.model.as_ref().map(|scores| roster.scores(scores)),
        evidence: roster.scores(&parts.evidence),
    }
}

fn read_entries(path: &Path, text: &str) -> Result<Vec<JournalEntry>, JournalError> {
    text.lines()
        .enumerate()
        .map(|(place, line)| {
            serde_json::from_str(line).map_err(|source| JournalError::Form {
                path: path.to_owned(),
                line: place + 1,
                source,
            })
        })
        .collect()
}

/// The passes of a run. What was taken back is left out, together with what was concluded after it.
fn read_past(
    entries: &[JournalEntry],
    roster: &Roster,
) -> Result<(VecDeque<Pass>, Vec<ObjectId>), JournalError> {
    let mut withdrawn = Vec::new();
    let mut passes = VecDeque::from([Pass::default()]);
    for entry in entries {
        let Some(pass) = passes.back_mut() else { break };
        withdrawn = Vec::new();
        match entry {
            JournalEntry::Run(_) => {}
            JournalEntry::Inferred { object_id, scores, owner_sets, related, parts, problem } => {
                let parts = parts.as_ref().map(|parts| -> Result<Parts, RosterError> {
                    Ok(Parts {
                        model: parts.model.as_ref().map(|scores| roster.score_vector(scores)).transpose()?,
                        evidence: roster.score_vector(&parts.evidence)?,
                    })
                });
                let inference = Inference {
                    scores: roster.score_vector(scores)?,
                    distribution: OwnerSetDistribution::restored(roster, owner_sets)?,
                    related: related.clone(),
                    parts: parts.transpose()?,
                    problem: problem.clone(),
                };
                pass.inferred.insert(object_id.clone(), inference);
            }
            JournalEntry::Answered { question, owner_outside_household } => {
                pass.question = Some(PastQuestion::Answered {
                    question: question.clone(),
                    recorded: Recorded::Surely,
                    owner_outside_household: *owner_outside_household,
                });
                passes.push_back(Pass::default());
            }
            JournalEntry::Declined { question } => {
                pass.question = Some(PastQuestion::Declined { question: question.clone() });
                passes.push_back(Pass::default());
            }
            JournalEntry::Undone => {
                passes.pop_back();
                let question = passes.back_mut().and_then(|pass| pass.question.take());
                if let Some(PastQuestion::Answered { question, .. }) = question {
                    withdrawn = question
                        .objects()
                        .filter(|object| !stands_again(&mut passes, object))
                        .cloned()
                        .collect();
                }
            }
        }
    }
    if let Some(JournalEntry::Answered { .. }) = entries.last() {
        let last = passes.iter_mut().rev().find_map(|pass| pass.question.as_mut());
        if let Some(PastQuestion::Answered { recorded, .. }) = last {
            *recorded = Recorded::Perhaps;
        }
    }
    Ok((passes, withdrawn))
}

/// Whether an earlier answer about a thing stands again, now that what was to confirm it was taken back. The database may not
/// know it any more.
fn stands_again(passes: &mut VecDeque<Pass>, object: &ObjectId) -> bool {
    let earlier = passes.iter_mut().rev().find_map(|pass| match &mut pass.question {
        Some(PastQuestion::Answered { question, recorded, .. })
            if question.status == AnswerStatus::Answered && question.is_about(object) =>
        {
            Some(recorded)
        }
        _ => None,
    });
    earlier.map(|recorded| *recorded = Recorded::Perhaps).is_some()
}

/// What keeps a run from going on with other settings; `None` where nothing does.
fn difference(of_run: &JournalHeading, now: &JournalHeading) -> Option<String> {
    if of_run.version != JOURNAL_VERSION {
        return Some(format!("it was written by another version of the program ({})", of_run.version));
    }
    let JournalHeading { users, objects, withheld, scoring, .. } = now;
    let differs =
        |what: &str, before: String, now: String| Some(format!("its {what} was {before}, not {now}"));
    if of_run.episode != now.episode || of_run.users != *users || of_run.objects != *objects {
        return differs("home", format!("{:?}", of_run.episode), format!("this {:?}", now.episode));
    }
    if of_run.now != now.now {
        return differs("present", of_run.now.to_string(), now.now.to_string());
    }
    if of_run.model != now.model {
        return differs("model", of_run.model.clone(), now.model.clone());
    }
    if of_run.scoring != *scoring || of_run.withheld != *withheld || of_run.reinference != now.reinference {
        return Some("its scores were made in another way (--estimator, --context, --batch, --without or --reinference)".to_owned());
    }
    if of_run.gate != now.gate || of_run.lambda != now.lambda || of_run.risk != now.risk {
        return Some("it had another gate or calibration".to_owned());
    }
    if of_run.answers != now.answers || of_run.seed != now.seed {
        return Some("somebody else answered (--answers or --seed)".to_owned());
    }
    None
}

#[cfg(test)]
mod tests;
