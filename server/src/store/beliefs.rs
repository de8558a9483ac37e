//! What is believed of owners: what models concluded, and what people said.

use std::collections::BTreeMap;

use coin::captions::civil_seconds;
use coin_schemas::household::{Owners, OwnershipBoolean, Scores, Source, UserName};
use coin_schemas::model::OwnerSetProbability;
use coin_schemas::report::AnswerStatus;
use jiff::civil::DateTime;
use rusqlite::Row;

use super::household::{Household, UserKey, datetime};
use super::map::ObjectKey;
use super::{Reader, StoreError, Writer};

/// What a model concluded about a thing.
#[derive(Debug, Clone, PartialEq)]
pub struct Inference {
    /// The model, where it named itself.
    pub model: Option<String>,
    /// Its score of every member.
    pub scores: Scores,
    /// Its probabilities of owner sets, where it gave any.
    pub owner_sets: Option<Vec<OwnerSetProbability>>,
    /// The most probable owner set.
    pub owners: Owners,
    /// The probability of that set.
    pub confidence: f64,
    /// Whether no question is needed.
    pub settled: bool,
}

/// What is believed of a thing at present.
#[derive(Debug, Clone, PartialEq)]
pub enum Belief {
    /// A person said who owns it.
    Answered {
        /// The owners; nobody where somebody outside the household owns it.
        owners: Owners,
    },
    /// Nobody was asked yet; a model concluded it.
    Inferred(Inference),
}

impl Belief {
    /// Who is held to own the thing.
    pub fn owners(&self) -> &Owners {
        match self {
            Self::Answered { owners } => owners,
            Self::Inferred(inference) => &inference.owners,
        }
    }

    /// The probability of that owner set; 1 where a person said so.
    pub fn confidence(&self) -> f64 {
        match self {
            Self::Answered { .. } => 1.0,
            Self::Inferred(inference) => inference.confidence,
        }
    }

    /// Whether no question is needed.
    pub fn is_settled(&self) -> bool {
        match self {
            Self::Answered { .. } => true,
            Self::Inferred(inference) => inference.settled,
        }
    }

    /// Where the belief comes from.
    pub fn source(&self) -> Source {
        match self {
            Self::Answered { .. } => Source::Answer,
            Self::Inferred(_) => Source::Inferred,
        }
    }
}

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

fn owners_of(ownership: &OwnershipBoolean) -> Owners {
    ownership.iter().filter(|&(_, &owns)| owns).map(|(name, _)| name.clone()).collect()
}

const SELECT_INFERENCE: &str =
    "SELECT object_key, model, scores, owner_sets, owners, confidence, settled FROM inferences";

const SELECT_PRESENT_ANSWER: &str =
    "SELECT object_key, ownership FROM present_answers JOIN answers USING (object_key, sequence)";

type ReadBelief = fn(&Row<'_>) -> Result<(ObjectKey, Belief), StoreError>;

fn inference_from_row(row: &Row<'_>) -> Result<(ObjectKey, Belief), StoreError> {
    let owner_sets: Option<String> = row.get(3)?;
    let inference = Inference {
        model: row.get(1)?,
        scores: serde_json::from_str(text(row, 2)?)?,
        owner_sets: owner_sets.as_deref().map(serde_json::from_str).transpose()?,
        owners: serde_json::from_str(text(row, 4)?)?,
        confidence: row.get(5)?,
        settled: row.get(6)?,
    };
    Ok((ObjectKey(row.get(0)?), Belief::Inferred(inference)))
}

fn answer_from_row(row: &Row<'_>) -> Result<(ObjectKey, Belief), StoreError> {
    let ownership: OwnershipBoolean = serde_json::from_str(text(row, 1)?)?;
    Ok((ObjectKey(row.get(0)?), Belief::Answered { owners: owners_of(&ownership) }))
}

fn text<'row>(row: &'row Row<'_>, column: usize) -> Result<&'row str, StoreError> {
    row.get_ref(column)?.as_str().map_err(|source| StoreError::damaged(source.to_string()))
}

impl Reader<'_> {
    /// What is believed of a thing; `None` where nothing is.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn belief(&self, object: ObjectKey) -> Result<Option<Belief>, StoreError> {
        let readers: [(&str, ReadBelief); 2] =
            [(SELECT_PRESENT_ANSWER, answer_from_row), (SELECT_INFERENCE, inference_from_row)];
        for (select, from_row) in readers {
            let mut statement =
                self.transaction.prepare_cached(&format!("{select} WHERE object_key = ?1"))?;
            let mut rows = statement.query([object.0])?;
            if let Some(row) = rows.next()? {
                return Ok(Some(from_row(row)?.1));
            }
        }
        Ok(None)
    }

    /// What is believed of all things of which something is.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn beliefs(&self) -> Result<BTreeMap<ObjectKey, Belief>, StoreError> {
        let mut beliefs = BTreeMap::new();
        // Answers come last, because they outweigh inferences.
        let readers: [(&str, ReadBelief); 2] =
            [(SELECT_INFERENCE, inference_from_row), (SELECT_PRESENT_ANSWER, answer_from_row)];
        for (select, from_row) in readers {
            let mut statement = self.transaction.prepare_cached(select)?;
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                let (object, belief) = from_row(row)?;
                beliefs.insert(object, belief);
            }
        }
        Ok(beliefs)
    }

    /// What a model last concluded about a thing, whether or not a person has answered since.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn inference(&self, object: ObjectKey) -> Result<Option<Inference>, StoreError> {
        let mut statement =
            self.transaction.prepare_cached(&format!("{SELECT_INFERENCE} WHERE object_key = ?1"))?;
        let mut rows = statement.query([object.0])?;
        match rows.next()?.map(inference_from_row).transpose()? {
            Some((_, Belief::Inferred(inference))) => Ok(Some(inference)),
            _ => Ok(None),
        }
    }

    /// All answers about a thing, in the order in which they were recorded.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn answers(
        &self,
        household: &Household,
        object: ObjectKey,
    ) -> Result<Vec<RecordedAnswer>, StoreError> {
        let mut statement = self.transaction.prepare_cached(
            "SELECT question, answer, ownership, outside, answered_by, at, status, retracted_at FROM answers
             WHERE object_key = ?1 ORDER BY sequence",
        )?;
        let mut rows = statement.query([object.0])?;
        let mut answers = Vec::new();
        while let Some(row) = rows.next()? {
            let answered_by: Option<i64> = row.get(4)?;
            let retracted_at: Option<i64> = row.get(7)?;
            answers.push(RecordedAnswer {
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
            });
        }
        Ok(answers)
    }
}

impl Writer<'_> {
    /// Stores what a model concluded. Where a person has answered, the answer is still what is believed.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn put_inference(&self, object: ObjectKey, inference: &Inference) -> Result<(), StoreError> {
        let owner_sets = inference.owner_sets.as_ref().map(serde_json::to_string).transpose()?;
        self.transaction
            .prepare_cached(
                "INSERT INTO inferences (object_key, model, scores, owner_sets, owners, confidence, settled)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)
                 ON CONFLICT (object_key) DO UPDATE SET model = excluded.model, scores = excluded.scores,
                     owner_sets = excluded.owner_sets, owners = excluded.owners,
                     confidence = excluded.confidence, settled = excluded.settled",
            )?
            .execute((
                object.0,
                &inference.model,
                serde_json::to_string(&inference.scores)?,
                owner_sets,
                serde_json::to_string(&inference.owners)?,
                inference.confidence,
                inference.settled,
            ))?;
        Ok(())
    }

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
            .transaction
            .prepare_cached("SELECT coalesce(max(sequence), 0) + 1 FROM answers WHERE object_key = ?1")?
            .query_row([object.0], |row| row.get(0))?;
        self.transaction
            .prepare_cached(
                "INSERT INTO answers
                     (object_key, sequence, question, answer, ownership, outside, answered_by, at, status,
                      retracted_at)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)",
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
            ))?;
        if answer.status == AnswerStatus::Answered {
            self.transaction
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
            .transaction
            .prepare_cached(
                "UPDATE answers SET retracted_at = ?2 WHERE (object_key, sequence) IN
                     (SELECT object_key, sequence FROM present_answers WHERE object_key = ?1)",
            )?
            .execute((object.0, civil_seconds(at)))?;
        if retracted == 0 {
            return Ok(Retraction::NothingToRetract);
        }
        self.transaction
            .prepare_cached("DELETE FROM present_answers WHERE object_key = ?1")?
            .execute([object.0])?;
        Ok(Retraction::Retracted)
    }
}
