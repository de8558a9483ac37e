//! What a home or an office may hold: every class with where it is kept, what it is used for and by whom.
//!
//! The entries are ours, from what is ordinary in a household; the numbers are typical and the generator draws
//! around them.

mod home;
mod office;

pub(super) use home::HOME;
pub(super) use office::OFFICE;

/// A piece of a person's day in which things are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Activity {
    Washing,
    Dressing,
    Breakfast,
    Lunch,
    Dinner,
    Snack,
    Cooking,
    Dishes,
    Cleaning,
    Laundry,
    ComingAndGoing,
    Reading,
    Television,
    Computer,
    Homework,
    Play,
    Music,
    Exercise,
    Garden,
    Bedtime,
    DeskWork,
    Meeting,
    Parcels,
}

/// Where a class is usually kept; each person has an own spot of every kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kept {
    Cupboard,
    BathroomShelf,
    Hook,
    Desk,
    Seat,
    Bedside,
}

impl Kept {
    pub(super) const ALL: [Self; 6] =
        [Self::Cupboard, Self::BathroomShelf, Self::Hook, Self::Desk, Self::Seat, Self::Bedside];
}

/// Whom a class suits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Suits {
    Anyone,
    Adult,
    Child,
    Man,
    Woman,
    Clerk,
    Homemaker,
    Student,
}

/// How a thing is handled, which decides what a session with it looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Handling {
    /// It is looked for, taken, used and put back.
    Carried,
    /// It stays where it is; the first verb begins a session and the last one ends it.
    Fixed,
}

/// A class of things.
#[derive(Debug)]
pub(super) struct Thing {
    /// The class label.
    pub(super) class: &'static str,
    pub(super) kept: Kept,
    /// The height at which it lies, in metres.
    pub(super) height: f64,
    pub(super) handling: Handling,
    pub(super) activities: &'static [Activity],
    /// Verb phrases that suit the class, the thing's name following.
    pub(super) uses: &'static [&'static str],
    /// How it is cleaned, where people do so.
    pub(super) cleaning: Option<&'static str>,
    /// Sessions in an ordinary week.
    pub(super) weekly: f64,
    /// How many of them a home may have.
    pub(super) copies: usize,
    pub(super) suits: Suits,
    /// How far homes tend to own it together, 0 to 1.
    pub(super) common: f64,
}

/// Begins an entry of something that is carried about.
const fn carried(class: &'static str, kept: Kept, height: f64, weekly: f64) -> Thing {
    Thing {
        class,
        kept,
        height,
        handling: Handling::Carried,
        activities: &[],
        uses: &["uses"],
        cleaning: None,
        weekly,
        copies: 1,
        suits: Suits::Anyone,
        common: 0.5,
    }
}

/// Begins an entry of something that stays in its place.
const fn fixed(class: &'static str, kept: Kept, height: f64, weekly: f64) -> Thing {
    Thing { handling: Handling::Fixed, ..carried(class, kept, height, weekly) }
}

impl Thing {
    const fn during(self, activities: &'static [Activity]) -> Self {
        Self { activities, ..self }
    }

    const fn by(self, uses: &'static [&'static str]) -> Self {
        Self { uses, ..self }
    }

    const fn cleaned(self, phrase: &'static str) -> Self {
        Self { cleaning: Some(phrase), ..self }
    }

    const fn copies(self, copies: usize) -> Self {
        Self { copies, ..self }
    }

    const fn suits(self, suits: Suits) -> Self {
        Self { suits, ..self }
    }

    const fn common(self, common: f64) -> Self {
        Self { common, ..self }
    }
}
