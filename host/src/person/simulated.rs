//! A person who knows the truth and tells it in varied natural sentences.
//!
//! The words depend on the seed, the thing and how often it was asked about, and on nothing else: another order
//! of questions changes no answer. Every wording says the whole truth and nothing that the truth file does not
//! say, so that a careful reader arrives at exactly the true owners.

mod mistakes;
mod phrases;
#[cfg(test)]
mod reading_tests;
#[cfg(test)]
mod tests;

use async_trait::async_trait;
use coin_schemas::episode::Truth;
use coin_schemas::household::{ObjectId, UserName, Users};
use coin_schemas::model::TaskObject;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use self::mistakes::taken_for;
pub use self::mistakes::{ErrorRate, InvalidErrorRate};
use self::phrases::{Facts, NOT_THE_SAME, answers, answers_for_all};
use super::{Person, PersonError, PersonKind, PutQuestion, Response};

/// The draws that decide on errors, apart from those of the words.
const ERRORS: u32 = 1 << 31;

/// A household of people who know what belongs to whom.
///
/// A member answers each question; where a thing is asked about again, another member does. Who is an owner
/// speaks of it as "mine". Where the truth does not mention the thing, the answer is that nobody knows.
#[derive(Debug, Clone)]
pub struct SimulatedPerson {
    truth: Truth,
    users: Users,
    seed: u64,
    wrong_answers: ErrorRate,
}

impl SimulatedPerson {
    /// People of this household who answer from this truth, in words that follow from the seed.
    pub fn new(truth: Truth, users: Users, seed: u64) -> Self {
        Self { truth, users, seed, wrong_answers: ErrorRate::NONE }
    }

    /// The same people, who err in so many answers; asked again, they think anew.
    pub fn erring(self, wrong_answers: ErrorRate) -> Self {
        Self { wrong_answers, ..self }
    }

    fn answer(
        &self,
        object: &ObjectId,
        times_asked: u32,
        words: fn(&Facts<'_>) -> Vec<String>,
    ) -> (String, Option<UserName>) {
        let speaker = self.speaker(object, times_asked);
        let owners = self.truth.owners.get(object);
        let mut error = self.generator(object, ERRORS | times_asked);
        let taken = owners.and_then(|owners| taken_for(owners, &self.users, self.wrong_answers, &mut error));
        let usage_types = self.truth.usage_type.as_ref();
        let facts = Facts {
            users: &self.users,
            owners: taken.as_ref().or(owners),
            // What is said beside it would not fit other owners.
            usage_type: usage_types.filter(|_| taken.is_none()).and_then(|types| types.get(object)).copied(),
            speaker,
        };
        let mut wordings = words(&facts);
        let chosen = self.generator(object, times_asked.saturating_add(1)).random_range(0..wordings.len());
        (wordings.swap_remove(chosen), speaker.cloned())
    }

    /// What is said to a question about several things: whose they are, or that they are not the same people's. Whoever errs
    /// errs about all of them.
    fn answer_for_all(&self, first: &ObjectId, others: &[TaskObject]) -> (String, Option<UserName>) {
        let owners = self.truth.owners.get(first);
        match others.iter().all(|other| self.truth.owners.get(&other.id) == owners) {
            true => self.answer(first, 0, answers_for_all),
            false => (NOT_THE_SAME.to_owned(), self.speaker(first, 0).cloned()),
        }
    }

    fn speaker(&self, object: &ObjectId, times_asked: u32) -> Option<&UserName> {
        let members: Vec<&UserName> = self.users.keys().collect();
        let mut random = self.generator(object, 0);
        (!members.is_empty()).then(|| {
            let first = random.random_range(0..members.len());
            members[(first + times_asked as usize) % members.len()]
        })
    }

    /// A generator of its own for each thing and each time it is asked about.
    fn generator(&self, object: &ObjectId, draw: u32) -> ChaCha8Rng {
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
        let bytes = object.as_str().bytes().chain([0]).chain(draw.to_le_bytes());
        generator.set_stream(fowler_noll_vo(bytes));
        generator
    }
}

/// The 64-bit FNV-1a hash: unlike the hasher of the standard library it stays the same between versions.
fn fowler_noll_vo(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[async_trait]
impl Person for SimulatedPerson {
    fn kind(&self) -> PersonKind {
        PersonKind::Simulated
    }

    async fn ask(&mut self, question: &PutQuestion<'_>) -> Result<Response, PersonError> {
        let (answer, answered_by) = match question.also {
            [] => self.answer(&question.object.id, question.times_asked, answers),
            others => self.answer_for_all(&question.object.id, others),
        };
        Ok(Response::Said { answer, answered_by })
    }
}
