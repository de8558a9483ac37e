//! ActOwL against exact enumeration: with few things every labelling can be written down, and the probability of each
//! is a product of closed forms that the sampler does not use.

use libm::{exp, lgamma, log};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde_json::Value;

use super::position::Positions;
use super::*;
use crate::support::set;

fn generator(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// Two heaps of things, one attribute that goes with the heaps and one that does not.
fn five_things() -> Things {
    Things {
        positions: vec![[0.0, 0.0, 1.0], [0.4, 0.1, 0.8], [3.0, 2.0, 1.0], [3.3, 2.2, 0.5], [1.6, 1.0, 0.9]],
        attributes: vec![vec![0, 0], vec![0, 1], vec![1, 0], vec![1, 1], vec![2, 0]],
    }
}

fn determinant(m: &[[f64; 3]; 3]) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

/// ln Γ₃(x), but for the constant that cancels.
fn log_multigamma(x: f64) -> f64 {
    (0..3).map(|j| lgamma(x - 0.5 * f64::from(j))).sum()
}

/// The marginal likelihood of positions under the Normal–inverse-Wishart prior, with scatter about the sample mean.
fn log_positions(positions: &[[f64; 3]], prior: &PositionPrior) -> f64 {
    let n = positions.len() as f64;
    if positions.is_empty() {
        return 0.0;
    }
    let mean: [f64; 3] = std::array::from_fn(|axis| positions.iter().map(|p| p[axis]).sum::<f64>() / n);
    let (kappa, nu) = (prior.mean_weight + n, prior.degrees_of_freedom + n);
    let mut scatter = [[0.0; 3]; 3];
    for (i, row) in scatter.iter_mut().enumerate() {
        for (j, cell) in row.iter_mut().enumerate() {
            *cell = if i == j { prior.scatter[i] } else { 0.0 };
            *cell += positions.iter().map(|p| (p[i] - mean[i]) * (p[j] - mean[j])).sum::<f64>();
            *cell += prior.mean_weight * n / kappa * (mean[i] - prior.mean[i]) * (mean[j] - prior.mean[j]);
        }
    }
    let before: f64 = prior.scatter.iter().product();
    -1.5 * n * log(std::f64::consts::PI) + log_multigamma(nu / 2.0)
        - log_multigamma(prior.degrees_of_freedom / 2.0)
        + prior.degrees_of_freedom / 2.0 * log(before)
        - nu / 2.0 * log(determinant(&scatter))
        + 1.5 * log(prior.mean_weight / kappa)
}

/// The Dirichlet–multinomial probability of a sequence with these counts.
fn log_dirichlet(counts: &[usize], concentration: f64) -> f64 {
    let total: usize = counts.iter().sum();
    let all = concentration * counts.len() as f64;
    lgamma(all) - lgamma(all + total as f64)
        + counts.iter().map(|&c| lgamma(concentration + c as f64) - lgamma(concentration)).sum::<f64>()
}

/// Every labelling that fits the answers, with its probability.
fn enumerate(things: &Things, priors: &Priors, members: usize, known: &[Known]) -> Vec<(Vec<usize>, f64)> {
    let count = things.positions.len();
    let mut all = Vec::new();
    for code in 0..members.pow(count as u32) {
        let labels: Vec<usize> = (0..count).map(|thing| code / members.pow(thing as u32) % members).collect();
        let fits = |thing: usize| matches!(known[thing], Known::Label(label) if label != labels[thing]);
        if (0..count).any(fits) {
            continue;
        }
        let of_label = |label: usize| (0..count).filter(|&thing| labels[thing] == label).collect::<Vec<_>>();
        let sizes: Vec<usize> = (0..members).map(|label| of_label(label).len()).collect();
        let mut log_probability = log_dirichlet(&sizes, priors.label);
        for label in 0..members {
            let own = of_label(label);
            let positions: Vec<[f64; 3]> = own.iter().map(|&thing| things.positions[thing]).collect();
            log_probability += log_positions(&positions, &priors.position);
            for kind in 0..things.attributes[0].len() {
                let values = things.attributes.iter().map(|of| of[kind]).max().unwrap() + 1;
                let mut counts = vec![0; values];
                own.iter().for_each(|&thing| counts[things.attributes[thing][kind]] += 1);
                log_probability += log_dirichlet(&counts, priors.attribute);
            }
        }
        all.push((labels, exp(log_probability)));
    }
    let total: f64 = all.iter().map(|(_, weight)| weight).sum();
    all.into_iter().map(|(labels, weight)| (labels, weight / total)).collect()
}

fn exact_marginal(all: &[(Vec<usize>, f64)], thing: usize, label: usize) -> f64 {
    all.iter().filter(|(labels, _)| labels[thing] == label).map(|(_, p)| p).sum()
}

fn exact_entropy(all: &[(Vec<usize>, f64)], things: &[usize], members: usize) -> f64 {
    things
        .iter()
        .flat_map(|&thing| (0..members).map(move |label| exact_marginal(all, thing, label)))
        .filter(|p| *p > 0.0)
        .map(|p| -p * log(p))
        .sum()
}

fn exact_gain(all: &[(Vec<usize>, f64)], thing: usize, unasked: &[usize], members: usize) -> f64 {
    let rest: Vec<usize> = unasked.iter().copied().filter(|&other| other != thing).collect();
    let after: f64 = (0..members)
        .map(|answer| {
            let probability = exact_marginal(all, thing, answer);
            let given: Vec<(Vec<usize>, f64)> = all
                .iter()
                .filter(|(labels, _)| labels[thing] == answer)
                .map(|(labels, p)| (labels.clone(), p / probability))
                .collect();
            probability * exact_entropy(&given, &rest, members)
        })
        .sum();
    exact_entropy(all, unasked, members) - after
}

const MANY: Sampling = Sampling { chains: 8, burn_in: 100, kept: 4000, thinning: 2, least_gain: 0.0 };

/// 32,000 samples, of which sweeps in a row are alike: four standard errors of some thousand independent ones.
const MONTE_CARLO: f64 = 0.03;

#[test]
fn marginals_and_gains_are_those_of_enumeration() {
    for (members, answers) in [(2, vec![]), (2, vec![(0, 0)]), (3, vec![(0, 0), (2, 1)]), (3, vec![(4, 2)])] {
        let things = five_things();
        let priors = Priors::around(&things.positions);
        let mut run = ActOwl::new(things.clone(), priors, MANY, members, generator(7));
        for &(thing, owner) in &answers {
            run.answer(thing, set(&[owner]));
        }
        let all = enumerate(&things, &priors, members, &run.known);
        let unasked = run.unasked();
        for &thing in &unasked {
            for label in 0..members {
                let (found, exact) = (run.probabilities(thing)[label], exact_marginal(&all, thing, label));
                assert!(
                    (found - exact).abs() < MONTE_CARLO,
                    "p({thing} = {label}) is {exact}, sampled {found}"
                );
            }
            let (found, exact) =
                (run.samples.expected_gain(thing, &unasked), exact_gain(&all, thing, &unasked, members));
            assert!(
                (found - exact).abs() < 2.0 * MONTE_CARLO,
                "the gain of {thing} is {exact}, sampled {found}"
            );
        }
        let best = |gain: &dyn Fn(usize) -> f64| unasked.iter().copied().map(gain).fold(0.0, f64::max);
        let asked = run.next_question().unwrap();
        let largest = best(&|thing| exact_gain(&all, thing, &unasked, members));
        assert!(exact_gain(&all, asked, &unasked, members) > largest - 4.0 * MONTE_CARLO);
    }
}

/// What is sampled by default is enough to see which question tells most.
#[test]
fn the_default_sampling_comes_close_to_enumeration() {
    let things = five_things();
    let priors = Priors::around(&things.positions);
    let all = enumerate(&things, &priors, 3, &[Known::Nothing; 5]);
    let unasked: Vec<usize> = (0..5).collect();
    for seed in 0..5 {
        let run = ActOwl::new(things.clone(), priors, Sampling::default(), 3, generator(seed));
        for &thing in &unasked {
            let (found, exact) =
                (run.samples.expected_gain(thing, &unasked), exact_gain(&all, thing, &unasked, 3));
            assert!(
                (found - exact).abs() < 0.2,
                "seed {seed}: the gain of {thing} is {exact}, sampled {found}"
            );
        }
    }
}

/// A thing with several owners says nothing of the others: the rest is enumerated as if it were not there.
#[test]
fn a_thing_that_is_left_out_says_nothing() {
    // Of the attribute that is kept, the things that stay have every value, so that its prior is the same.
    let all_five = Things {
        attributes: five_things().attributes.iter().map(|of| vec![of[1]]).collect(),
        ..five_things()
    };
    let rest =
        Things { positions: all_five.positions[..4].to_vec(), attributes: all_five.attributes[..4].to_vec() };
    let priors = Priors::around(&all_five.positions);
    let mut run = ActOwl::new(all_five, priors, MANY, 2, generator(7));
    // One label is known, because without any answer the two people are as good as each other.
    run.answer(0, set(&[0]));
    run.answer(4, set(&[0, 1]));
    let known = [Known::Label(0), Known::Nothing, Known::Nothing, Known::Nothing];
    let enumerated = enumerate(&rest, &priors, 2, &known);
    for thing in 0..4 {
        let (found, exact) = (run.probabilities(thing)[0], exact_marginal(&enumerated, thing, 0));
        assert!((found - exact).abs() < MONTE_CARLO, "p({thing} = 0) is {exact}, sampled {found}");
    }
}

/// p(x_{n+1} | x_1 … x_n) is a quotient of marginal likelihoods.
#[test]
fn the_predictive_is_a_quotient_of_marginal_likelihoods() {
    let positions = five_things().positions;
    let prior = Priors::around(&positions).position;
    let mut seen = Positions::default();
    for (count, position) in positions.iter().enumerate() {
        let quotient =
            log_positions(&positions[..=count], &prior) - log_positions(&positions[..count], &prior);
        assert!((seen.log_predictive(position, &prior) - quotient).abs() < 1e-9);
        seen.add(position);
    }
    let last = positions[4];
    let before = seen;
    seen.remove(&last);
    seen.add(&last);
    assert!((seen.log_predictive(&last, &prior) - before.log_predictive(&last, &prior)).abs() < 1e-12);
}

#[test]
fn the_predictive_is_scipys_multivariate_t() {
    let rows: Vec<Value> =
        serde_json::from_str(include_str!("../../../tests/known_answers/student_t.json")).unwrap();
    assert!(!rows.is_empty());
    let vector = |value: &Value| -> [f64; 3] { serde_json::from_value(value.clone()).unwrap() };
    for row in rows {
        let prior = PositionPrior {
            mean: vector(&row["mean"]),
            mean_weight: row["mean_weight"].as_f64().unwrap(),
            degrees_of_freedom: row["degrees_of_freedom"].as_f64().unwrap(),
            scatter: vector(&row["scatter"]),
        };
        let mut seen = Positions::default();
        row["seen"].as_array().unwrap().iter().for_each(|position| seen.add(&vector(position)));
        let found = seen.log_predictive(&vector(&row["position"]), &prior);
        assert!((found - row["log_density"].as_f64().unwrap()).abs() < 1e-9, "{found} in {row}");
    }
}

#[test]
fn an_answer_stands_and_settles_its_thing() {
    let things = five_things();
    let priors = Priors::around(&things.positions);
    let mut run = ActOwl::new(things, priors, Sampling::default(), 3, generator(1));
    for (thing, owners) in [(0, set(&[0, 1])), (1, set(&[])), (2, set(&[2]))] {
        run.answer(thing, owners);
        assert_eq!(run.owners(thing), owners);
    }
    assert_eq!(run.unasked(), [3, 4]);
}

/// Thing 3 lies beside 2 and has its attribute.
#[test]
fn what_lies_and_looks_alike_has_the_same_owner() {
    let things = five_things();
    let priors = Priors::around(&things.positions);
    let mut run = ActOwl::new(things, priors, Sampling::default(), 2, generator(1));
    for (thing, owner) in [(0, 0), (1, 0), (2, 1)] {
        run.answer(thing, set(&[owner]));
    }
    assert_eq!(run.owners(3), set(&[1]));
}

#[test]
fn asking_ends_when_no_answer_tells_enough_or_nothing_is_left() {
    let things = five_things();
    let priors = Priors::around(&things.positions);
    let never = Sampling { least_gain: 100.0, ..Sampling::default() };
    assert_eq!(ActOwl::new(things.clone(), priors, never, 3, generator(1)).next_question(), None);
    let always = Sampling { least_gain: 0.0, ..Sampling::default() };
    let mut run = ActOwl::new(things, priors, always, 3, generator(1));
    let mut asked = Vec::new();
    while let Some(thing) = run.next_question() {
        asked.push(thing);
        run.answer(thing, set(&[thing % 3]));
    }
    asked.sort_unstable();
    assert_eq!(asked, [0, 1, 2, 3, 4]);
}

#[test]
fn the_same_seed_asks_the_same() {
    let run = |seed| {
        let things = five_things();
        let priors = Priors::around(&things.positions);
        ActOwl::new(things, priors, Sampling::default(), 3, generator(seed)).marginals
    };
    assert_eq!(run(3), run(3));
    assert_ne!(run(3), run(4));
}

#[test]
fn a_home_without_such_things_is_done() {
    let things = Things { positions: Vec::new(), attributes: Vec::new() };
    let priors = Priors::around(&things.positions);
    assert_eq!(ActOwl::new(things, priors, Sampling::default(), 2, generator(1)).next_question(), None);
}

#[test]
fn looks_become_words() {
    let features =
        [vec![1.0, 0.0, 0.0], vec![0.0, 2.0, 0.0], vec![5.0, 1.0, 0.0], vec![0.0; 3], vec![0.0; 3]];
    assert_eq!(visual_words(&features), [0, 1, 0, 2, 3]);
}
