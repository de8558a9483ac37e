//! What is thought of a thing's owners before its use is looked at.

use libm::{exp, log};

use coin_schemas::household::Score;

use super::EvidenceParameters;
use crate::common_sense::Expectation;
use crate::owners::OwnerSet;
use crate::roster::UserIndex;

/// How many owners things have in a home.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizePrior {
    /// The probability that a thing has one owner.
    pub single: f64,
    /// The probability that everybody owns it. What is left goes evenly to the sizes between.
    pub everyone: f64,
}

/// What is thought of a thing's owners before anybody has used it, beside how many owners things have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Opinion<'a> {
    /// Nothing is.
    None,
    /// What the file of classes expects in this household.
    OfClass(&'a Expectation),
    /// What a language model makes of the class, the people and the place: for every member the probability of being
    /// an owner, in the order of the roster. It must not have seen the usage, which would count twice.
    OfModel(&'a [Score]),
    /// The surest opinion that a language model can have: nobody but these people.
    Certain(OwnerSet),
}

impl<'a> From<Option<&'a Expectation>> for Opinion<'a> {
    fn from(expectation: Option<&'a Expectation>) -> Self {
        expectation.map_or(Self::None, Self::OfClass)
    }
}

/// The candidate owner sets of a thing among the people who can own it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Candidates {
    /// The people, in the order of the roster.
    people: Vec<UserIndex>,
    /// The sets of them, each by the places in `people`.
    sets: Vec<OwnerSet>,
}

impl Candidates {
    /// All sets of these people that are considered.
    pub(super) fn of(people: OwnerSet) -> Self {
        let people: Vec<UserIndex> = people.iter().collect();
        let sets = crate::owners::candidate_sets(people.len());
        Self { people, sets }
    }

    /// The sets, by places among the people.
    pub(super) fn sets(&self) -> &[OwnerSet] {
        &self.sets
    }

    /// How many people there are.
    pub(super) fn people(&self) -> usize {
        self.people.len()
    }

    /// The place of a member among the people; `None` where the member is no candidate.
    pub(super) fn place_of(&self, user: UserIndex) -> Option<usize> {
        self.people.iter().position(|&person| person == user)
    }

    /// A set of members by their places among the people; `None` where one of them is no candidate.
    pub(super) fn narrowed(&self, members: OwnerSet) -> Option<OwnerSet> {
        members.iter().map(|user| UserIndex::new(self.place_of(user)?)).collect::<Option<OwnerSet>>()
    }

    /// A set of places among the people by members of the household.
    pub(super) fn widened(&self, places: OwnerSet) -> OwnerSet {
        places.iter().filter_map(|place| self.people.get(place.place()).copied()).collect()
    }

    /// π(S) for every set: by the number of owners, evenly within a number. Where there is no size between one and
    /// everyone, the two are scaled up to 1.
    pub(super) fn by_size(&self, sizes: SizePrior) -> Vec<f64> {
        SizeShares::of(&self.sets, self.people.len()).by_size(&self.sets, sizes)
    }
}

/// What is thought of a thing by itself, as far as it is the same however many owners things have in the home.
pub(super) struct OwnPrior<'a> {
    candidates: &'a Candidates,
    shares: SizeShares,
    expected: Expected,
}

/// What an opinion expects.
enum Expected {
    Nothing,
    /// By the file of classes: e(S) of every set.
    OfClass(Vec<f64>),
    /// By a language model: for every set what its scores multiply π(S) by.
    OfModel(Vec<f64>),
    /// By the surest opinion of a language model: e(S) of every set.
    Certain(Vec<f64>),
}

impl<'a> OwnPrior<'a> {
    /// With this opinion. One that does not tell of all candidates says nothing.
    pub(super) fn new(candidates: &'a Candidates, opinion: Opinion<'_>) -> Self {
        let shares = SizeShares::of(&candidates.sets, candidates.people.len());
        let people = candidates.people.iter();
        let expected = match opinion {
            Opinion::None => Expected::Nothing,
            Opinion::OfClass(expectation) => {
                let suitability: Option<Vec<f64>> =
                    people.map(|person| expectation.suitability.get(person.place()).copied()).collect();
                suitability.map_or(Expected::Nothing, |suitability| {
                    Expected::OfClass(of_class(&candidates.sets, &shares, expectation, &suitability))
                })
            }
            Opinion::OfModel(scores) => {
                let scores: Option<Vec<f64>> =
                    people.map(|person| Some(scores.get(person.place())?.value())).collect();
                match scores {
                    Some(scores) if scores.len() > 1 => {
                        Expected::OfModel(candidates.sets.iter().map(|&set| odds(&scores, set)).collect())
                    }
                    _ => Expected::Nothing,
                }
            }
            Opinion::Certain(owners) => {
                let owners = candidates.narrowed(owners);
                let expected = candidates.sets.iter().map(|&set| f64::from(u8::from(Some(set) == owners)));
                Expected::Certain(expected.collect())
            }
        };
        Self { candidates, shares, expected }
    }

    /// The prior of every set: `(1 − w)·π(S) + w·e(S)`, where e is what is expected and w the weight of that term; w is 0
    /// where nothing is expected. As a mixture it excludes no owner set, however sure the opinion is. A language model's
    /// scores expect `e(S) ∝ π(S) · ∏_{u∈S} s_u · ∏_{u∉S} (1−s_u)`; where they leave no set possible, such as where all
    /// are 0, they say nothing.
    pub(super) fn of_sizes(&self, sizes: SizePrior, parameters: &EvidenceParameters) -> Vec<f64> {
        let by_size = self.shares.by_size(&self.candidates.sets, sizes);
        let mixed = |weight: f64, expected: &[f64]| {
            let both = by_size.iter().zip(expected);
            both.map(|(by_size, expected)| (1.0 - weight) * by_size + weight * expected).collect()
        };
        match &self.expected {
            Expected::Nothing => by_size,
            Expected::OfClass(expected) => mixed(parameters.common_sense, expected),
            Expected::Certain(expected) => mixed(parameters.language_model, expected),
            Expected::OfModel(odds) => {
                let weights: Vec<f64> = by_size.iter().zip(odds).map(|(prior, odds)| prior * odds).collect();
                let sum: f64 = weights.iter().sum();
                if sum <= 0.0 {
                    return by_size;
                }
                let expected: Vec<f64> = weights.iter().map(|weight| weight / sum).collect();
                mixed(parameters.language_model, &expected)
            }
        }
    }
}

/// What the file of classes expects: by size, and within a size in proportion to how well the members are suited
/// together.
fn of_class(
    sets: &[OwnerSet],
    shares: &SizeShares,
    expectation: &Expectation,
    suitability: &[f64],
) -> Vec<f64> {
    let sizes = SizePrior { single: expectation.single, everyone: expectation.everyone };
    let suited: Vec<f64> =
        sets.iter().map(|set| set.iter().map(|place| suitability[place.place()]).product()).collect();
    let mut sums = vec![0.0; shares.counts.len()];
    sets.iter().zip(&suited).for_each(|(set, suited)| sums[set.len()] += suited);
    let of_set =
        |(set, suited): (&OwnerSet, &f64)| shares.of_size(sizes, set.len()) * suited / sums[set.len()];
    sets.iter().zip(&suited).map(of_set).collect()
}

/// `∏_{u∈S} s_u · ∏_{u∉S} (1−s_u)`. A model is told to give one half where nothing speaks for or against a member, so its
/// scores are odds against that: one half for everybody says nothing.
fn odds(scores: &[f64], set: OwnerSet) -> f64 {
    let odds = scores.iter().enumerate().map(|(place, score)| {
        match UserIndex::new(place).is_some_and(|user| set.contains(user)) {
            true => *score,
            false => 1.0 - score,
        }
    });
    odds.product()
}

/// How a probability of sizes is spread over the sets that there are.
struct SizeShares {
    /// How many sets there are of every size.
    counts: Vec<f64>,
    members: usize,
    sizes_between: usize,
}

impl SizeShares {
    fn of(sets: &[OwnerSet], members: usize) -> Self {
        let mut counts = vec![0.0; members + 1];
        for set in sets {
            counts[set.len()] += 1.0;
        }
        let sizes_between = (2..members).filter(|&size| counts[size] > 0.0).count();
        Self { counts, members, sizes_between }
    }

    /// π(S) for every set.
    fn by_size(&self, sets: &[OwnerSet], sizes: SizePrior) -> Vec<f64> {
        let of_one = |(size, &count): (usize, &f64)| self.of_size(sizes, size) / count;
        let of_one: Vec<f64> = self.counts.iter().enumerate().map(of_one).collect();
        sets.iter().map(|set| of_one[set.len()]).collect()
    }

    /// The probability of all sets of a size together.
    fn of_size(&self, sizes: SizePrior, size: usize) -> f64 {
        if self.members == 1 {
            return 1.0;
        }
        let total = if self.sizes_between == 0 { sizes.single + sizes.everyone } else { 1.0 };
        let of_size = if size == 1 {
            sizes.single
        } else if size == self.members {
            sizes.everyone
        } else {
            (1.0 - sizes.single - sizes.everyone) / self.sizes_between as f64
        };
        of_size / total
    }
}

/// A prior of owner sets with what known relatives say: with probability 1 − ∏(1 − ρ_i) the thing has the owners of one
/// of its relatives (each in proportion to its coupling ρ_i), else those of the prior. A mixture keeps a crowd of
/// neighbours, which are no independent witnesses, from outvoting the thing's own usage. Relatives whose owners are no
/// candidate set, such as somebody outside the household, say nothing.
pub(super) fn with_relatives(sets: &[OwnerSet], own: &mut [f64], couplings: &[(OwnerSet, f64)]) {
    let (mut independent, mut sum) = (1.0, 0.0);
    let candidates = couplings.iter().filter(|(owners, _)| sets.contains(owners));
    for (_, coupling) in candidates.clone() {
        independent *= 1.0 - coupling;
        sum += coupling;
    }
    if sum <= 0.0 {
        return;
    }
    own.iter_mut().for_each(|weight| *weight *= independent);
    for (owners, coupling) in candidates {
        if let Some(place) = sets.iter().position(|set| set == owners) {
            own[place] += (1.0 - independent) * coupling / sum;
        }
    }
}

/// Natural logarithms of weights.
pub(super) fn logarithms(weights: &[f64]) -> impl Iterator<Item = f64> {
    weights.iter().map(|&weight| log(weight))
}

/// The weights whose natural logarithms these are, relative to the largest one.
pub(super) fn relative_weights(logarithms: &[f64]) -> Vec<f64> {
    let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    logarithms.iter().map(|&logarithm| exp(logarithm - largest)).collect()
}

/// ln of the sum of the numbers whose natural logarithms these are.
pub(super) fn log_sum(logarithms: &[f64]) -> f64 {
    let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if largest == f64::NEG_INFINITY {
        return largest;
    }
    largest + log(logarithms.iter().map(|&logarithm| exp(logarithm - largest)).sum())
}

/// ln of the mean of the numbers whose natural logarithms these are.
pub(super) fn log_mean(logarithms: &[f64]) -> f64 {
    log_sum(logarithms) - log(logarithms.len() as f64)
}
