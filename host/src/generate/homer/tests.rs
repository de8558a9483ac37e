//! The HOMER generator on a small folder of our own in the same layout, and on the data set itself where it is at hand.

mod command;
pub(in crate::generate) mod made_up;
mod refusals;
mod sampling;

use std::collections::BTreeSet;
use std::io::Write;
use std::path::PathBuf;

use coin::captions::{Action, CaptionReader};
use coin::roster::Roster;
use coin_schemas::household::UsageType;
use rstest::rstest;

use super::script::Verb;
use super::*;
use crate::generate::tests::assert_that_users_are_who_they_may_be;
use crate::generate::wording::Scene;
use crate::generate::{
    GeneratedEpisode, Household, PeopleTemplate, Protocol, RoutineSettings, Routines, generate_homer,
    homer_story, people, write,
};

/// Where the data set is, if anywhere.
const DATA: &str = "COIN_HOMER_DATA";

/// The protocols of homes.
const HOMES: [Protocol; 10] = [
    Protocol::Paper,
    Protocol::Week,
    Protocol::Borrowing,
    Protocol::TwoDays,
    Protocol::Paraphrased,
    Protocol::OtherHomes,
    Protocol::Mistaken,
    Protocol::HandedDown,
    Protocol::Couple,
    Protocol::SharedHouse,
];

/// The data set itself. Where it is not at hand, whoever reads the tests' output is told so: past the test harness, which
/// keeps what a passing test prints.
fn homer(name: &str) -> Option<HomerData> {
    let folder = std::env::var_os(DATA).map(PathBuf::from);
    if folder.is_none() {
        let _ = writeln!(
            std::io::stderr(),
            "{name}: skipped for HOMER itself; {DATA} names no folder with its data"
        );
    }
    folder.map(|folder| HomerData::read(&folder).unwrap())
}

/// Checks something on the made-up data, and on HOMER itself where it is at hand.
fn both(name: &str, check: impl Fn(&HomerData)) {
    check(made_up::data());
    if let Some(data) = homer(name) {
        check(&data);
    }
}

fn home(data: &HomerData, protocol: Protocol, seed: u64) -> GeneratedEpisode {
    generate_homer(&RoutineSettings { seed, protocol }, data).unwrap()
}

#[test]
fn what_people_handle_is_a_thing_and_what_is_built_in_is_not() {
    let data = made_up::data();
    assert_eq!(data.personas.len(), 3);
    assert!(data.classes.contains_key("pot 7") && data.classes.contains_key("book"));
    assert!(data.classes.contains_key("radio"), "it is switched on");
    for built_in in ["table", "chair", "home office", "outside"] {
        assert!(!data.classes.contains_key(built_in), "{built_in}");
    }
    assert_eq!(data.classes["brush"].room.as_deref(), Some("bathroom"));
    assert_eq!(data.classes["pot 7"].room, None);
}

#[rstest]
fn equal_settings_give_equal_bytes_and_other_seeds_others(
    #[values(Protocol::Paper, Protocol::Week, Protocol::HandedDown)] protocol: Protocol,
) {
    let folder = tempfile::tempdir().unwrap();
    let written = |name: &str, data: &HomerData, seed| {
        let folder = folder.path().join(name);
        write(&home(data, protocol, seed), &folder).unwrap();
        ["episode.json", "captions.jsonl", "embeddings.npy", "truth.json"]
            .map(|file| std::fs::read(folder.join(file)).unwrap())
    };
    // Read from two folders, so that nothing of a path gets into a home.
    let again = HomerData::read(made_up::folder().path()).unwrap();
    let (first, same) = (written("first", made_up::data(), 3), written("same", &again, 3));
    assert!(first == same);
    for (one, other) in first.iter().zip(&written("other", &again, 4)) {
        assert_ne!(one, other);
    }
}

/// Section 8 of the method note: 34 things, 55 ownerships.
fn assert_has_the_papers_structure(episode: &GeneratedEpisode) {
    assert_eq!(episode.episode.objects.len(), 34);
    let types = episode.truth.usage_type.as_ref().unwrap();
    let count = |usage_type, owners: usize| {
        let of_type = types.iter().filter(|(_, found)| **found == usage_type);
        of_type.filter(|(object, _)| episode.truth.owners[*object].len() == owners).count()
    };
    assert_eq!(count(UsageType::SingleUser, 1), 10);
    assert_eq!([1, 2, 3].map(|owners| count(UsageType::TemporarySharing, owners)), [11, 1, 3]);
    assert_eq!([1, 2, 3].map(|owners| count(UsageType::MultiUserSharing, owners)), [1, 2, 6]);
}

#[test]
fn homes_of_every_kind_are_whole() {
    both("homes of every kind", |data| {
        for protocol in HOMES {
            let parameters = protocol.parameters();
            let GeneratedEpisode { episode, captions, .. } = home(data, protocol, 1);
            assert!(parameters.things.contains(&episode.objects.len()), "{protocol:?}");
            let classes: BTreeSet<_> = episode.objects.iter().map(|object| &object.class).collect();
            assert_eq!(classes.len(), episode.objects.len(), "{protocol:?}");
            for object in &episode.objects {
                assert!(
                    captions.iter().any(|line| line.object_id == object.id),
                    "{protocol:?}: {}",
                    object.class
                );
            }
            for line in &captions {
                assert!(("06:00".."23:00").contains(&&line.caption[11..16]), "{}", line.caption);
            }
            assert!(episode.description.unwrap().contains("CC BY-NC-SA 4.0"), "{protocol:?}");
        }
    });
}

#[test]
fn the_papers_home_has_the_papers_owner_sets_and_about_its_captions() {
    for seed in 1..=5 {
        assert_has_the_papers_structure(&home(made_up::data(), Protocol::Paper, seed));
    }
    let Some(data) = homer("the volume of the paper's homes") else { return };
    let mut volumes: Vec<usize> = (1..=20)
        .map(|seed| {
            let home = home(&data, Protocol::Paper, seed);
            assert_has_the_papers_structure(&home);
            home.captions.len()
        })
        .collect();
    volumes.sort_unstable();
    println!(
        "captions of 20 homes: {} to {}, median {}",
        volumes[0],
        volumes[19],
        volumes[9].midpoint(volumes[10])
    );
    assert!(volumes[0] >= 3082 && volumes[19] <= 3768, "{volumes:?}");
}

/// The laws of users hold on HOMER's own homes; the made-up ones are checked beside our own routines.
#[rstest]
fn users_are_who_they_may_be(
    #[values(Protocol::Paper, Protocol::Week, Protocol::TwoDays, Protocol::OtherHomes)] protocol: Protocol,
) {
    let Some(data) = homer("single users and turns") else { return };
    for seed in 1..=4 {
        let settings = RoutineSettings { seed, protocol };
        let story = homer_story(&settings, &protocol.parameters(), &data).unwrap();
        assert_that_users_are_who_they_may_be(&story);
    }
}

/// What several people own is where the scene has it; what one person owns may be at a spot of theirs.
#[test]
fn shared_things_of_the_bathroom_are_there() {
    let mut found = 0;
    for seed in 1..=20 {
        let GeneratedEpisode { episode, truth, .. } = home(made_up::data(), Protocol::Week, seed);
        let shared = |id| truth.owners[id].len() > 1;
        for brush in
            episode.objects.iter().filter(|thing| thing.class.as_str() == "brush" && shared(&thing.id))
        {
            assert_eq!(brush.room.as_deref(), Some("bathroom"), "seed {seed}");
            found += 1;
        }
    }
    assert!(found >= 3, "{found} shared brushes in 20 homes");
}

/// No gap over 20 minutes within a session, none under it between two, and no caption left out of the long ones.
#[test]
fn sessions_are_whole() {
    both("sessions", |data| {
        let mut longest = 0;
        for protocol in [Protocol::Paper, Protocol::Week, Protocol::TwoDays, Protocol::SharedHouse] {
            for seed in 1..=4 {
                longest = longest.max(longest_whole_session(data, protocol, seed));
            }
        }
        assert!(longest >= 20, "{longest} captions in the longest session");
    });
}

/// Checks the sessions of one home and counts the captions of the longest.
fn longest_whole_session(data: &HomerData, protocol: Protocol, seed: u64) -> usize {
    let parameters = protocol.parameters();
    let household = Household::draw(&RoutineSettings { seed, protocol }, &parameters, Routines::Homer);
    let mut longest = 0;
    for history in life(data, &household).unwrap().histories {
        assert!(parameters.sessions.contains(&history.sessions.len()));
        assert_eq!(history.unplaced, 0);
        for session in &history.sessions {
            let mut gaps = session.steps.windows(2).map(|pair| pair[1].minute - pair[0].minute);
            assert!(gaps.all(|gap| gap <= 20), "{session:?}");
            longest = longest.max(session.steps.len());
        }
        for pair in history.sessions.windows(2) {
            let (last, first) = (pair[0].steps.last().unwrap(), pair[1].steps.first().unwrap());
            assert!(pair[0].day < pair[1].day || last.minute + 20 < first.minute, "{pair:?}");
        }
    }
    longest
}

/// The plain caption of a step with this verb, done by the first of the paper's family.
fn caption(verb: Verb) -> Option<String> {
    let facts = ClassFacts { room: None, verbs: BTreeSet::from([verb]) };
    let people = people::draw(PeopleTemplate::PaperFamily, &mut rand::SeedableRng::seed_from_u64(1));
    let thing = thing("washing machine", &facts);
    let scene =
        |action| Scene { people: &people, seen: Some(0), thing, display_name: "Washing Machine", action };
    verb.action().map(|action| scene(action).plain())
}

/// From HOMER's verb to the words of a caption and back to what they say was done.
#[rstest]
#[case(Verb::Close, "closes the Washing Machine", Action::Use)]
#[case(Verb::Drink, "drinks from the Washing Machine", Action::Use)]
#[case(Verb::Find, "looks for the Washing Machine", Action::Search)]
#[case(Verb::Grab, "takes the Washing Machine", Action::Take)]
#[case(Verb::Open, "opens the Washing Machine", Action::Use)]
#[case(Verb::PutBack, "puts the Washing Machine back", Action::Place)]
#[case(Verb::PutIn, "puts the Washing Machine away", Action::Place)]
#[case(Verb::PutObjBack, "puts the Washing Machine back", Action::Place)]
#[case(Verb::Read, "reads the Washing Machine", Action::Use)]
#[case(Verb::SwitchOff, "turns off the Washing Machine", Action::Use)]
#[case(Verb::SwitchOn, "turns on the Washing Machine", Action::Use)]
fn a_verb_is_read_as_what_it_is(#[case] verb: Verb, #[case] words: &str, #[case] action: Action) {
    let text = caption(verb).unwrap();
    assert_eq!(text, format!("Bob {words}"));
    let users = home(made_up::data(), Protocol::Paper, 1).episode.users;
    let roster = Roster::new(&users).unwrap();
    let read = CaptionReader::new(&roster).read(&format!("2025-01-13 07:00 {text}")).unwrap();
    assert_eq!(read.action, action);
    assert_eq!(read.actor.map(|user| roster.name(user).as_str()), Some("Bob"));
}

#[test]
fn verbs_that_handle_nothing_are_not_told() {
    let untold: Vec<&str> =
        Verb::ALL.into_iter().filter(|verb| caption(*verb).is_none()).map(Verb::name).collect();
    assert_eq!(untold, ["LOOKAT", "SIT", "STANDUP", "TURNTO", "WALK"]);
}

/// Every plain caption of a home is read as its user's and as what it says, whatever the class is called.
#[test]
fn captions_are_read_as_what_they_say() {
    both("captions", |data| {
        let mut phrases: BTreeSet<&str> = BTreeSet::new();
        for seed in 1..=10 {
            let home = home(data, Protocol::Week, seed);
            let roster = Roster::new(&home.episode.users).unwrap();
            let reader = CaptionReader::new(&roster);
            for line in &home.captions {
                let read = reader.read(&line.caption).unwrap();
                let (name, said) = line.caption[17..].split_once(' ').unwrap();
                let (phrase, expected) =
                    PHRASES.into_iter().find(|(phrase, _)| said.starts_with(phrase)).unwrap();
                assert_eq!(read.action, expected, "{}", line.caption);
                assert_eq!(read.actor.map(|user| roster.name(user).as_str()), Some(name), "{}", line.caption);
                phrases.insert(phrase);
            }
        }
        assert_eq!(phrases.len(), PHRASES.len(), "{phrases:?}");
    });
}

const PHRASES: [(&str, Action); 9] = [
    ("looks for the ", Action::Search),
    ("takes the ", Action::Take),
    ("puts the ", Action::Place),
    ("turns on the ", Action::Use),
    ("turns off the ", Action::Use),
    ("opens the ", Action::Use),
    ("closes the ", Action::Use),
    ("reads the ", Action::Use),
    ("drinks from the ", Action::Use),
];
