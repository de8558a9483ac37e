//! Who lives or works in the place: names, roles, occupations, and the habits that follow from them.

use rand::RngExt;
use rand::seq::{IndexedRandom, SliceRandom};
use rand_chacha::ChaCha8Rng;

use super::catalogue::{Activity, Suits};
use super::parameters::PeopleTemplate;

/// How a person's working days run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pattern {
    /// Away from morning to evening on weekdays.
    OfficeHours,
    /// Away from morning to afternoon on weekdays.
    School,
    /// At lectures for some hours on most weekdays.
    University,
    /// Early or late turns, weekends too at times.
    Shifts,
    /// At home, with errands.
    Home,
    /// Comes to the office, where the things are, for the working day.
    Desk,
}

/// How much of the housework a person does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Housework {
    None,
    Some,
    Most,
}

/// Where a person sleeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bedroom {
    /// The first bedroom, which a couple shares.
    Shared,
    /// A room of their own.
    Own,
}

/// A member of the household.
#[derive(Debug, Clone)]
pub(super) struct Person {
    pub(super) name: &'static str,
    pub(super) role: &'static str,
    pub(super) occupation: &'static str,
    pub(super) pattern: Pattern,
    pub(super) housework: Housework,
    pub(super) bedroom: Bedroom,
    pub(super) suits: Vec<Suits>,
    pub(super) hobbies: Vec<Activity>,
}

impl Person {
    /// Whether a class that suits such people suits this person.
    pub(super) fn is(&self, suits: Suits) -> bool {
        suits == Suits::Anyone || self.suits.contains(&suits)
    }

    /// Whether the person is a child.
    pub(super) fn is_child(&self) -> bool {
        self.suits.contains(&Suits::Child)
    }
}

/// Which of the two lists a name comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Gender {
    Man,
    Woman,
}

const MEN: &[&str] = &[
    "Adam", "Anton", "Ben", "Carlos", "Daniel", "David", "Erik", "Felix", "George", "Hugo", "Ivan", "James",
    "Kenji", "Leo", "Marco", "Noah", "Omar", "Paul", "Rafael", "Samuel", "Theo", "Victor", "Yusuf",
];
const WOMEN: &[&str] = &[
    "Aiko", "Alice", "Anna", "Beatrice", "Clara", "Diana", "Elena", "Emma", "Fatima", "Hannah", "Ines",
    "Julia", "Karin", "Laura", "Maria", "Mei", "Nora", "Olga", "Priya", "Sofia", "Teresa", "Wanda", "Zoe",
];

/// Occupations of grown-ups with the days that they make.
const ADULT_OCCUPATIONS: &[(&str, Pattern)] = &[
    ("office worker", Pattern::OfficeHours),
    ("teacher", Pattern::OfficeHours),
    ("carpenter", Pattern::OfficeHours),
    ("accountant", Pattern::OfficeHours),
    ("nurse", Pattern::Shifts),
    ("shop assistant", Pattern::Shifts),
    ("homemaker", Pattern::Home),
    ("software engineer", Pattern::Home),
    ("writer", Pattern::Home),
];
const CHILD_OCCUPATIONS: &[(&str, Pattern)] = &[
    ("elementary school student", Pattern::School),
    ("middle school student", Pattern::School),
    ("high school student", Pattern::School),
    ("kindergarten child", Pattern::School),
];
const FLATMATE_OCCUPATIONS: &[(&str, Pattern)] = &[
    ("university student", Pattern::University),
    ("nurse", Pattern::Shifts),
    ("barista", Pattern::Shifts),
    ("engineer", Pattern::OfficeHours),
    ("designer", Pattern::Home),
    ("lab assistant", Pattern::OfficeHours),
    ("music student", Pattern::University),
];
const OFFICE_POSTS: &[(&str, &str)] = &[
    ("team lead", "project manager"),
    ("developer", "software engineer"),
    ("designer", "graphic designer"),
    ("bookkeeper", "accountant"),
    ("office manager", "administrator"),
    ("analyst", "data analyst"),
    ("apprentice", "trainee"),
];

/// The make-ups of families: roles, with the gender that picks the name.
const FAMILIES: &[&[(&str, Gender)]] = &[
    &[("father", Gender::Man), ("mother", Gender::Woman)],
    &[("mother", Gender::Woman), ("daughter", Gender::Woman)],
    &[("father", Gender::Man), ("son", Gender::Man)],
    &[("father", Gender::Man), ("mother", Gender::Woman), ("son", Gender::Man)],
    &[("father", Gender::Man), ("mother", Gender::Woman), ("daughter", Gender::Woman)],
    &[("mother", Gender::Woman), ("son", Gender::Man), ("daughter", Gender::Woman)],
    &[("grandmother", Gender::Woman), ("mother", Gender::Woman), ("son", Gender::Man)],
    &[("father", Gender::Man), ("mother", Gender::Woman), ("son", Gender::Man), ("daughter", Gender::Woman)],
    &[("father", Gender::Man), ("mother", Gender::Woman), ("son", Gender::Man), ("son", Gender::Man)],
    &[
        ("father", Gender::Man),
        ("mother", Gender::Woman),
        ("daughter", Gender::Woman),
        ("grandfather", Gender::Man),
    ],
];
const COUPLES: &[&[(&str, Gender)]] = &[
    &[("husband", Gender::Man), ("wife", Gender::Woman)],
    &[("partner", Gender::Woman), ("partner", Gender::Woman)],
    &[("partner", Gender::Man), ("partner", Gender::Woman)],
];

const HOBBIES: &[Activity] = &[
    Activity::Reading,
    Activity::Television,
    Activity::Computer,
    Activity::Play,
    Activity::Music,
    Activity::Exercise,
    Activity::Garden,
];

/// Draws the people of a home, in the order of their names.
pub(super) fn draw(template: PeopleTemplate, generator: &mut ChaCha8Rng) -> Vec<Person> {
    let mut people = match template {
        PeopleTemplate::PaperFamily => paper_family(),
        PeopleTemplate::Family => relatives(FAMILIES, generator),
        PeopleTemplate::Office { people } => colleagues(people, generator),
        PeopleTemplate::Couple => relatives(COUPLES, generator),
        PeopleTemplate::Flat { most } => {
            let people = generator.random_range(4..=most);
            flatmates(people, generator)
        }
        PeopleTemplate::CoupleOrFlat { most } => {
            if generator.random_bool(0.4) {
                relatives(COUPLES, generator)
            } else {
                let people = generator.random_range(4..=most);
                flatmates(people, generator)
            }
        }
    };
    people.sort_by_key(|person| person.name);
    people
}

/// The paper's family (Section 5.1).
fn paper_family() -> Vec<Person> {
    vec![
        Person {
            name: "Bob",
            role: "father",
            occupation: "office worker",
            pattern: Pattern::OfficeHours,
            housework: Housework::Some,
            bedroom: Bedroom::Shared,
            suits: vec![Suits::Adult, Suits::Man, Suits::Clerk],
            hobbies: vec![Activity::Computer, Activity::Television, Activity::Exercise],
        },
        Person {
            name: "Mary",
            role: "mother",
            occupation: "homemaker",
            pattern: Pattern::Home,
            housework: Housework::Most,
            bedroom: Bedroom::Shared,
            suits: vec![Suits::Adult, Suits::Woman, Suits::Homemaker],
            hobbies: vec![Activity::Reading, Activity::Garden, Activity::Music],
        },
        Person {
            name: "Tom",
            role: "son",
            occupation: "elementary school student",
            pattern: Pattern::School,
            housework: Housework::None,
            bedroom: Bedroom::Own,
            suits: vec![Suits::Child, Suits::Man, Suits::Student],
            hobbies: vec![Activity::Play, Activity::Television, Activity::Reading],
        },
    ]
}

/// Names that nobody has yet, one by one.
struct Names {
    men: Vec<&'static str>,
    women: Vec<&'static str>,
}

impl Names {
    fn new(generator: &mut ChaCha8Rng) -> Self {
        let (mut men, mut women) = (MEN.to_vec(), WOMEN.to_vec());
        men.shuffle(generator);
        women.shuffle(generator);
        Self { men, women }
    }

    fn next(&mut self, gender: Gender) -> &'static str {
        match gender {
            Gender::Man => self.men.pop().unwrap_or("Alexander"),
            Gender::Woman => self.women.pop().unwrap_or("Alexandra"),
        }
    }
}

fn relatives(compositions: &[&[(&'static str, Gender)]], generator: &mut ChaCha8Rng) -> Vec<Person> {
    let mut names = Names::new(generator);
    let Some(composition) = compositions.choose(generator) else { return Vec::new() };
    composition
        .iter()
        .map(|&(role, gender)| {
            let child = matches!(role, "son" | "daughter");
            let elder = role.starts_with("grand");
            let (occupation, pattern) = if elder {
                ("retired", Pattern::Home)
            } else {
                drawn(if child { CHILD_OCCUPATIONS } else { ADULT_OCCUPATIONS }, generator)
            };
            let mut suits = vec![if child { Suits::Child } else { Suits::Adult }];
            suits.push(if gender == Gender::Man { Suits::Man } else { Suits::Woman });
            suits.extend(occupation_suits(occupation));
            Person {
                name: names.next(gender),
                role,
                occupation,
                pattern,
                housework: match (child, occupation) {
                    (true, _) => Housework::None,
                    (false, "homemaker" | "retired") => Housework::Most,
                    (false, _) => Housework::Some,
                },
                bedroom: if child || elder { Bedroom::Own } else { Bedroom::Shared },
                suits,
                hobbies: hobbies(generator),
            }
        })
        .collect()
}

fn flatmates(people: usize, generator: &mut ChaCha8Rng) -> Vec<Person> {
    let mut names = Names::new(generator);
    (0..people)
        .map(|_| {
            let gender = if generator.random_bool(0.5) { Gender::Man } else { Gender::Woman };
            let (occupation, pattern) = drawn(FLATMATE_OCCUPATIONS, generator);
            let mut suits = vec![Suits::Adult, if gender == Gender::Man { Suits::Man } else { Suits::Woman }];
            suits.extend(occupation_suits(occupation));
            Person {
                name: names.next(gender),
                role: "flatmate",
                occupation,
                pattern,
                housework: Housework::Some,
                bedroom: Bedroom::Own,
                suits,
                hobbies: hobbies(generator),
            }
        })
        .collect()
}

fn colleagues(people: usize, generator: &mut ChaCha8Rng) -> Vec<Person> {
    let mut names = Names::new(generator);
    let mut posts = OFFICE_POSTS.to_vec();
    posts.shuffle(generator);
    posts
        .into_iter()
        .take(people)
        .map(|(role, occupation)| {
            let gender = if generator.random_bool(0.5) { Gender::Man } else { Gender::Woman };
            let mut suits = vec![Suits::Adult, if gender == Gender::Man { Suits::Man } else { Suits::Woman }];
            if matches!(occupation, "accountant" | "administrator" | "project manager" | "data analyst") {
                suits.push(Suits::Clerk);
            }
            Person {
                name: names.next(gender),
                role,
                occupation,
                pattern: Pattern::Desk,
                housework: Housework::None,
                bedroom: Bedroom::Own,
                suits,
                hobbies: Vec::new(),
            }
        })
        .collect()
}

fn drawn(occupations: &[(&'static str, Pattern)], generator: &mut ChaCha8Rng) -> (&'static str, Pattern) {
    occupations.choose(generator).copied().unwrap_or(("at home", Pattern::Home))
}

fn occupation_suits(occupation: &str) -> Option<Suits> {
    match occupation {
        "homemaker" | "retired" => Some(Suits::Homemaker),
        "office worker" | "accountant" | "software engineer" | "writer" | "engineer" | "designer"
        | "teacher" => Some(Suits::Clerk),
        other if other.ends_with("student") => Some(Suits::Student),
        _ => None,
    }
}

fn hobbies(generator: &mut ChaCha8Rng) -> Vec<Activity> {
    HOBBIES.sample(generator, 3).copied().collect()
}
