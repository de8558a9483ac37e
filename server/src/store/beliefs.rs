//! What is believed of owners: what models concluded, and what people said.

use std::collections::BTreeMap;

use coin_schemas::household::{Owners, OwnershipBoolean, Scores, Source};
use coin_schemas::model::OwnerSetProbability;
use rusqlite::Row;

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
        /// The owners within the household.
        owners: Owners,
        /// Whether somebody outside the household owns it, alone or with them.
        outside_household: bool,
    },
    /// Nobody was asked yet; a model concluded it.
    Inferred(Inference),
}

impl Belief {
    /// Who is held to own the thing.
    pub fn owners(&self) -> &Owners {
        match self {
            Self::Answered { owners, .. } => owners,
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

pub(super) fn owners_of(ownership: &OwnershipBoolean) -> Owners {
    ownership.iter().filter(|&(_, &owns)| owns).map(|(name, _)| name.clone()).collect()
}

const SELECT_INFERENCE: &str =
    "SELECT object_key, model, scores, owner_sets, owners, confidence, settled FROM inferences";

const SELECT_PRESENT_ANSWER: &str =
    "SELECT object_key, ownership, outside FROM present_answers JOIN answers USING (object_key, sequence)";

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
    let belief = Belief::Answered { owners: owners_of(&ownership), outside_household: row.get(2)? };
    Ok((ObjectKey(row.get(0)?), belief))
}

pub(super) fn text<'row>(row: &'row Row<'_>, column: usize) -> Result<&'row str, StoreError> {
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
            let mut statement = self.connection.prepare_cached(&format!("{select} WHERE object_key = ?1"))?;
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
            let mut statement = self.connection.prepare_cached(select)?;
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
            self.connection.prepare_cached(&format!("{SELECT_INFERENCE} WHERE object_key = ?1"))?;
        let mut rows = statement.query([object.0])?;
        match rows.next()?.map(inference_from_row).transpose()? {
            Some((_, Belief::Inferred(inference))) => Ok(Some(inference)),
            _ => Ok(None),
        }
    }
}

impl Writer<'_> {
    /// Stores what a model concluded. Where a person has answered, the answer is still what is believed.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn put_inference(&self, object: ObjectKey, inference: &Inference) -> Result<(), StoreError> {
        let owner_sets = inference.owner_sets.as_ref().map(serde_json::to_string).transpose()?;
        self.connection
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
}
