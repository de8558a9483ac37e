//! How common owners tie things to each other, by looks or by place, as one home shows it.

use std::collections::BTreeMap;

use crate::owners::OwnerSet;

/// The shrinkage of James and Stein: what common owners explain counts by `1 − c/F`, with F the explained sum of
/// squares over the variance within, which has a mean of 2 where they explain nothing. With c = 4 it counts for
/// nothing until it is clear of chance.
const SHRINKAGE: f64 = 4.0;

/// How many things two owner sets have one of each, both, or either: all that likeness can depend on where the people are
/// interchangeable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Kinship {
    fewer: usize,
    more: usize,
    both: usize,
}

impl Kinship {
    fn of(one: OwnerSet, other: OwnerSet) -> Self {
        let (fewer, more) = (one.len().min(other.len()), one.len().max(other.len()));
        Self { fewer, more, both: one.intersection(other).len() }
    }

    /// By the two ways in which common owners make things alike.
    fn ties(self) -> Ties {
        let both = self.both as f64;
        Ties {
            mean_taste: both / (self.fewer * self.more) as f64,
            common_taste: both / (self.fewer + self.more - self.both) as f64,
        }
    }
}

/// Two numbers for the two ways in which common owners make things alike.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Ties {
    /// |A∩B| / (|A|·|B|): the cosine where a thing's look is the mean of its owners' tastes, which have nothing in
    /// common.
    mean_taste: f64,
    /// |A∩B| / |A∪B|: the cosine where every group of people has a taste of its own, as far as it is the same group.
    common_taste: f64,
}

impl Ties {
    fn dot(self, other: Self) -> f64 {
        self.mean_taste * other.mean_taste + self.common_taste * other.common_taste
    }

    fn scaled(self, factor: f64) -> Self {
        Self { mean_taste: factor * self.mean_taste, common_taste: factor * self.common_taste }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            mean_taste: self.mean_taste + other.mean_taste,
            common_taste: self.common_taste + other.common_taste,
        }
    }
}

/// Pairs of things by a number that relates them, such as a cosine.
#[derive(Debug, Clone, Copy, Default)]
struct Pairs {
    count: f64,
    sum: f64,
    squares: f64,
}

/// What relates two things in a home, as a line over the ties between their owners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TieLine {
    /// Without a common owner.
    apart: f64,
    /// How much it grows with either tie.
    slopes: Ties,
    /// The variance where owners are related in one way.
    pub(super) variance: f64,
    /// The mean over all pairs.
    pub(super) mean: f64,
}

impl TieLine {
    /// What is expected of things with these owners.
    pub(super) fn expected(&self, one: OwnerSet, other: OwnerSet) -> f64 {
        self.apart + self.slopes.dot(Kinship::of(one, other).ties())
    }
}

/// Pairs of things whose owners are known.
#[derive(Debug, Clone, Default)]
pub(super) struct KnownPairs(BTreeMap<Kinship, Pairs>);

impl KnownPairs {
    /// Adds a pair that is related by this number.
    pub(super) fn add(&mut self, one: OwnerSet, other: OwnerSet, relation: f64) {
        let pairs = self.0.entry(Kinship::of(one, other)).or_default();
        pairs.count += 1.0;
        pairs.sum += relation;
        pairs.squares += relation * relation;
    }

    /// Adds so many pairs that nothing relates.
    pub(super) fn add_unrelated(&mut self, one: OwnerSet, other: OwnerSet, count: f64) {
        self.0.entry(Kinship::of(one, other)).or_default().count += count;
    }

    /// The line through them; `None` where common owners explain no more than chance does.
    pub(super) fn line(&self) -> Option<TieLine> {
        let kinds: Vec<(Ties, Pairs)> = self
            .0
            .iter()
            .filter(|(_, pairs)| pairs.count > 0.0)
            .map(|(kinship, &pairs)| (kinship.ties(), pairs))
            .collect();
        let count: f64 = kinds.iter().map(|(_, pairs)| pairs.count).sum();
        let mean = kinds.iter().map(|(_, pairs)| pairs.sum).sum::<f64>() / count;
        let centre = kinds
            .iter()
            .fold(Ties::default(), |sum, &(ties, pairs)| sum.plus(ties.scaled(pairs.count / count)));
        let mut regression = Regression::default();
        for &(ties, pairs) in &kinds {
            regression.add(ties.plus(centre.scaled(-1.0)), pairs.count, pairs.sum - pairs.count * mean);
        }
        let spread = |pairs: &Pairs| (pairs.squares - pairs.sum * pairs.sum / pairs.count).max(0.0);
        let freedom = count - kinds.len() as f64;
        let variance = kinds.iter().map(|(_, pairs)| spread(pairs)).sum::<f64>() / freedom;
        let slopes = regression.slopes();
        let explained = slopes.dot(regression.with_relation);
        (freedom > 0.0 && variance > 0.0 && explained > SHRINKAGE * variance).then(|| {
            let slopes = slopes.scaled(1.0 - SHRINKAGE * variance / explained);
            TieLine { apart: mean - slopes.dot(centre), slopes, variance, mean }
        })
    }
}

/// Least squares of what relates things on the two ties, neither of which makes it less.
#[derive(Debug, Clone, Copy, Default)]
struct Regression {
    mean_taste: f64,
    product: f64,
    common_taste: f64,
    with_relation: Ties,
}

impl Regression {
    /// Adds so many pairs with the same ties, and the sum of what relates them, both off their means.
    fn add(&mut self, ties: Ties, count: f64, relations: f64) {
        self.mean_taste += count * ties.mean_taste * ties.mean_taste;
        self.product += count * ties.mean_taste * ties.common_taste;
        self.common_taste += count * ties.common_taste * ties.common_taste;
        self.with_relation = self.with_relation.plus(ties.scaled(relations));
    }

    /// Where the ties cannot be told apart, as in a home in which everything has one owner, the first stands for both.
    fn slopes(&self) -> Ties {
        let Ties { mean_taste: first, common_taste: second } = self.with_relation;
        let determinant = self.mean_taste * self.common_taste - self.product * self.product;
        let only_first = Ties { mean_taste: (first / self.mean_taste).max(0.0), common_taste: 0.0 };
        if determinant <= 1e-9 * self.mean_taste * self.common_taste {
            return only_first;
        }
        let both = Ties {
            mean_taste: (self.common_taste * first - self.product * second) / determinant,
            common_taste: (self.mean_taste * second - self.product * first) / determinant,
        };
        if both.common_taste < 0.0 {
            only_first
        } else if both.mean_taste < 0.0 {
            Ties { mean_taste: 0.0, common_taste: (second / self.common_taste).max(0.0) }
        } else {
            both
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::set;

    fn line(pairs: &[(&[usize], &[usize], f64)]) -> Option<TieLine> {
        let mut known = KnownPairs::default();
        pairs.iter().for_each(|&(one, other, relation)| known.add(set(one), set(other), relation));
        known.line()
    }

    #[test]
    fn common_owners_that_explain_much_are_a_line() {
        let line = line(&[
            (&[0], &[0], 0.8),
            (&[1], &[1], 0.9),
            (&[0], &[0], 0.85),
            (&[0], &[1], 0.1),
            (&[1], &[2], 0.0),
            (&[0], &[2], 0.05),
        ]);
        let line = line.unwrap();
        let (alike, apart) = (line.expected(set(&[2]), set(&[2])), line.expected(set(&[2]), set(&[1])));
        assert!(alike > 0.7 && alike < 0.85 && apart > 0.05 && apart < 0.2, "{alike} {apart}");
    }

    /// Neither tie makes things less alike, so that the slopes are 0 and explain nothing.
    #[test]
    fn common_owners_that_make_things_less_alike_are_none() {
        let unlike = [(&[0][..], &[0][..], 0.0), (&[1], &[1], 0.1), (&[0], &[1], 0.8), (&[1], &[2], 0.9)];
        assert_eq!(line(&unlike), None);
    }

    #[test]
    fn too_few_pairs_are_none() {
        assert_eq!(line(&[]), None);
        assert_eq!(line(&[(&[0], &[0], 0.9)]), None);
        assert_eq!(line(&[(&[0], &[0], 0.9), (&[0], &[1], 0.1)]), None);
    }
}
