//! How much the use of things tells of their owners at all: what somebody could say who knows the law by which a kind of home
//! was made, and not only its people.

use coin::evidence::home::{HomeEvidence, SeenThing, Told};
use coin::evidence::{EvidenceParameters, Opinion};
use coin::owners::{OwnerSet, candidate_sets};
use coin::roster::UserIndex;

use super::super::belongings::Belonging;
use super::super::parameters::OwnerSetSizes;
use super::super::sightings::Sighting;
use super::*;

/// Two sightings of one person that are further apart are two sessions, in minutes.
const GAP: i64 = 20;

/// The usage types' shares in the paper's data, around which those of a home are drawn.
const SHARES: [f64; 3] = [10.0 / 34.0, 15.0 / 34.0, 9.0 / 34.0];

/// How sure the best owner set of a thing is, and whether it is the true one.
struct Call {
    confidence: f64,
    is_right: bool,
}

fn call(weights: &[(OwnerSet, f64)], truth: OwnerSet) -> Call {
    let all: f64 = weights.iter().map(|(_, weight)| weight).sum();
    let (best, weight) =
        weights.iter().copied().max_by(|left, right| left.1.total_cmp(&right.1)).unwrap_or_default();
    Call { confidence: weight / all, is_right: best == truth }
}

/// How many of the least sure things have to be asked about until at most 1.2 % of all are wrong.
fn questions(mut calls: Vec<Call>) -> usize {
    calls.sort_by(|left, right| left.confidence.total_cmp(&right.confidence));
    let mut wrong = calls.iter().filter(|call| !call.is_right).count();
    let mut asked = 0;
    while wrong as f64 > 0.012 * calls.len() as f64 {
        wrong -= usize::from(!calls[asked].is_right);
        asked += 1;
    }
    asked
}

fn owners(people: &[usize]) -> OwnerSet {
    people.iter().filter_map(|&person| UserIndex::new(person)).collect()
}

/// Who used a thing, session by session, in order of time. Everything must have been seen as it was.
fn sessions(sightings: &[Sighting]) -> Vec<usize> {
    let mut seen: Vec<(i64, usize)> = sightings
        .iter()
        .map(|sighting| (sighting.day as i64 * 1440 + i64::from(sighting.minute), sighting.actor))
        .collect();
    seen.sort_unstable();
    let begins = |place: usize| {
        place == 0 || seen[place].1 != seen[place - 1].1 || seen[place].0 - seen[place - 1].0 > GAP
    };
    (0..seen.len()).filter(|&place| begins(place)).map(|place| seen[place].1).collect()
}

/// π(S)·p(sessions | S) for every set, by [`Belonging::next_user`] and the parameters of the home; the rate of borrowing is
/// drawn evenly, and of what several use in turn only the numbers of sessions are looked at.
fn by_the_law(users: &[usize], people: usize, protocol: Protocol) -> Vec<(OwnerSet, f64)> {
    const RATES: usize = 20;
    let parameters = protocol.parameters();
    let sharing = &parameters.sharing_in_groups;
    let sizes = OwnerSetSizes::at(f64::midpoint(sharing.start, sharing.end));
    let share = |of: [f64; 3], owners: usize| match owners {
        1 => of[0],
        all if all == people => of[2],
        _ => of[1] / (people - 2) as f64,
    };
    let step = (parameters.borrow.end - parameters.borrow.start) / RATES as f64;
    let likelihood = |set: OwnerSet| {
        let counts: Vec<usize> =
            set.iter().map(|user| users.iter().filter(|&&other| other == user.place()).count()).collect();
        let (own, owners) = (counts.iter().sum::<usize>(), counts.len());
        let borrowed = users.len() - own;
        let evenly = (owners as f64).powi(-(own as i32));
        let single = if owners == 1 && borrowed == 0 { SHARES[0] } else { 0.0 };
        let lent: f64 = match people - owners {
            0 => 1.0,
            others => {
                let of_rate =
                    |rate: f64| (rate / others as f64).powi(borrowed as i32) * (1.0 - rate).powi(own as i32);
                (0..RATES)
                    .map(|place| of_rate(parameters.borrow.start + step * (place as f64 + 0.5)))
                    .sum::<f64>()
                    / RATES as f64
            }
        };
        let (fewest, most) = (counts.iter().min(), counts.iter().max());
        let in_turn = match (fewest, most) {
            // Every round is some order of all owners, and the last one has begun.
            (Some(fewest), Some(most)) if borrowed == 0 && most - fewest <= 1 => {
                (0..own).map(|turn| 1.0 / (owners - turn % owners) as f64).product()
            }
            _ => 0.0,
        };
        let as_likely: f64 = (0..owners).map(|owner| (owner + 1) as f64 / (people - owner) as f64).product();
        as_likely
            * (single
                + SHARES[1] * share(sizes.temporary_sharing, owners) * lent * evenly
                + SHARES[2] * share(sizes.multi_user_sharing, owners) * in_turn)
    };
    candidate_sets(people).into_iter().map(|set| (set, likelihood(set))).collect()
}

/// What the evidence model says, which knows no law of any home and learns the habits of this one.
fn by_the_evidence(used: &[Vec<usize>], people: usize) -> Vec<Vec<(OwnerSet, f64)>> {
    let everybody = owners(&(0..people).collect::<Vec<_>>());
    let seen = |users: &Vec<usize>| SeenThing {
        class: String::new(),
        sessions: users.iter().filter_map(|&user| UserIndex::new(user)).collect(),
        near: Vec::new(),
        alike: Vec::new(),
        candidates: everybody,
        latecomers: OwnerSet::EMPTY,
    };
    let told = vec![Told { answer: None, opinion: Opinion::None }; used.len()];
    let home = HomeEvidence::new(used.iter().map(seen).collect(), EvidenceParameters::default());
    home.judge(&told).distributions().iter().map(|distribution| distribution.entries().to_vec()).collect()
}

/// There is little left to be learnt from who used what: whoever knows how an office was made needs nearly as many questions.
#[rstest]
#[case(Protocol::Office)]
#[case(Protocol::Week)]
fn the_evidence_of_use_is_near_what_the_law_of_the_homes_would_tell(#[case] protocol: Protocol) {
    const HOMES: u64 = 120;
    let (mut law, mut evidence) = (Vec::new(), Vec::new());
    for seed in 8001..8001 + HOMES {
        let story = story(protocol, seed);
        let people = story.people.len();
        let used: Vec<Vec<usize>> = story.sightings.iter().map(|seen| sessions(seen)).collect();
        let truths: Vec<OwnerSet> =
            story.belongings.iter().map(|Belonging { owners: truth, .. }| owners(truth)).collect();
        for (users, &truth) in used.iter().zip(&truths) {
            law.push(call(&by_the_law(users, people, protocol), truth));
        }
        for (weights, &truth) in by_the_evidence(&used, people).iter().zip(&truths) {
            evidence.push(call(weights, truth));
        }
    }
    let right =
        |calls: &[Call]| calls.iter().filter(|call| call.is_right).count() as f64 / calls.len() as f64;
    let (right_by_law, right_by_evidence) = (right(&law), right(&evidence));
    let [by_law, by_evidence] = [law, evidence].map(|calls| questions(calls) as f64 / HOMES as f64);
    println!(
        "{}: by the law {right_by_law:.3} right at once, {by_law:.1} questions; by the evidence {right_by_evidence:.3}, {by_evidence:.1}",
        protocol.name()
    );
    assert!(right_by_evidence > right_by_law - 0.02, "{right_by_evidence}, {right_by_law}");
    assert!(by_evidence < 1.25 * by_law + 0.5, "{by_evidence}, {by_law}");
}
