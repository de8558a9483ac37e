use std::collections::{BTreeMap, BTreeSet};

use coin_schemas::household::{Background, ClassLabel, Owners, Position, UsageType};
use coin_schemas::model::TaskObject;
use rstest::rstest;

use super::*;

fn household(people: &[(&str, &str)]) -> Users {
    people
        .iter()
        .map(|(name, role)| {
            let role = (!role.is_empty()).then(|| (*role).to_owned());
            (UserName::new(*name).unwrap(), Background { role, occupation: None })
        })
        .collect()
}

fn family() -> Users {
    household(&[("Bob", "father"), ("Mary", "mother"), ("Tom", "son")])
}

fn owners(names: &str) -> Owners {
    names.split_whitespace().map(|name| UserName::new(name).unwrap()).collect()
}

fn truth(of: &[(&str, &str)]) -> Truth {
    let owners = of.iter().map(|(id, names)| (ObjectId::new(*id).unwrap(), owners(names))).collect();
    Truth { owners, usage_type: None }
}

async fn ask(person: &mut SimulatedPerson, id: &str, times_asked: u32) -> (String, String) {
    let object = TaskObject {
        id: ObjectId::new(id).unwrap(),
        class: ClassLabel::new("pencil").unwrap(),
        position: Position::new([0.0; 3]).unwrap(),
        room: None,
    };
    let question = PutQuestion {
        step: 1,
        object: &object,
        also: &[],
        question: "Whose?",
        candidates: &[],
        times_asked,
        before: None,
        remaining: None,
    };
    match person.ask(&question).await.unwrap() {
        Response::Said { answer, answered_by } => (answer, answered_by.unwrap().to_string()),
        other => panic!("{other:?}"),
    }
}

const HOME: [(&str, &str); 4] = [("1", "Tom"), ("2", "Bob Mary"), ("3", "Bob Mary Tom"), ("4", "")];

#[tokio::test]
async fn the_same_seed_says_the_same_in_any_order_of_questions() {
    let mut forwards = SimulatedPerson::new(truth(&HOME), family(), 7);
    let mut backwards = forwards.clone();
    let mut first = BTreeMap::new();
    for (id, _) in HOME {
        first.insert(id, ask(&mut forwards, id, 0).await);
    }
    let mut second = BTreeMap::new();
    for (id, _) in HOME.iter().rev() {
        ask(&mut backwards, id, 1).await;
        second.insert(*id, ask(&mut backwards, id, 0).await);
    }
    assert_eq!(first, second);
    assert_eq!(forwards.kind().as_str(), "simulated");
}

/// The words of one seed, once and for all: a report of today must be made again tomorrow.
#[tokio::test]
async fn the_words_of_a_seed_stay() {
    let mut person = SimulatedPerson::new(truth(&HOME), family(), 1);
    let mut said = Vec::new();
    for (id, _) in HOME {
        said.push(ask(&mut person, id, 0).await);
    }
    insta::assert_debug_snapshot!(said);
}

#[tokio::test]
async fn seeds_things_and_repetitions_vary_the_words() {
    let mut of_seeds = BTreeSet::new();
    for seed in 0..50 {
        let mut person = SimulatedPerson::new(truth(&HOME), family(), seed);
        of_seeds.insert(ask(&mut person, "1", 0).await);
    }
    assert!(of_seeds.len() > 15, "{of_seeds:?}");

    let ids: Vec<String> = (0..50).map(|id| id.to_string()).collect();
    let toms: Vec<(&str, &str)> = ids.iter().map(|id| (id.as_str(), "Tom")).collect();
    let mut person = SimulatedPerson::new(truth(&toms), family(), 0);
    let mut of_things = BTreeSet::new();
    for id in &ids {
        of_things.insert(ask(&mut person, id, 0).await);
    }
    assert!(of_things.len() > 15, "{of_things:?}");
}

#[tokio::test]
async fn another_member_answers_when_a_thing_is_asked_about_again() {
    for seed in 0..20 {
        let mut person = SimulatedPerson::new(truth(&HOME), family(), seed);
        let mut speakers = BTreeSet::new();
        for times_asked in 0..3 {
            speakers.insert(ask(&mut person, "1", times_asked).await.1);
        }
        assert_eq!(speakers.len(), 3, "seed {seed}");
    }
}

#[tokio::test]
async fn nobody_knows_what_the_truth_does_not_mention() {
    let mut person = SimulatedPerson::new(truth(&HOME), family(), 3);
    let (answer, _) = ask(&mut person, "99", 0).await;
    assert!(
        ["I don't know whose that is.", "No idea, sorry.", "I'm not sure whose it is."]
            .contains(&answer.as_str())
    );
}

fn wordings(users: &Users, names: &str, usage_type: Option<UsageType>, speaker: &str) -> Vec<String> {
    let owners = owners(names);
    let speaker = users.get_key_value(speaker).map(|(name, _)| name);
    answers(&Facts { users, owners: Some(&owners), usage_type, speaker })
}

#[rstest]
#[case(Some(UsageType::SingleUser), "nobody else", true)]
#[case(Some(UsageType::SingleUser), "borrow", false)]
#[case(Some(UsageType::TemporarySharing), "borrow", true)]
#[case(Some(UsageType::TemporarySharing), "nobody else", false)]
#[case(None, "borrow", false)]
#[case(None, "nobody else", false)]
fn of_use_only_what_is_known_is_said(
    #[case] usage_type: Option<UsageType>,
    #[case] words: &str,
    #[case] said: bool,
    #[values("Tom", "Mary")] speaker: &str,
) {
    let wordings = wordings(&family(), "Tom", usage_type, speaker);
    assert_eq!(wordings.iter().any(|wording| wording.contains(words)), said, "{wordings:#?}");
}

#[test]
fn a_role_is_named_only_where_one_person_has_it() {
    let flat = household(&[("Ann", "flatmate"), ("Ben", "Flatmate"), ("Cem", "landlord"), ("Dan", "<b>")]);
    let names_the = |owner: &str, role: &str| {
        wordings(&flat, owner, None, if owner == "Ben" { "Ann" } else { "Ben" })
            .contains(&format!("It's the {role}'s."))
    };
    assert!(names_the("Cem", "landlord"));
    assert!(!names_the("Ann", "flatmate"));
    assert!(!names_the("Dan", "<b>"));
}

#[test]
fn speakers_say_mine_of_what_is_theirs_and_never_of_anything_else() {
    let users = family();
    let first_person = |wording: &str| {
        wording
            .replace("Not mine", "")
            .replace("I think", "")
            .to_lowercase()
            .split(|letter: char| !letter.is_alphanumeric())
            .any(|word| ["mine", "me", "i", "we", "us", "ours"].contains(&word))
    };
    assert!(wordings(&users, "Tom", None, "Tom").iter().all(|wording| first_person(wording)));
    assert!(!wordings(&users, "Tom", None, "Bob").iter().any(|wording| first_person(wording)));
    assert!(wordings(&users, "Bob Tom", None, "Tom").iter().all(|wording| first_person(wording)));
    assert!(!wordings(&users, "Bob Tom", None, "Mary").iter().any(|wording| first_person(wording)));
}
