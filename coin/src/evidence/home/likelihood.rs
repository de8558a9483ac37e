//! How well every owner set explains who used a thing, by three accounts of how a home treats its things.

use libm::{exp, log};

use super::super::EvidenceParameters;
use super::super::prior::{Candidates, log_mean, relative_weights};
use super::habits::{EVENNESS, Evenness, LENDING, LOOSEST, Lending, MISTAKEN};
use crate::owners::OwnerSet;
use crate::roster::UserIndex;

/// A change of hands is looked for at no more than so many places of a history, evenly spread.
const MOST_CUTS: usize = 16;

/// How probable it is that a thing which changed hands was everybody's before; else it was one person's.
const EVERYBODYS_BEFORE: f64 = 0.2;

/// The share of β in the law of turns where these are taken loosely.
const LOOSELY: f64 = 0.2;

/// The owners of a shared thing who have used it so much more often than another that it makes no further difference.
const FAR_AHEAD: usize = 64;

/// p(who used the thing, session by session | S) for every candidate set S of one thing, relative to the largest of all
/// its numbers, by account and by the habits of the home that the account depends on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Accounts {
    /// Nobody but the owners uses it, and where there are several they take turns, strictly or loosely, the one as likely as
    /// the other; other sightings are mistaken. For each of [`MISTAKEN`], the sets in order.
    pub(super) kept: Vec<Vec<f64>>,
    /// Others borrow it, and owners use it about evenly. For each of [`LENDING`] and then of [`EVENNESS`].
    pub(super) lent: Vec<Vec<f64>>,
    /// It was lent in the same way, and had other owners before some session. For each of [`LENDING`] and then of
    /// [`LOOSEST`]; nothing where the thing was used less than twice.
    pub(super) changed: Vec<Vec<f64>>,
}

impl Accounts {
    /// Of a thing whose users these were, by their places among the candidates, in order of time.
    pub(super) fn new(users: &[usize], candidates: &Candidates, parameters: &EvidenceParameters) -> Self {
        let all = relative_weights(&logarithms(users, candidates, parameters).concat());
        let mut kept: Vec<Vec<f64>> = all.chunks(candidates.sets().len()).map(<[f64]>::to_vec).collect();
        let changed = kept.split_off(MISTAKEN.len() + LENDING.len() * EVENNESS.len());
        let lent = kept.split_off(MISTAKEN.len());
        Self { kept, lent, changed }
    }
}

/// The natural logarithms of all accounts, one after the other, for every set.
pub(super) fn logarithms(
    users: &[usize],
    candidates: &Candidates,
    parameters: &EvidenceParameters,
) -> Vec<Vec<f64>> {
    let (sets, members) = (candidates.sets(), candidates.people());
    let counting = Counting::new(users.len(), members);
    let counts = counts_of(users, members);
    let turns = Turns::new(parameters.turns);
    let of_sets: Vec<[f64; MISTAKEN.len()]> =
        sets.iter().map(|&set| turns.log_likelihood(users, set, members)).collect();
    let kept = (0..MISTAKEN.len()).map(|mistaken| of_sets.iter().map(|of_set| of_set[mistaken]).collect());
    let every_evenness: [usize; EVENNESS.len()] = std::array::from_fn(|place| place);
    let lent = counting.log_likelihoods(&counts, sets, &every_evenness);
    let changed = match parameters.change_of_hands > 0.0 && users.len() > 1 && members > 1 {
        true => changed_hands(users, candidates, &counting),
        false => Vec::new(),
    };
    kept.chain(lent).chain(changed).collect()
}

fn counts_of(users: &[usize], members: usize) -> Vec<usize> {
    let mut counts = vec![0; members];
    for &user in users {
        counts[user] += 1;
    }
    counts
}

/// The law of turns: of the owners, who has used a thing c times is the next one with a probability in proportion to
/// exp(−β·c), so that nobody falls far behind. The paper's Appendix D has the limit of large β; β = 0 is chance.
struct Turns {
    /// exp(−β·d) for a lead d, where turns are taken strictly and loosely.
    of_lead: [Vec<f64>; 2],
}

impl Turns {
    fn new(beta: f64) -> Self {
        let of_lead = |share: f64| (0..=FAR_AHEAD).map(|lead| exp(-share * beta * lead as f64)).collect();
        Self { of_lead: [1.0, LOOSELY].map(of_lead) }
    }

    /// Σ ln((1−e)·q(u) + e/n) over the sessions, where q is the law of turns among the owners, and a mistaken sighting,
    /// of probability e, names anybody. For each of [`MISTAKEN`], the mean over strict and loose turns.
    fn log_likelihood(&self, users: &[usize], owners: OwnerSet, members: usize) -> [f64; MISTAKEN.len()] {
        let mut among_owners = vec![None; members];
        owners.iter().enumerate().for_each(|(place, owner)| among_owners[owner.place()] = Some(place));
        let mut used: Vec<usize> = vec![0; owners.len()];
        let mut products = MISTAKEN.map(|_| self.of_lead.each_ref().map(|_| LogProduct::default()));
        for &user in users {
            let turn = match among_owners[user] {
                Some(owner) => {
                    let turn = self.of_lead.each_ref().map(|of_lead| next_turn(of_lead, &used, owner));
                    used[owner] += 1;
                    turn
                }
                None => [0.0; 2],
            };
            for (products, mistaken) in products.iter_mut().zip(MISTAKEN) {
                for (product, turn) in products.iter_mut().zip(turn) {
                    product.times((1.0 - mistaken) * turn + mistaken / members as f64);
                }
            }
        }
        products.map(|products| log_mean(&products.map(LogProduct::logarithm)))
    }
}

/// How probable it is that an owner is the next one, of those who have used the thing so many times.
fn next_turn(of_lead: &[f64], used: &[usize], owner: usize) -> f64 {
    let fewest = used.iter().copied().min().unwrap_or(0);
    let weight = |count: usize| of_lead[(count - fewest).min(FAR_AHEAD)];
    weight(used[owner]) / used.iter().map(|&count| weight(count)).sum::<f64>()
}

/// The logarithm of a product of many probabilities, which takes few logarithms.
#[derive(Debug, Clone, Copy)]
struct LogProduct {
    sum: f64,
    product: f64,
}

impl Default for LogProduct {
    fn default() -> Self {
        Self { sum: 0.0, product: 1.0 }
    }
}

impl LogProduct {
    /// Far from where numbers become subnormal.
    const SMALL: f64 = 1e-200;

    fn times(&mut self, factor: f64) {
        self.product *= factor;
        if self.product < Self::SMALL {
            *self = Self { sum: self.logarithm(), product: 1.0 };
        }
    }

    fn logarithm(self) -> f64 {
        self.sum + log(self.product)
    }
}

fn contains(owners: OwnerSet, place: usize) -> bool {
    UserIndex::new(place).is_some_and(|user| owners.contains(user))
}

/// The account of lending by numbers of sessions alone, with its gamma functions in tables.
struct Counting {
    members: usize,
    lending: Vec<LendingTable>,
    /// For each of [`EVENNESS`].
    evenness: Vec<EvennessTable>,
    /// ln i for every number of people i.
    logarithms: Vec<f64>,
}

struct EvennessTable {
    owners: Split,
    borrowers: Option<Split>,
}

/// The rising factorials of kα for k people, whose place is k.
struct Split(Vec<RisingFactorials>);

impl Split {
    fn new(concentration: f64, members: usize, sessions: usize) -> Self {
        let of_so_many = |people: usize| concentration * people.max(1) as f64;
        Self((0..=members).map(|people| RisingFactorials::new(of_so_many(people), sessions)).collect())
    }

    /// One person's part of the Dirichlet–multinomial.
    fn share(&self, count: usize) -> f64 {
        self.0[1].at(count)
    }

    /// What all parts together are divided by.
    fn all(&self, people: usize, sessions: usize) -> f64 {
        self.0[people].at(sessions)
    }
}

struct LendingTable {
    borrowed: RisingFactorials,
    own_use: RisingFactorials,
    all: RisingFactorials,
}

/// ln (a)_i = lnΓ(a+i) − lnΓ(a) for i from 0 on.
struct RisingFactorials(Vec<f64>);

impl RisingFactorials {
    fn new(a: f64, most: usize) -> Self {
        let mut sum = 0.0;
        let rising = (0..most).map(|step| {
            sum += log(a + step as f64);
            sum
        });
        Self(std::iter::once(0.0).chain(rising).collect())
    }

    fn at(&self, steps: usize) -> f64 {
        self.0[steps]
    }
}

impl Counting {
    /// For up to so many sessions of so many members.
    fn new(sessions: usize, members: usize) -> Self {
        let lending = LENDING.map(|Lending { borrowed, own_use }| LendingTable {
            borrowed: RisingFactorials::new(borrowed, sessions),
            own_use: RisingFactorials::new(own_use, sessions),
            all: RisingFactorials::new(borrowed + own_use, sessions),
        });
        let split = |concentration: f64| Split::new(concentration, members, sessions);
        let evenness = EVENNESS.map(|Evenness { owners, borrowers }| EvennessTable {
            owners: split(owners),
            borrowers: borrowers.map(split),
        });
        let logarithms = (0..=members).map(|people| log(people as f64)).collect();
        Self { members, lending: lending.into(), evenness: evenness.into(), logarithms }
    }

    /// ln p(c | S) of every set, as [`super::super::log_likelihood`] has it, for each of [`LENDING`] and then of some of
    /// [`EVENNESS`]. Where the same people borrow the same thing again, `−m ln(n−k)` is the split of m sessions among n−k
    /// borrowers.
    fn log_likelihoods(&self, counts: &[usize], sets: &[OwnerSet], evenness: &[usize]) -> Vec<Vec<f64>> {
        let all = counts.iter().sum();
        let own_use: Vec<usize> = sets
            .iter()
            .map(|&set| {
                let of_owner = |(place, &count)| if contains(set, place) { count } else { 0 };
                counts.iter().enumerate().map(of_owner).sum()
            })
            .collect();
        let divided: Vec<Vec<[f64; 2]>> = evenness
            .iter()
            .map(|&place| {
                let table = &self.evenness[place];
                sets.iter()
                    .zip(&own_use)
                    .map(|(&set, &own)| self.divided(table, counts, set, own, all))
                    .collect()
            })
            .collect();
        let of_lending = |table: &LendingTable| {
            let lent: Vec<f64> =
                sets.iter().zip(&own_use).map(|(set, &own)| self.lent(table, set.len(), own, all)).collect();
            let sums = divided.iter().map(|divided| {
                lent.iter()
                    .zip(divided)
                    .map(|(lent, [borrowers, owners])| lent + borrowers + owners)
                    .collect()
            });
            sums.collect::<Vec<Vec<f64>>>()
        };
        self.lending.iter().flat_map(of_lending).collect()
    }

    /// Which sessions are of owners, and which of borrowers.
    fn lent(&self, table: &LendingTable, owners: usize, own: usize, all: usize) -> f64 {
        match owners < self.members {
            true => table.borrowed.at(all - own) + table.own_use.at(own) - table.all.at(all),
            false => 0.0,
        }
    }

    /// Which of the borrowers, and which of the owners.
    fn divided(
        &self,
        table: &EvennessTable,
        counts: &[usize],
        owners: OwnerSet,
        own: usize,
        all: usize,
    ) -> [f64; 2] {
        let (mut of_owners, mut of_borrowers) = (0.0, 0.0);
        for (place, &count) in counts.iter().enumerate() {
            let of_owner = if contains(owners, place) { table.owners.share(count) } else { 0.0 };
            of_owners += of_owner;
            if let Some(split) = &table.borrowers {
                of_borrowers += if contains(owners, place) { 0.0 } else { split.share(count) };
            }
        }
        let (owners, others, borrowed) = (owners.len(), self.members - owners.len(), all - own);
        let among_borrowers = match &table.borrowers {
            _ if others == 0 => 0.0,
            None => -(borrowed as f64 * self.logarithms[others]),
            Some(split) => of_borrowers - split.all(others, borrowed),
        };
        [among_borrowers, if owners > 1 { of_owners - table.owners.all(owners, own) } else { 0.0 }]
    }
}

/// The third account: the mean over the sessions at which the thing may have come to its owners, and over those whose it
/// may have been before.
fn changed_hands(users: &[usize], candidates: &Candidates, counting: &Counting) -> Vec<Vec<f64>> {
    let (sets, members) = (candidates.sets(), candidates.people());
    let everybody: OwnerSet = (0..members).filter_map(UserIndex::new).collect();
    let singles = (0..members).filter_map(UserIndex::new).map(OwnerSet::single);
    let before: Vec<OwnerSet> = singles.chain([everybody]).collect();
    let place_before: Vec<Option<usize>> =
        sets.iter().map(|set| before.iter().position(|owners| owners == set)).collect();
    let cuts = cuts(users.len());
    let mut logarithms = vec![vec![0.0; sets.len() * cuts.len()]; LENDING.len() * LOOSEST.len()];
    for (place, &cut) in cuts.iter().enumerate() {
        let (earlier, later) = users.split_at(cut);
        let past = counting.log_likelihoods(&counts_of(earlier, members), &before, &LOOSEST);
        let since = counting.log_likelihoods(&counts_of(later, members), sets, &LOOSEST);
        for ((past, since), of_account) in past.iter().zip(since).zip(&mut logarithms) {
            let past = Past::new(past);
            let of_sets = of_account.chunks_exact_mut(cuts.len());
            for ((of_cuts, &owners), since) in of_sets.zip(&place_before).zip(since) {
                of_cuts[place] = past.of_others(owners) + since;
            }
        }
    }
    logarithms.iter().map(|of_account| of_account.chunks_exact(cuts.len()).map(log_mean).collect()).collect()
}

/// How well the use before a change of hands is explained by those whose the thing may have been: one person's, or
/// everybody's.
struct Past {
    /// ln of the mean over all of them.
    of_all: f64,
    /// For each of them, ln of the mean over the others.
    without: Vec<f64>,
}

impl Past {
    /// With the natural logarithms of how well each explains it, the last of which is everybody.
    fn new(log_likelihoods: &[f64]) -> Self {
        let largest = log_likelihoods.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let members = log_likelihoods.len() - 1;
        let weighed: Vec<(f64, f64)> = log_likelihoods
            .iter()
            .enumerate()
            .map(|(place, logarithm)| {
                let prior = match place == members {
                    true => EVERYBODYS_BEFORE,
                    false => (1.0 - EVERYBODYS_BEFORE) / members as f64,
                };
                (prior, prior * exp(logarithm - largest))
            })
            .collect();
        let log_mean_without = |left_out: Option<usize>| {
            let others = weighed.iter().enumerate().filter(|&(place, _)| Some(place) != left_out);
            let (weight, weights) = others
                .fold((0.0, 0.0), |(weight, weights), (_, (prior, of_it))| (weight + of_it, weights + prior));
            largest + log(weight / weights)
        };
        Self {
            of_all: log_mean_without(None),
            without: (0..=members).map(|place| log_mean_without(Some(place))).collect(),
        }
    }

    /// ln of the mean over all but the owners at a place among them, or over all.
    fn of_others(&self, owners: Option<usize>) -> f64 {
        owners.map_or(self.of_all, |owners| self.without[owners])
    }
}

/// The places at which a history of so many sessions is cut in two, none of them empty.
fn cuts(sessions: usize) -> Vec<usize> {
    let places = (sessions - 1).min(MOST_CUTS);
    (1..=places).map(|cut| (cut * sessions).div_ceil(places + 1).min(sessions - 1)).collect()
}
