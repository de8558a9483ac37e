//! Whose a thing is, with what is known of it, and without any language model.

use coin::calibration::{Assessment, EMBEDDED_MODEL, Thresholds};
use coin::captions::civil_seconds;
use coin::dialogue::{
    Conclusion, Explained, Grounds, Reading, RelativeGrounds, SeenRelation, Standing, UserGrounds, explain,
};
use coin::evidence::{EvidenceParameters, OUTDATED, Relation, against_answer, likeness_counts, since_answer};
use coin::owners::{OwnerSet, OwnerSetDistribution};
use coin::roster::Roster;
use coin::sharing::ShareThresholds;
use coin::space::Neighbourhood;
use coin::usage::session_order;
use coin_schemas::household::{ObjectId, Owners, Score, Source};
use coin_schemas::model::GivenContext;
use coin_schemas::report::AnswerStatus;
use coin_schemas::tools::{
    AnswerEvidence, DEFAULT_K, Evidence, KnownOwnership, LookAlikeEvidence, NeighbourEvidence, UsageEvidence,
    display_name,
};
use jiff::civil::DateTime;

use super::known_ownership::answered_ownership;
use super::usage::Listed;
use super::{LookAlikes, Scene, Window};
use crate::store::{Inference, ObjectKey, RecordedAnswer, StoreError, StoredObject};

/// A relative is worth a mention in an explanation from this probability on that the thing has its owners because of
/// the relation.
const MENTIONED: f64 = 0.01;

/// What is held of one thing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Judgement {
    /// Who owns it within the household, and whether somebody outside does.
    pub(crate) reading: Reading,
    /// The probability of that; 1 where a person said so.
    pub(crate) confidence: f64,
    /// For every member the probability of being an owner.
    pub(crate) scores: Vec<Score>,
    /// The probabilities of owner sets, as far as nobody has answered.
    pub(crate) distribution: OwnerSetDistribution,
    /// What the gate makes of the scores.
    pub(crate) assessment: Assessment,
    /// Where it comes from.
    pub(crate) basis: Basis,
    /// What was seen of the thing.
    pub(crate) context: GivenContext,
}

/// Where a judgement comes from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Basis {
    /// A person said so.
    Answer(Box<RecordedAnswer>),
    /// A person said otherwise, but who used the thing since fits that no longer.
    Outdated(Box<RecordedAnswer>),
    /// A model whose scores were recorded.
    Model {
        /// Its name, where it told one.
        name: Option<String>,
    },
    /// The evidence model.
    Evidence,
}

/// The thresholds of a model by name. Those of the evidence model are read once.
pub(crate) fn thresholds_of(model: Option<&str>) -> Thresholds {
    static EMBEDDED: std::sync::LazyLock<Thresholds> =
        std::sync::LazyLock::new(|| Thresholds::for_model(Some(EMBEDDED_MODEL)));
    match model {
        Some(EMBEDDED_MODEL) => *EMBEDDED,
        other => Thresholds::for_model(other),
    }
}

/// Somebody who is not among the most probable owners is worth a mention from this score on.
const POSSIBLE: f64 = 0.2;

/// When a judgement is made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Moment {
    /// The home's present.
    Present,
    /// Earlier: what was seen or said later is hidden.
    Past(DateTime),
}

impl Scene<'_> {
    /// Judges a thing. What a person said counts most, then the scores that a model handed in, then the evidence. The
    /// evidence model's own recorded scores do not count: it judges anew, by what was seen since.
    ///
    /// # Errors
    /// Failures of the database.
    pub(crate) fn judge(&self, object: &StoredObject, moment: Moment) -> Result<Judgement, StoreError> {
        let as_of = match moment {
            Moment::Present => self.present()?,
            Moment::Past(as_of) => as_of,
        };
        let context = self.context(object, moment, as_of)?;
        let inference = match moment {
            Moment::Present => self.reader.inference(object.key)?,
            // It is not known when a model's scores were made.
            Moment::Past(_) => None,
        };
        let foreign = inference.filter(|inference| inference.model.as_deref() != Some(EMBEDDED_MODEL));
        // Somebody who has joined since may have opened again what the model settled.
        let is_open = foreign.as_ref().is_some_and(|inference| !inference.settled);
        let (scores, distribution, thresholds, basis) = match foreign {
            Some(inference) => {
                let (scores, distribution) = self.recorded(&inference)?;
                let thresholds = thresholds_of(inference.model.as_deref());
                (scores, distribution, thresholds, Basis::Model { name: inference.model })
            }
            None => {
                let distribution = self.weigh(object, moment, as_of)?;
                let scores = distribution.marginals(self.household.roster().len());
                (scores, distribution, thresholds_of(Some(EMBEDDED_MODEL)), Basis::Evidence)
            }
        };
        let mut assessment = thresholds.assess(&scores, &distribution, &ShareThresholds::default());
        assessment.settled &= !is_open;
        match self.answer(object.key, moment)? {
            Some(answer) => match self.outdated(object, &answer, as_of)? {
                None => self.answered(answer, distribution, assessment, context),
                Some(distribution) => Ok(self.reopened(answer, distribution, context)),
            },
            None => Ok(Judgement {
                reading: Reading { owners: assessment.owners, outside_household: false },
                confidence: assessment.confidence,
                scores,
                distribution,
                assessment,
                basis,
                context,
            }),
        }
    }

    /// Judges every thing, by id.
    ///
    /// # Errors
    /// Failures of the database; for each thing also that nobody waits for the call any more.
    pub(crate) fn judgements(
        &self,
    ) -> Result<impl Iterator<Item = Result<(&StoredObject, Judgement), StoreError>>, StoreError> {
        self.beliefs()?;
        self.weigh_all()?;
        Ok(self.objects()?.iter().map(|object| {
            self.reader.go_on()?;
            Ok((object, self.judge(object, Moment::Present)?))
        }))
    }

    /// What a person said of a thing, as it was believed at a moment. What was taken back later was never right.
    pub(super) fn answer(
        &self,
        object: ObjectKey,
        moment: Moment,
    ) -> Result<Option<RecordedAnswer>, StoreError> {
        let as_of = match moment {
            Moment::Present => return self.reader.present_answer(&self.household, object),
            Moment::Past(as_of) => as_of,
        };
        let was_believed = |answer: &RecordedAnswer| {
            answer.status == AnswerStatus::Answered
                && answer.at <= as_of
                && answer.retracted_at.is_none()
                && answer.reopened_at.is_none_or(|reopened| reopened > as_of)
        };
        Ok(self.reader.answers(&self.household, object)?.into_iter().rfind(was_believed))
    }

    /// Whose a thing is after all, where its use since an answer speaks clearly for other owners than the person named.
    pub(super) fn outdated(
        &self,
        object: &StoredObject,
        answer: &RecordedAnswer,
        as_of: DateTime,
    ) -> Result<Option<OwnerSetDistribution>, StoreError> {
        let roster = self.household.roster();
        let answered = roster.owner_set(&answer.owners())?;
        let (since, until) = (civil_seconds(answer.at), civil_seconds(as_of));
        let log = self.reader.usage(&self.household, object.key, since.saturating_add(1), until)?;
        let sessions = session_order(&log.events);
        let posterior = since_answer(&sessions, roster.len(), answered, &EvidenceParameters::default());
        Ok(posterior.filter(|posterior| posterior.probability(answered) <= 1.0 - OUTDATED))
    }

    /// Whether a person's answer about a thing is outdated at present.
    ///
    /// # Errors
    /// Failures of the database.
    pub(crate) fn is_reopened(&self, object: &StoredObject) -> Result<bool, StoreError> {
        let Some(answer) = self.reader.present_answer(&self.household, object.key)? else { return Ok(false) };
        Ok(self.outdated(object, &answer, self.present()?)?.is_some())
    }

    /// What is held of a thing whose answer is outdated. However probable that is, only a person can settle it.
    fn reopened(
        &self,
        answer: RecordedAnswer,
        distribution: OwnerSetDistribution,
        context: GivenContext,
    ) -> Judgement {
        let scores = distribution.marginals(self.household.roster().len());
        let thresholds = thresholds_of(Some(EMBEDDED_MODEL));
        let mut assessment = thresholds.assess(&scores, &distribution, &ShareThresholds::default());
        assessment.settled = false;
        Judgement {
            reading: Reading { owners: assessment.owners, outside_household: false },
            confidence: assessment.confidence,
            scores,
            distribution,
            assessment,
            basis: Basis::Outdated(Box::new(answer)),
            context,
        }
    }

    fn answered(
        &self,
        answer: RecordedAnswer,
        distribution: OwnerSetDistribution,
        mut assessment: Assessment,
        context: GivenContext,
    ) -> Result<Judgement, StoreError> {
        let roster = self.household.roster();
        let owners = roster.owner_set(&answer.owners())?;
        (assessment.prediction_set, assessment.uncertainty, assessment.settled) = (owners, 0.0, true);
        let indicator = |user| if owners.contains(user) { Score::ONE } else { Score::ZERO };
        Ok(Judgement {
            reading: Reading { owners, outside_household: answer.owner_outside_household },
            confidence: 1.0,
            scores: roster.indices().map(indicator).collect(),
            distribution,
            assessment,
            basis: Basis::Answer(Box::new(answer)),
            context,
        })
    }

    fn context(
        &self,
        object: &StoredObject,
        moment: Moment,
        as_of: DateTime,
    ) -> Result<GivenContext, StoreError> {
        let similar_objects = match self.look_alikes(object, DEFAULT_K as usize)? {
            LookAlikes::Found(found) => found,
            LookAlikes::NeverSeen | LookAlikes::NothingToCompare => Vec::new(),
        };
        let mut context = GivenContext {
            usage: Some(self.usage(object, Window::usual(as_of), Listed::default())?),
            nearby_objects: self.nearby(object, &Neighbourhood::default())?,
            similar_objects,
        };
        if moment != Moment::Present {
            for near in &mut context.nearby_objects {
                self.known_then(&near.id, as_of, &mut near.known_ownership)?;
            }
            for alike in &mut context.similar_objects {
                self.known_then(&alike.id, as_of, &mut alike.known_ownership)?;
            }
        }
        Ok(context)
    }

    /// What was known of another thing's owners then. Of what a model concluded it is not known since when.
    fn known_then(
        &self,
        id: &ObjectId,
        as_of: DateTime,
        known: &mut Option<KnownOwnership>,
    ) -> Result<(), StoreError> {
        let answer = match self.reader.object_key(id.as_str())? {
            Some(key) => self.answer(key, Moment::Past(as_of))?,
            None => None,
        };
        *known = answer.map(|answer| answered_ownership(self.household.roster(), &answer.owners()));
        Ok(())
    }

    /// Scores as a model handed them in. Who has joined since owns nothing as far as it knew.
    fn recorded(&self, inference: &Inference) -> Result<(Vec<Score>, OwnerSetDistribution), StoreError> {
        let roster = self.household.roster();
        let scores: Vec<Score> =
            roster.names().map(|name| inference.scores.get(name).copied().unwrap_or(Score::ZERO)).collect();
        let distribution = match &inference.owner_sets {
            Some(sets) => OwnerSetDistribution::restored(roster, sets)
                .map_err(|source| StoreError::damaged(source.to_string()))?,
            None => OwnerSetDistribution::from_scores(&scores),
        };
        Ok((scores, distribution))
    }

    /// What a judgement rests on, as tools tell it.
    pub(crate) fn evidence(&self, object: &StoredObject, judgement: &Judgement) -> Evidence {
        let context = &judgement.context;
        let answer = match &judgement.basis {
            Basis::Answer(answer) | Basis::Outdated(answer) => Some(AnswerEvidence {
                question: answer.question.clone(),
                answer: answer.answer.clone(),
                answered_by: answer.answered_by.clone(),
                at: answer.at,
            }),
            Basis::Model { .. } | Basis::Evidence => None,
        };
        let usage = context.usage.iter().flat_map(|usage| &usage.user_summary);
        let mut usage: Vec<UsageEvidence> = usage
            .map(|user| UsageEvidence {
                user_id: user.user_id.clone(),
                sessions: user.sessions,
                last_used_days_ago: user.last_used_days_ago,
            })
            .collect();
        // The sort is stable: of equal sessions, who has more events comes first.
        usage.sort_by_key(|user| std::cmp::Reverse(user.sessions));
        let neighbours = context.nearby_objects.iter().filter_map(|other| {
            let owners = named_owners(other.known_ownership.as_ref())?.clone();
            Some(NeighbourEvidence {
                id: other.id.clone(),
                name: other.name.clone(),
                distance: other.distance,
                owners,
            })
        });
        let class = display_name(&object.class);
        let alike = context.similar_objects.iter().filter(|other| likeness_counts(&class, &other.name));
        let look_alikes = alike.filter_map(|other| {
            let owners = named_owners(other.known_ownership.as_ref())?.clone();
            Some(LookAlikeEvidence {
                id: other.id.clone(),
                name: other.name.clone(),
                similarity: other.similarity,
                owners,
            })
        });
        Evidence { usage, neighbours: neighbours.collect(), look_alikes: look_alikes.collect(), answer }
    }

    /// Two sentences for a person: whose the thing is held to be, and why.
    pub(crate) fn explanation(&self, object: &StoredObject, judgement: &Judgement) -> String {
        let roster = self.household.roster();
        let conclusion = match &judgement.basis {
            Basis::Answer(answer) => Conclusion::Answered {
                reading: judgement.reading,
                words: &answer.answer,
                by: answer.answered_by.as_ref().and_then(|name| roster.index_of(name.as_str()).ok()),
                on: answer.at.date(),
                against: against_answer(&judgement.distribution, judgement.reading.owners, roster.len()),
            },
            Basis::Outdated(answer) => Conclusion::Outdated {
                said: Reading {
                    owners: roster.owner_set(&answer.owners()).unwrap_or_default(),
                    outside_household: answer.owner_outside_household,
                },
                by: answer.answered_by.as_ref().and_then(|name| roster.index_of(name.as_str()).ok()),
                on: answer.at.date(),
                owners: judgement.reading.owners,
                confidence: judgement.confidence,
            },
            Basis::Model { .. } | Basis::Evidence => Conclusion::Inferred {
                owners: judgement.reading.owners,
                confidence: judgement.confidence,
                standing: if judgement.assessment.settled { Standing::Settled } else { Standing::Open },
                others: roster
                    .indices()
                    .filter(|user| !judgement.reading.owners.contains(*user))
                    .filter(|user| judgement.scores[user.place()].value() >= POSSIBLE)
                    .collect(),
                model: match &judgement.basis {
                    Basis::Model { name } => Some(name.as_deref().unwrap_or_default()),
                    Basis::Answer(_) | Basis::Outdated(_) | Basis::Evidence => None,
                },
            },
        };
        explain(&Explained {
            roster,
            class: object.class.as_str(),
            room: object.room.as_deref(),
            position: object.position.metres(),
            conclusion,
            grounds: self.grounds(&self.evidence(object, judgement)),
        })
    }

    fn grounds(&self, evidence: &Evidence) -> Grounds {
        let roster = self.household.roster();
        let users = evidence.usage.iter().filter_map(|used| {
            let user = roster.index_of(used.user_id.as_str()).ok()?;
            Some(UserGrounds { user, sessions: used.sessions, days_ago: used.last_used_days_ago })
        });
        let parameters = EvidenceParameters::default();
        let near = evidence.neighbours.iter().map(|other| {
            let weight = coin::space::weight(other.distance, Neighbourhood::default().sigma);
            let relation = SeenRelation::Near { distance: other.distance };
            (parameters.coupling(Relation::Near { weight }), &other.name, &other.owners, relation)
        });
        let alike = evidence.look_alikes.iter().map(|other| {
            let coupling = parameters.coupling(Relation::LooksAlike { similarity: other.similarity });
            (coupling, &other.name, &other.owners, SeenRelation::LooksAlike)
        });
        let strongest = near
            .chain(alike)
            .filter(|(coupling, ..)| *coupling >= MENTIONED)
            .max_by(|left, right| left.0.total_cmp(&right.0));
        let relative = strongest.and_then(|(_, name, owners, relation)| {
            let owners = roster.owner_set(owners).ok()?;
            Some(RelativeGrounds { class: name.clone(), owners, relation })
        });
        Grounds { users: users.collect(), relative }
    }
}

impl Judgement {
    /// Whom a question is about: the plausible owners, or everybody where nobody is plausible enough.
    pub(crate) fn candidates(&self, roster: &Roster) -> OwnerSet {
        match self.assessment.prediction_set {
            OwnerSet::EMPTY => roster.everyone(),
            plausible => plausible,
        }
    }

    /// Where the judgement comes from, as tools tell it.
    pub(crate) fn source(&self) -> Source {
        match self.basis {
            Basis::Answer(_) => Source::Answer,
            Basis::Outdated(_) | Basis::Model { .. } | Basis::Evidence => Source::Inferred,
        }
    }

    /// The owner sets, most probable first.
    pub(crate) fn likely_sets(&self) -> impl Iterator<Item = OwnerSet> {
        let mut sets: Vec<(OwnerSet, f64)> = self.distribution.entries().to_vec();
        sets.sort_by(|left, right| right.1.total_cmp(&left.1));
        sets.into_iter().map(|(set, _)| set)
    }

    /// Whether no question is needed.
    pub(crate) fn is_settled(&self) -> bool {
        self.assessment.settled
    }
}

/// The owners, where a person named them.
fn named_owners(known: Option<&KnownOwnership>) -> Option<&Owners> {
    known.filter(|known| known.source == Source::Answer).map(|known| &known.owners)
}
