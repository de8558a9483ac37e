//! One question about several alike things, where that is expected to save questions.

use coin_schemas::household::ObjectId;

use crate::owners::OwnerSet;

/// One of the things that a person would name in one word: all things of a class in a room.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alike<'a> {
    /// The thing.
    pub object: &'a ObjectId,
    /// Whom it is held to belong to.
    pub owners: OwnerSet,
    /// What is thought of it as a thing to ask about.
    pub standing: AlikeStanding,
}

/// How one of several alike things stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AlikeStanding {
    /// It is settled.
    Settled,
    /// It is worth a question, and its owners are so probable.
    Open {
        /// conf(o).
        confidence: f64,
    },
    /// It was asked about before.
    Asked,
}

/// Those that one question ("Is every mug in the kitchen Tom's?") is put about: all that are open, where all alike things are
/// held to be the same people's, so that a yes is true of each, and where the question saves more than it costs. With k open
/// things, a yes takes one question in place of k and anything else one more, so that `k·∏ conf(o) > 1` is worth it. The
/// confidences are multiplied as if alike things had nothing to do with each other, which asks too seldom and not too often.
pub fn asked_together<'a>(alike: &[Alike<'a>]) -> Option<Vec<&'a ObjectId>> {
    let owners = alike.first()?.owners;
    let is_one_question = !owners.is_empty()
        && alike.iter().all(|thing| thing.owners == owners && thing.standing != AlikeStanding::Asked);
    let open: Vec<(&ObjectId, f64)> = alike
        .iter()
        .filter_map(|thing| match thing.standing {
            AlikeStanding::Open { confidence } => Some((thing.object, confidence)),
            AlikeStanding::Settled | AlikeStanding::Asked => None,
        })
        .collect();
    let yes: f64 = open.iter().map(|(_, confidence)| confidence).product();
    let saves = open.len() > 1 && yes * open.len() as f64 > 1.0;
    (is_one_question && saves).then(|| open.into_iter().map(|(object, _)| object).collect())
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;
    use crate::support::{id, set};

    const SETTLED: AlikeStanding = AlikeStanding::Settled;
    const ASKED: AlikeStanding = AlikeStanding::Asked;

    fn open(confidence: f64) -> AlikeStanding {
        AlikeStanding::Open { confidence }
    }

    #[rstest]
    #[case::two_of_one_person(&[(0, open(0.75)), (0, open(0.75))], Some(2))]
    #[case::too_unsure(&[(0, open(0.7)), (0, open(0.7))], None)]
    #[case::three_may_be_less_sure(&[(0, open(0.7)), (0, open(0.7)), (0, open(0.7))], Some(3))]
    #[case::beside_one_that_is_settled(&[(0, open(0.75)), (0, SETTLED), (0, open(0.75))], Some(2))]
    #[case::beside_one_of_somebody_else(&[(0, open(0.75)), (1, SETTLED), (0, open(0.75))], None)]
    #[case::one_was_asked_about(&[(0, open(0.75)), (0, ASKED), (0, open(0.75))], None)]
    #[case::one_alone(&[(0, open(0.8)), (0, SETTLED)], None)]
    fn what_is_likely_true_of_all_is_asked_of_all(
        #[case] things: &[(usize, AlikeStanding)],
        #[case] asked: Option<usize>,
    ) {
        let ids: Vec<ObjectId> = (0..things.len()).map(|thing| id(&thing.to_string())).collect();
        let alike: Vec<Alike<'_>> = things
            .iter()
            .zip(&ids)
            .map(|(&(owner, standing), object)| Alike { object, owners: set(&[owner]), standing })
            .collect();
        assert_eq!(asked_together(&alike).map(|things| things.len()), asked);
    }

    #[test]
    fn nobodys_things_are_not_asked_about_together() {
        let ids = [id("1"), id("2")];
        let alike: Vec<Alike<'_>> =
            ids.iter().map(|object| Alike { object, owners: OwnerSet::EMPTY, standing: open(0.9) }).collect();
        assert_eq!(asked_together(&alike), None);
        assert_eq!(asked_together(&[]), None);
    }
}
