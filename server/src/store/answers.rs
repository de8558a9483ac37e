//! What people said of owners, and the questions that they would not answer.

use std::collections::BTreeMap;

use coin::captions::civil_seconds;
use coin_schemas::household::{Owners, OwnershipBoolean, UserName};
use coin_schemas::report::AnswerStatus;
use jiff::civil::DateTime;
use rusqlite::Row;

use super::beliefs::{owners_of, text};
use super::household::{Household, UserKey, datetime};
use super::map::ObjectKey;
use super::{Reader, StoreError, Writer};

/// An answer as it was given and read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedAnswer {
    /// The question as the person heard it.
    pub question: String,
    /// The person's words.
    pub answer: String,
    /// How they were read, for every member.
    pub ownership: OwnershipBoolean,
    /// Somebody outside the household owns the thing.
    pub owner_outside_household: bool,
    /// Who answered, where known.
    pub answered_by: Option<UserName>,
    /// When.
    pub at: DateTime,
    /// What became of it.
    pub status: AnswerStatus,
    /// When it was taken back, where it was.
    pub retracted_at: Option<DateTime>,
    /// When somebody joined the home of whom it could not speak, where that was so.
    pub reopened_at: Option<DateTime>,
}

/// What came of taking an answer back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Retraction {
    /// The answer that was believed is not believed any more.
    Retracted,
    /// No answer was believed, and nothing has changed.
    NothingToRetract,
}

impl RecordedAnswer {
    /// Who the answer makes an owner.
    pub fn owners(&self) -> Owners {
        owners_of(&self.ownership)
    }
}

/// How a person dealt with a question instead of answering it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// The person would not say. The question is not put again.
    Declined,
    /// The person put it away without a word. It may be put again.
    Cancelled,
}

/// The questions about a thing that have settled nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct OpenQuestions {
    /// How often somebody was asked: who did not know, or put the question away.
    pub asked: u32,
    /// Whether somebody would not say.
    pub declined: bool,
}

const SELECT_ANSWER: &str = "SELECT question, answer, ownership, outside, answered_by, at, status, retracted_at, reopened_at FROM answers";

fn answer_from_row(household: &Household, row: &Row<'_>) -> Result<RecordedAnswer, StoreError> {
    let answered_by: Option<i64> = row.get(4)?;
    let retracted_at: Option<i64> = row.get(7)?;
    let reopened_at: Option<i64> = row.get(8)?;
    Ok(RecordedAnswer {
        question: row.get(0)?,
        answer: row.get(1)?,
        ownership: serde_json::from_str(text(row, 2)?)?,
        owner_outside_household: row.get(3)?,
        answered_by: answered_by
            .and_then(|key| household.user(UserKey(key)))
            .map(|user| household.roster().name(user).clone()),
        at: datetime(row.get(5)?)?,
        status: match text(row, 6)? {
            "answered" => AnswerStatus::Answered,
            _ => AnswerStatus::Unresolved,
        },
        retracted_at: retracted_at.map(datetime).transpose()?,
        reopened_at: reopened_at.map(datetime).transpose()?,
    })
}

impl Reader<'_> {
    /// All answers about a thing, in the order in which they were recorded.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn answers(
        &self,
        household: &Household,
        object: ObjectKey,
    ) -> Result<Vec<RecordedAnswer>, StoreError> {
        let mut statement = self
            .connection
            .prepare_cached(&format!("{SELECT_ANSWER} WHERE object_key = ?1 ORDER BY sequence"))?;
        let mut rows = statement.query([object.0])?;
        let mut answers = Vec::new();
        while let Some(row) = rows.next()? {
            answers.push(answer_from_row(household, row)?);
        }
        Ok(answers)
    }

    /// The answer that is believed of a thing; `None` where none is.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn present_answer(
        &self,
        household: &Household,
        object: ObjectKey,
    ) -> Result<Option<RecordedAnswer>, StoreError> {
        let mut statement = self.connection.prepare_cached(&format!(
            "{SELECT_ANSWER} JOIN present_answers USING (object_key, sequence) WHERE object_key = ?1"
        ))?;
        let mut rows = statement.query([object.0])?;
        rows.next()?.map(|row| answer_from_row(household, row)).transpose()
    }

    /// The things about which somebody was asked in vain, and how.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn open_questions(&self) -> Result<BTreeMap<ObjectKey, OpenQuestions>, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT object_key, count(*), 0 FROM answers
             WHERE status = 'unresolved' AND retracted_at IS NULL GROUP BY object_key
             UNION ALL
             SELECT object_key, count(*), max(outcome = 'declined') FROM refusals GROUP BY object_key",
        )?;
        let mut rows = statement.query([])?;
        let mut questions: BTreeMap<ObjectKey, OpenQuestions> = BTreeMap::new();
        while let Some(row) = rows.next()? {
            let of_thing = questions.entry(ObjectKey(row.get(0)?)).or_default();
            of_thing.asked += row.get::<_, u32>(1)?;
            of_thing.declined |= row.get::<_, bool>(2)?;
        }
        Ok(questions)
    }
}

impl Writer<'_> {
    /// Appends an answer to the history of a thing. One that settles whose the thing is replaces the belief.
    ///
    /// # Errors
    /// Failures of the database, and a person who is not of the household.
    pub fn add_answer(
        &self,
        household: &Household,
        object: ObjectKey,
        answer: &RecordedAnswer,
    ) -> Result<(), StoreError> {
        let answered_by = answer
            .answered_by
            .as_ref()
            .map(|name| household.roster().index_of(name.as_str()).map(|user| household.key(user).0))
            .transpose()?;
        let sequence: i64 = self
            .connection
            .prepare_cached("SELECT coalesce(max(sequence), 0) + 1 FROM answers WHERE object_key = ?1")?
            .query_row([object.0], |row| row.get(0))?;
        self.connection
            .prepare_cached(
                "INSERT INTO answers
                     (object_key, sequence, question, answer, ownership, outside, answered_by, at, status,
                      retracted_at, reopened_at)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)",
            )?
            .execute((
                object.0,
                sequence,
                &answer.question,
                &answer.answer,
                serde_json::to_string(&answer.ownership)?,
                answer.owner_outside_household,
                answered_by,
                civil_seconds(answer.at),
                match answer.status {
                    AnswerStatus::Answered => "answered",
                    AnswerStatus::Unresolved => "unresolved",
                },
                answer.retracted_at.map(civil_seconds),
                answer.reopened_at.map(civil_seconds),
            ))?;
        if answer.status == AnswerStatus::Answered {
            self.connection
                .prepare_cached(
                    "INSERT INTO present_answers (object_key, sequence) VALUES (?1, ?2)
                     ON CONFLICT (object_key) DO UPDATE SET sequence = excluded.sequence",
                )?
                .execute((object.0, sequence))?;
        }
        Ok(())
    }

    /// Takes back the answer that is believed of a thing at present: from `at` on it counts no more than if it had
    /// not been given, and no older answer takes its place. The history keeps it.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn retract_answer(&self, object: ObjectKey, at: DateTime) -> Result<Retraction, StoreError> {
        let retracted = self
            .connection
            .prepare_cached(
                "UPDATE answers SET retracted_at = ?2 WHERE (object_key, sequence) IN
                     (SELECT object_key, sequence FROM present_answers WHERE object_key = ?1)",
            )?
            .execute((object.0, civil_seconds(at)))?;
        if retracted == 0 {
            return Ok(Retraction::NothingToRetract);
        }
        self.connection
            .prepare_cached("DELETE FROM present_answers WHERE object_key = ?1")?
            .execute([object.0])?;
        Ok(Retraction::Retracted)
    }

    /// Notes that a person heard a question about a thing and did not answer it.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn add_refusal(
        &self,
        object: ObjectKey,
        question: &str,
        refusal: Refusal,
        at: DateTime,
    ) -> Result<(), StoreError> {
        let outcome = match refusal {
            Refusal::Declined => "declined",
            Refusal::Cancelled => "cancelled",
        };
        self.connection
            .prepare_cached(
                "INSERT INTO refusals (object_key, sequence, question, outcome, at)
                 VALUES (?1, (SELECT coalesce(max(sequence), 0) + 1 FROM refusals WHERE object_key = ?1), ?2, ?3, ?4)",
            )?
            .execute((object.0, question, outcome, civil_seconds(at)))?;
        Ok(())
    }
}
