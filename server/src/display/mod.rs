//! Words for people, at a terminal or on a page: owners, probabilities, numbers, and text of foreign origin.

mod plain_text;

use coin_schemas::household::{Owners, Source, UserName};

pub use plain_text::{excerpt, plain_text};

/// Owners in words, as short as they can be said to somebody who knows the household.
pub fn owners_in_words(owners: &Owners, household: &Owners) -> String {
    let mut others = household.difference(owners);
    match (others.next(), others.next()) {
        _ if owners.is_empty() => "somebody outside".to_owned(),
        (None, _) if owners.len() > 2 => "everybody".to_owned(),
        (Some(other), None) if owners.len() > 2 => {
            format!("everybody but {}", plain_text(other.as_str()))
        }
        _ => names(owners),
    }
}

/// `Bob, 96 % sure`.
pub fn belief_in_words(whose: &str, confidence: f64, source: Source) -> String {
    match source {
        Source::Answer => format!("{whose}, as was answered"),
        Source::Inferred => format!("{whose}, {} sure", percent(confidence)),
    }
}

/// `Bob, Mary`.
pub fn names<'a>(names: impl IntoIterator<Item = &'a UserName>) -> String {
    names.into_iter().map(|name| plain_text(name.as_str())).collect::<Vec<_>>().join(", ")
}

/// `Bob, Mary and Tom`.
pub fn names_with_and(names: &[&UserName]) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => {
            format!("{} and {}", self::names(first.iter().copied()), plain_text(last.as_str()))
        }
        all => self::names(all.iter().copied()),
    }
}

/// A probability in whole percent, rounded down, so that only certainty is 100 %.
pub fn percent(probability: f64) -> String {
    // 0.29 × 100 is a little less than 29.
    let whole = (probability * 100.0 + 1e-9).floor();
    format!("{} %", if probability < 1.0 { whole.min(99.0) } else { whole })
}

/// `1 thing`, `2 things`; thousands are set apart.
pub fn count(number: u64, singular: &str, plural: &str) -> String {
    let noun = if number == 1 { singular } else { plural };
    format!("{} {noun}", grouped(number))
}

/// `1,234,567`.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;

    #[rstest]
    #[case(0.0, "0 %")]
    #[case(0.29, "29 %")]
    #[case(0.529, "52 %")]
    #[case(1.0 - f64::EPSILON, "99 %")]
    #[case(1.0, "100 %")]
    fn only_certainty_is_a_hundred_percent(#[case] probability: f64, #[case] shown: &str) {
        assert_eq!(percent(probability), shown);
    }

    #[rstest]
    #[case(0, "0 calls")]
    #[case(1, "1 call")]
    #[case(999, "999 calls")]
    #[case(1_000, "1,000 calls")]
    #[case(1_234_567, "1,234,567 calls")]
    fn counts_are_grouped(#[case] number: u64, #[case] shown: &str) {
        assert_eq!(count(number, "call", "calls"), shown);
    }

    #[rstest]
    #[case("", "Bob Mary Tom", "somebody outside")]
    #[case("Tom", "Tom", "Tom")]
    #[case("Bob Tom", "Bob Tom", "Bob, Tom")]
    #[case("Bob Tom", "Bob Mary Tom", "Bob, Tom")]
    #[case("Bob Mary Tom", "Bob Mary Tom", "everybody")]
    #[case("Bob Mary Tom", "Ann Bob Mary Tom", "everybody but Ann")]
    #[case("Bob Mary Tom", "Ann Bob Li Mary Tom", "Bob, Mary, Tom")]
    fn owners_are_put_in_words(#[case] owners: &str, #[case] household: &str, #[case] shown: &str) {
        let set = |names: &str| names.split_whitespace().map(|name| UserName::new(name).unwrap()).collect();
        assert_eq!(owners_in_words(&set(owners), &set(household)), shown);
    }
}
