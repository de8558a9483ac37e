//! Words the question whether an answer was right.

use super::thing::Thing;
use super::wording::{Joined, list};
use crate::owners::OwnerSet;
use crate::roster::Roster;

/// Why an answer is asked about once more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Doubt {
    /// Everything else that is known of the thing speaks against it.
    Contradicted,
    /// People err now and then, and this thing is worth a second word.
    Unconfirmed,
}

/// One sentence that ends with a question mark, to which "yes" says that the owners were named rightly.
///
/// # Panics
/// If nobody was named: whose a stranger's thing is, is not asked again.
pub fn word_confirmation(
    roster: &Roster,
    (class, room, position): (&str, Option<&str>, [f64; 3]),
    named: OwnerSet,
    doubt: Doubt,
) -> String {
    assert!(!named.is_empty(), "only what members own is confirmed");
    let Thing { name, is, .. } = Thing::new(class, room, position);
    let sure = match doubt {
        Doubt::Contradicted => "Just to be sure, as its use tells otherwise",
        Doubt::Unconfirmed => "Just to be sure",
    };
    if named == roster.everyone() && named.len() > 2 {
        return format!("{sure}: do you all really share {name}?");
    }
    format!("{sure}: {} {name} really {}'s?", is.to_lowercase(), list(roster, named, Joined::And))
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;
    use crate::captions::test_support::roster;
    use crate::dialogue::{Reading, read_answer};
    use crate::support::set;

    #[rstest]
    #[case("mug", &[2], Doubt::Unconfirmed, "Just to be sure: is the mug in the kitchen really Tom's?")]
    #[case(
        "scissors",
        &[0, 1],
        Doubt::Contradicted,
        "Just to be sure, as its use tells otherwise: are the scissors in the kitchen really Bob and Mary's?"
    )]
    #[case("mug", &[0, 1, 2], Doubt::Unconfirmed, "Just to be sure: do you all really share the mug in the kitchen?")]
    fn a_yes_confirms_and_a_no_leaves_it_open(
        #[case] class: &str,
        #[case] named: &[usize],
        #[case] doubt: Doubt,
        #[case] question: &str,
    ) {
        let roster = roster(&[("Bob", "father"), ("Mary", "mother"), ("Tom", "son")]);
        let worded = word_confirmation(&roster, (class, Some("kitchen"), [0.0; 3]), set(named), doubt);
        assert_eq!(worded, question);
        let yes = Reading { owners: set(named), outside_household: false };
        assert_eq!(read_answer(&roster, &worded, "Yes.", None), yes);
        assert!(read_answer(&roster, &worded, "No.", None).is_unresolved());
        let other = read_answer(&roster, &worded, "No, it's Mary's.", None);
        assert_eq!(other.owners, set(&[1]));
    }
}
