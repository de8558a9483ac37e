//! The protocols as data: one [`RoutineParameters`] says all that tells one kind of home from another.

use std::ops::{Range, RangeInclusive};

use clap::ValueEnum;

/// A kind of home, and how well it is watched. What is exact in [`Paper`](Self::Paper) is so with our own routines; with
/// HOMER's there are the paper's owner sets and about its number of captions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, ValueEnum)]
pub enum Protocol {
    /// The paper's family in a week whose counts and two heuristics are exactly those of the paper's tables
    Paper,
    /// Families of two to four in a week of the paper's kind, with nothing exact about it
    Week,
    /// As week, with more borrowing (25–45 %) and 5 % of the sightings naming the wrong person
    Borrowing,
    /// As week, with two days of history
    TwoDays,
    /// As week, in many wordings: 20 % missed, 5 % naming the wrong person, 5 % naming nobody
    Paraphrased,
    /// Five colleagues and the things of their office
    Office,
    /// Couples, and flats that four to eight people share
    OtherHomes,
    /// As week, with 8 % of the sightings naming the wrong person
    Mistaken,
    /// As week, over forty days in which things are handed down
    HandedDown,
    /// Couples
    Couple,
    /// Flats that four to eight people share
    SharedHouse,
}

impl Protocol {
    /// Every protocol.
    pub const ALL: [Self; 11] = [
        Self::Paper,
        Self::Week,
        Self::Borrowing,
        Self::TwoDays,
        Self::Paraphrased,
        Self::Office,
        Self::OtherHomes,
        Self::Mistaken,
        Self::HandedDown,
        Self::Couple,
        Self::SharedHouse,
    ];

    /// The name on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Week => "week",
            Self::Borrowing => "borrowing",
            Self::TwoDays => "two-days",
            Self::Paraphrased => "paraphrased",
            Self::Office => "office",
            Self::OtherHomes => "other-homes",
            Self::Mistaken => "mistaken",
            Self::HandedDown => "handed-down",
            Self::Couple => "couple",
            Self::SharedHouse => "shared-house",
        }
    }

    /// What makes this kind of home.
    pub fn parameters(self) -> RoutineParameters {
        let week = RoutineParameters::week();
        match self {
            Self::Paper => RoutineParameters {
                people: PeopleTemplate::PaperFamily,
                structure: Structure::Paper,
                things: 34..=34,
                first_day: FirstDay::Fixed { year: 2025, month: 1, day: 13 },
                sessions: 5..=54,
                busyness: 1.25..1.25,
                role_fit: 0.6..0.6,
                cohesion: 0.6..0.6,
                ..week
            },
            Self::Week => week,
            Self::Borrowing => RoutineParameters { borrow: 0.25..0.45, mistaken: 0.05, ..week },
            Self::TwoDays => RoutineParameters { days: 2, sessions: 1..=20, ..week },
            Self::Paraphrased => RoutineParameters {
                paraphrased: 0.8,
                missed: 0.2,
                mistaken: 0.05,
                unattributed: 0.05,
                ..week
            },
            Self::Office => RoutineParameters {
                people: PeopleTemplate::Office { people: 5 },
                sharing_in_groups: 0.0..1.0,
                busyness: 0.6..1.2,
                ..week
            },
            Self::OtherHomes => RoutineParameters {
                people: PeopleTemplate::CoupleOrFlat { most: 8 },
                sharing_in_groups: 1.0..1.0,
                ..week
            },
            Self::Mistaken => RoutineParameters { mistaken: 0.08, ..week },
            Self::HandedDown => RoutineParameters { days: 40, sessions: 8..=300, handed_down: 0.4, ..week },
            Self::Couple => RoutineParameters { people: PeopleTemplate::Couple, ..week },
            Self::SharedHouse => RoutineParameters {
                people: PeopleTemplate::Flat { most: 8 },
                sharing_in_groups: 1.0..1.0,
                ..week
            },
        }
    }
}

/// Who shares the place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PeopleTemplate {
    /// Bob, Mary and Tom.
    PaperFamily,
    /// A family of two to four.
    Family,
    /// Colleagues in an office, with office things.
    Office {
        /// How many.
        people: usize,
    },
    /// A couple.
    Couple,
    /// A flat shared by four or more.
    Flat {
        /// The most people in it.
        most: usize,
    },
    /// A couple, or a flat shared by four or more.
    CoupleOrFlat {
        /// The most people in a flat.
        most: usize,
    },
}

/// How usage types and owner sets come about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Structure {
    /// Exactly as the paper's tables imply. With our own routines its captions are counted and its heuristics matched
    /// too; HOMER's schedules say themselves how much there is to see, and who is last.
    Paper,
    /// Drawn around the same proportions, which vary from home to home.
    Drawn,
}

/// How many owners things have that are not single users': the shares of one owner, of some (two to all but one)
/// and of everybody.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OwnerSetSizes {
    /// Of what is temporarily shared.
    pub(super) temporary_sharing: [f64; 3],
    /// Of what several people use.
    pub(super) multi_user_sharing: [f64; 3],
}

impl OwnerSetSizes {
    /// The proportions of the paper's data.
    const OF_THE_PAPER: Self =
        Self { temporary_sharing: [0.73, 0.07, 0.20], multi_user_sharing: [0.11, 0.22, 0.67] };
    /// Where more people live, things belong to some of them more often.
    const OF_MANY: Self =
        Self { temporary_sharing: [0.55, 0.30, 0.15], multi_user_sharing: [0.10, 0.50, 0.40] };

    /// So far from the paper's proportions to those of many people, 0 to 1.
    pub(super) fn at(sharing_in_groups: f64) -> Self {
        let between = |paper: [f64; 3], many: [f64; 3]| {
            std::array::from_fn(|size| {
                paper[size] * (1.0 - sharing_in_groups) + many[size] * sharing_in_groups
            })
        };
        let (paper, many) = (Self::OF_THE_PAPER, Self::OF_MANY);
        Self {
            temporary_sharing: between(paper.temporary_sharing, many.temporary_sharing),
            multi_user_sharing: between(paper.multi_user_sharing, many.multi_user_sharing),
        }
    }
}

/// The first day of the history.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstDay {
    /// This day.
    Fixed {
        /// The year.
        year: i16,
        /// The month, 1 to 12.
        month: i8,
        /// The day of the month, from 1.
        day: i8,
    },
    /// Some day of 2025.
    Drawn,
}

/// All that tells one kind of home from another. Ranges are drawn from evenly: `borrow` for every thing, the
/// others once for every home, so that homes of one kind differ in their habits.
#[derive(Debug, Clone, PartialEq)]
pub struct RoutineParameters {
    /// Who shares the place.
    pub people: PeopleTemplate,
    /// How usage types and owner sets come about.
    pub structure: Structure,
    /// How far things that several people use are some people's rather than one's or everybody's, 0 (as in the
    /// paper's data) to 1 (as where many people live).
    pub sharing_in_groups: Range<f64>,
    /// How many things there are.
    pub things: RangeInclusive<usize>,
    /// How many days were watched.
    pub days: u8,
    /// The first of them.
    pub first_day: FirstDay,
    /// The fewest and the most sessions of one thing.
    pub sessions: RangeInclusive<usize>,
    /// How much busier than the catalogue's figures the home is.
    pub busyness: Range<f64>,
    /// The probability that a session of a temporarily shared thing is a borrower's: p_borrow of the paper.
    pub borrow: Range<f64>,
    /// The share of the things of one owner that somebody else owned until about half way through the history.
    pub handed_down: f64,
    /// How far things belong to those whom they suit, 0 (not at all) to 1 (to nobody else).
    pub role_fit: Range<f64>,
    /// The probability that a thing of one owner lies in that person's own spot.
    pub cohesion: Range<f64>,
    /// The share of the sightings that name the wrong person.
    pub mistaken: f64,
    /// The share of what is done that is not seen.
    pub missed: f64,
    /// The share of the sightings that name nobody.
    pub unattributed: f64,
    /// The share of the captions in other words than the plain ones.
    pub paraphrased: f64,
}

impl RoutineParameters {
    /// An ordinary week of a family.
    fn week() -> Self {
        Self {
            people: PeopleTemplate::Family,
            structure: Structure::Drawn,
            sharing_in_groups: 0.0..0.0,
            things: 32..=36,
            days: 7,
            first_day: FirstDay::Drawn,
            sessions: 2..=60,
            busyness: 0.8..1.5,
            borrow: 0.1..0.3,
            handed_down: 0.0,
            role_fit: 0.0..0.9,
            cohesion: 0.45..0.75,
            mistaken: 0.0,
            missed: 0.0,
            unattributed: 0.0,
            paraphrased: 0.0,
        }
    }
}
