//! How often an answer is opened again for nothing, and how soon where a thing changed hands, by simulation.

use coin::evidence::{EvidenceParameters, OUTDATED, since_answer};
use coin::roster::UserIndex;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::support::{set, user};

const MEMBERS: usize = 3;

/// So many sessions of a thing of the owner, of which others have this share.
fn sessions(owner: usize, others: f64, count: usize, generator: &mut ChaCha8Rng) -> Vec<UserIndex> {
    (0..count)
        .map(|_| match generator.random_bool(others) {
            true => user((owner + generator.random_range(1..MEMBERS)) % MEMBERS),
            false => user(owner),
        })
        .collect()
}

/// After how many sessions an answer that the thing is the first member's is held to be outdated.
fn opened_after(sessions: &[UserIndex], from: usize) -> Option<usize> {
    let parameters = EvidenceParameters::default();
    (from.max(1)..=sessions.len()).find(|&seen| {
        let posterior = since_answer(&sessions[..seen], MEMBERS, set(&[0]), &parameters).unwrap();
        posterior.probability(set(&[0])) <= 1.0 - OUTDATED
    })
}

#[test]
fn what_is_only_lent_is_hardly_ever_opened_again() {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    for share in [0.15, 0.35] {
        let opened =
            (0..100).filter(|_| opened_after(&sessions(0, share, 30, &mut generator), 0).is_some()).count();
        assert!(opened <= 2, "{opened} of 100 things lent in {share} of their sessions were opened again");
    }
}

#[test]
fn what_changed_hands_is_noticed_within_some_sessions() {
    let mut generator = ChaCha8Rng::seed_from_u64(2);
    for kept in [0, 5, 15] {
        let mut delays: Vec<usize> = (0..60)
            .filter_map(|_| {
                let mut all = sessions(0, 0.15, kept, &mut generator);
                all.extend(sessions(1, 0.15, 40, &mut generator));
                Some(opened_after(&all, kept)? - kept)
            })
            .collect();
        delays.sort_unstable();
        assert_eq!(delays.len(), 60, "every change was noticed in the end");
        assert!(delays[30] <= 10, "half of the changes took {} sessions to notice", delays[30]);
        assert!(delays[54] <= 20, "nine of ten changes took {} sessions to notice", delays[54]);
    }
}
