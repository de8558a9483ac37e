//! What there is in the place, whose it is, and how it is used.

use rand::RngExt;
use rand::seq::{IndexedRandom, SliceRandom};
use rand_chacha::ChaCha8Rng;

use coin_schemas::household::UsageType;

use super::catalogue::{HOME, OFFICE, Suits, Thing};
use super::parameters::{OwnerSetSizes, PeopleTemplate, RoutineParameters, Structure};
use super::people::Person;
use super::random::{between, weighted};

/// A thing of the place. People are named by their place in the list of people.
#[derive(Debug, Clone)]
pub(super) struct Belonging {
    pub(super) thing: &'static Thing,
    pub(super) usage_type: UsageType,
    /// Who owns it, in order.
    pub(super) owners: Vec<usize>,
    /// Who does not.
    pub(super) others: Vec<usize>,
    /// The paper's p_borrow: how probably a session is a borrower's, where the thing is temporarily shared.
    pub(super) borrow: f64,
    /// Whose it was before, where it was handed down.
    pub(super) before: Option<HandDown>,
}

/// A thing changes hands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct HandDown {
    /// The first day of the present owner.
    pub(super) day: usize,
    owner: usize,
    others: Vec<usize>,
}

/// A usage type with a number of owners.
#[derive(Debug, Clone, Copy)]
struct Slot {
    usage_type: UsageType,
    owners: usize,
}

/// The paper's 34 things: how many there are of each usage type and number of owners. Derived from the rows of
/// its two heuristics in Tables 2 and 4 to 6.
const PAPER_SLOTS: [(usize, Slot); 7] = [
    (6, Slot { usage_type: UsageType::MultiUserSharing, owners: 3 }),
    (3, Slot { usage_type: UsageType::TemporarySharing, owners: 3 }),
    (2, Slot { usage_type: UsageType::MultiUserSharing, owners: 2 }),
    (1, Slot { usage_type: UsageType::TemporarySharing, owners: 2 }),
    (1, Slot { usage_type: UsageType::MultiUserSharing, owners: 1 }),
    (11, Slot { usage_type: UsageType::TemporarySharing, owners: 1 }),
    (10, Slot { usage_type: UsageType::SingleUser, owners: 1 }),
];

/// Draws the things of a place and who owns them.
///
/// `role_fit` is how far things follow the roles: what homes tend to share gets the larger owner sets, and what
/// suits a person is that person's.
pub(super) fn draw(
    people: &[Person],
    parameters: &RoutineParameters,
    role_fit: f64,
    generator: &mut ChaCha8Rng,
) -> Vec<Belonging> {
    let things = choose_things(parameters, generator);
    assign(things, people, parameters, role_fit, generator)
}

/// Draws the owners of these things.
pub(super) fn assign(
    things: Vec<&'static Thing>,
    people: &[Person],
    parameters: &RoutineParameters,
    role_fit: f64,
    generator: &mut ChaCha8Rng,
) -> Vec<Belonging> {
    let slots = match parameters.structure {
        Structure::Paper => {
            PAPER_SLOTS.iter().flat_map(|&(count, slot)| std::iter::repeat_n(slot, count)).collect()
        }
        Structure::Drawn => draw_slots(things.len(), people.len(), parameters, generator),
    };
    let mut belongings: Vec<Belonging> = Vec::with_capacity(things.len());
    for (thing, slot) in by_commonness(things, role_fit, generator).into_iter().zip(slots) {
        let alike: Vec<usize> = belongings
            .iter()
            .filter(|other| other.thing.class == thing.class && other.owners.len() == 1)
            .flat_map(|other| other.owners.iter().copied())
            .collect();
        let owners = choose_owners(people, thing, slot.owners, &alike, role_fit, generator);
        let others = (0..people.len()).filter(|person| !owners.contains(person)).collect();
        let borrow = between(&parameters.borrow, generator);
        belongings.push(Belonging {
            thing,
            usage_type: slot.usage_type,
            owners,
            others,
            borrow,
            before: None,
        });
    }
    belongings.shuffle(generator);
    belongings
}

/// Lets a share of the things of one owner be somebody else's until a day about half way.
pub(super) fn hand_down(belongings: &mut [Belonging], share: f64, days: usize, generator: &mut ChaCha8Rng) {
    for belonging in belongings.iter_mut().filter(|belonging| belonging.owners.len() == 1) {
        if belonging.usage_type == UsageType::MultiUserSharing || !generator.random_bool(share) {
            continue;
        }
        let day = generator.random_range(days * 2 / 5..=days * 3 / 5);
        if let Some(&owner) = belonging.others.choose(generator) {
            let everyone = belonging.owners.iter().chain(&belonging.others).copied();
            let mut others: Vec<usize> = everyone.filter(|&person| person != owner).collect();
            others.sort_unstable();
            belonging.before = Some(HandDown { day, owner, others });
        }
    }
}

fn choose_things(parameters: &RoutineParameters, generator: &mut ChaCha8Rng) -> Vec<&'static Thing> {
    let catalogue = match parameters.people {
        PeopleTemplate::Office { .. } => OFFICE,
        _ => HOME,
    };
    let mut pool: Vec<&'static Thing> =
        catalogue.iter().flat_map(|thing| std::iter::repeat_n(thing, thing.copies)).collect();
    pool.shuffle(generator);
    pool.truncate(generator.random_range(parameters.things.clone()));
    pool
}

/// Puts first what is likely to be shared.
fn by_commonness(
    things: Vec<&'static Thing>,
    role_fit: f64,
    generator: &mut ChaCha8Rng,
) -> Vec<&'static Thing> {
    let mut ranked: Vec<(f64, &'static Thing)> = things
        .into_iter()
        .map(|thing| (role_fit * thing.common + (1.0 - role_fit) * generator.random_range(0.0..1.0), thing))
        .collect();
    ranked.sort_by(|left, right| right.0.total_cmp(&left.0));
    ranked.into_iter().map(|(_, thing)| thing).collect()
}

/// Draws usage types and numbers of owners around the paper's proportions, the largest owner sets first.
fn draw_slots(
    things: usize,
    people: usize,
    parameters: &RoutineParameters,
    generator: &mut ChaCha8Rng,
) -> Vec<Slot> {
    const USAGE_TYPES: [(UsageType, f64); 3] = [
        (UsageType::SingleUser, 10.0),
        (UsageType::TemporarySharing, 15.0),
        (UsageType::MultiUserSharing, 9.0),
    ];
    let owner_set_sizes = OwnerSetSizes::at(between(&parameters.sharing_in_groups, generator));
    let of_this_home = USAGE_TYPES.map(|(_, weight)| weight * generator.random_range(0.6..1.4));
    let mut slots: Vec<Slot> = (0..things)
        .map(|_| {
            let usage_type = weighted(&of_this_home, generator)
                .map_or(UsageType::SingleUser, |place| USAGE_TYPES[place].0);
            let sizes = match usage_type {
                UsageType::SingleUser => [1.0, 0.0, 0.0],
                UsageType::TemporarySharing => owner_set_sizes.temporary_sharing,
                UsageType::MultiUserSharing => owner_set_sizes.multi_user_sharing,
            };
            let owners = match weighted(&sizes, generator) {
                Some(1) if people > 2 => generator.random_range(2..people),
                Some(1 | 2) => people,
                _ => 1,
            };
            Slot { usage_type, owners }
        })
        .collect();
    slots.sort_by_key(|slot| std::cmp::Reverse((slot.owners, slot.usage_type)));
    slots
}

/// Draws owners one after another: those whom the thing suits before others, as far as things follow the roles
/// here, and seldom someone who has such a thing already.
fn choose_owners(
    people: &[Person],
    thing: &Thing,
    owners: usize,
    alike: &[usize],
    role_fit: f64,
    generator: &mut ChaCha8Rng,
) -> Vec<usize> {
    const HAS_ONE_ALREADY: f64 = 0.2;
    let mut weights: Vec<f64> = people
        .iter()
        .enumerate()
        .map(|(index, person)| {
            let fit =
                if thing.suits == Suits::Anyone || person.is(thing.suits) { 1.0 } else { 1.0 - role_fit };
            if alike.contains(&index) { fit * HAS_ONE_ALREADY } else { fit }
        })
        .collect();
    let mut chosen: Vec<usize> = Vec::with_capacity(owners);
    while chosen.len() < owners.min(people.len()) {
        let Some(next) = weighted(&weights, generator)
            .or_else(|| (0..people.len()).find(|person| !chosen.contains(person)))
        else {
            break;
        };
        weights[next] = 0.0;
        chosen.push(next);
    }
    chosen.sort_unstable();
    chosen
}

impl Belonging {
    /// Who uses the thing in its next session (the paper's Appendix D), given how many sessions everybody has
    /// had so far:
    ///
    /// - single user: the owner;
    /// - temporary sharing: a borrower with probability p_borrow, every one equally likely, else an owner, every
    ///   one equally likely;
    /// - multi-user sharing: the owner who has had the fewest sessions, ties drawn.
    ///
    /// Before a thing is handed down, the owner is the earlier one.
    pub(super) fn next_user(
        &self,
        day: usize,
        sessions: &[usize],
        generator: &mut ChaCha8Rng,
    ) -> Option<usize> {
        let (owners, others) = match &self.before {
            Some(before) if day < before.day => (std::slice::from_ref(&before.owner), &before.others),
            _ => (self.owners.as_slice(), &self.others),
        };
        match self.usage_type {
            UsageType::SingleUser => owners.choose(generator).copied(),
            UsageType::TemporarySharing => {
                let borrowed = !others.is_empty() && generator.random_bool(self.borrow);
                if borrowed { others } else { owners }.choose(generator).copied()
            }
            UsageType::MultiUserSharing => {
                let fewest = owners.iter().map(|&owner| sessions[owner]).min()?;
                let next: Vec<usize> =
                    owners.iter().copied().filter(|&owner| sessions[owner] == fewest).collect();
                next.choose(generator).copied()
            }
        }
    }

    /// Whether two days lie on the same side of a handing down.
    pub(super) fn same_hands(&self, one: usize, other: usize) -> bool {
        self.before.as_ref().is_none_or(|before| (one < before.day) == (other < before.day))
    }
}
