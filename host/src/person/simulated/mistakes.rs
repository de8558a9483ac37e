//! Answers that are wrong on purpose, to see what becomes of them.

use std::str::FromStr;

use coin_schemas::household::{Owners, UserName, Users};
use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;
use thiserror::Error;

/// The share of answers that are wrong, from 0 to 1.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ErrorRate(f64);

/// A share that is none.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{given:?} is no share; give a number from 0 to 1, such as 0.05 for one answer in twenty")]
pub struct InvalidErrorRate {
    /// What was given.
    given: String,
}

impl ErrorRate {
    /// Everybody tells the truth.
    pub const NONE: Self = Self(0.0);

    /// One answer in twenty, by which the documentation measures.
    pub const ONE_IN_TWENTY: Self = Self(0.05);

    /// The share.
    pub fn value(self) -> f64 {
        self.0
    }
}

impl FromStr for ErrorRate {
    type Err = InvalidErrorRate;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let share = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
        share.map(Self).ok_or_else(|| InvalidErrorRate { given: text.to_owned() })
    }
}

/// What somebody takes for the owners who errs in so many answers: the true ones, or these with one person more, one
/// less, or one for another, each as likely as the others. Who lives alone does not err.
pub(super) fn taken_for(
    owners: &Owners,
    users: &Users,
    rate: ErrorRate,
    generator: &mut ChaCha8Rng,
) -> Option<Owners> {
    if !generator.random_bool(rate.0) || owners.is_empty() {
        return None;
    }
    let strangers: Vec<&UserName> = users.keys().filter(|user| !owners.contains(*user)).collect();
    let members: Vec<&UserName> = owners.iter().collect();
    let mut mistaken = Vec::new();
    let with = |owner: &UserName, owners: &Owners| owners.iter().chain([owner]).cloned().collect::<Owners>();
    let without =
        |owner: &UserName| owners.iter().filter(|other| *other != owner).cloned().collect::<Owners>();
    mistaken.extend(strangers.iter().map(|stranger| with(stranger, owners)));
    mistaken.extend(members.iter().map(|member| without(member)).filter(|owners| !owners.is_empty()));
    for member in &members {
        mistaken.extend(strangers.iter().map(|stranger| with(stranger, &without(member))));
    }
    mistaken.choose(generator).cloned()
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rstest::rstest;

    use super::*;
    use coin_schemas::household::Background;

    fn users(names: &str) -> Users {
        names.split_whitespace().map(|name| (UserName::new(name).unwrap(), Background::default())).collect()
    }

    fn owners(names: &str) -> Owners {
        names.split_whitespace().map(|name| UserName::new(name).unwrap()).collect()
    }

    #[rstest]
    #[case("Tom", "Bob Mary Tom")]
    #[case("Bob Mary", "Bob Mary Tom")]
    #[case("Bob Mary Tom", "Bob Mary Tom")]
    #[case("Bob", "Bob Mary")]
    fn a_mistake_names_other_members_and_is_as_frequent_as_was_asked_for(
        #[case] truth: &str,
        #[case] household: &str,
    ) {
        let (truth, household) = (owners(truth), users(household));
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        let mut wrong = 0;
        for _ in 0..1000 {
            if let Some(named) = taken_for(&truth, &household, ErrorRate::ONE_IN_TWENTY, &mut generator) {
                assert_ne!(named, truth);
                assert!(!named.is_empty() && named.iter().all(|name| household.contains_key(name)));
                wrong += 1;
            }
        }
        // Four standard deviations.
        assert!((22..=78).contains(&wrong), "{wrong}");
    }

    #[test]
    fn nobody_errs_about_strangers_things_or_alone() {
        let mut generator = ChaCha8Rng::seed_from_u64(2);
        let always = ErrorRate(1.0);
        assert_eq!(taken_for(&owners(""), &users("Bob Mary"), always, &mut generator), None);
        assert_eq!(taken_for(&owners("Bob"), &users("Bob"), always, &mut generator), None);
        assert_eq!(taken_for(&owners("Bob"), &users("Bob Mary"), ErrorRate::NONE, &mut generator), None);
    }

    #[rstest]
    #[case("0", Some(0.0))]
    #[case("0.05", Some(0.05))]
    #[case("1", Some(1.0))]
    #[case("1.01", None)]
    #[case("-0.1", None)]
    #[case("NaN", None)]
    #[case("5%", None)]
    fn a_share_is_between_nothing_and_all(#[case] text: &str, #[case] share: Option<f64>) {
        assert_eq!(text.parse().ok(), share.map(ErrorRate));
    }
}
