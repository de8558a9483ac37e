//! Which class labels name the same class.

use coin_schemas::household::ClassLabel;

/// A class label without what is only spelling: case, and hyphens or underscores in place of spaces. A detector says
/// `coffee_mug` where a person wrote `Coffee Mug`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Kind(String);

impl Kind {
    pub(super) fn of(label: &ClassLabel) -> Self {
        Self(letters(label).collect())
    }
}

/// Whether two labels name the same class.
pub(super) fn is_same_kind(left: &ClassLabel, right: &ClassLabel) -> bool {
    left == right || letters(left).eq(letters(right))
}

fn letters(label: &ClassLabel) -> impl Iterator<Item = char> {
    let plain = |letter| if matches!(letter, '-' | '_') { ' ' } else { letter };
    label.as_str().chars().map(plain).flat_map(char::to_lowercase)
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;

    #[rstest]
    #[case("cup", "Cup", true)]
    #[case("coffee mug", "Coffee_Mug", true)]
    #[case("Blu-ray", "blu ray", true)]
    #[case("TASSE", "tasse", true)]
    #[case("cup", "cups", false)]
    #[case("coffee mug", "coffeemug", false)]
    fn spelling_makes_no_class(#[case] left: &str, #[case] right: &str, #[case] same: bool) {
        let [left, right] = [left, right].map(|label| ClassLabel::new(label).unwrap());
        assert_eq!(is_same_kind(&left, &right), same);
        assert_eq!(Kind::of(&left) == Kind::of(&right), same);
    }
}
