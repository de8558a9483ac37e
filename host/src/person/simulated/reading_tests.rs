//! Every wording says exactly the truth: the reader that needs no model gets it back from each of them.

use std::collections::BTreeSet;

use coin::dialogue::{as_of_one_thing, read_answer};
use coin::roster::Roster;
use coin_schemas::household::{Background, Owners, UsageType, UserName, Users};
use rstest::rstest;

use super::phrases::{Facts, NOT_THE_SAME, answers, answers_for_all};

const QUESTIONS: [&str; 7] = [
    "Whose is the pencil on the desk?",
    "Who owns the drinking glass in the kitchen?",
    "Is this Tom's mug?",
    "Does the book belong to Bob or to Mary?",
    "Is the kettle yours, or do you all share it?",
    "Whose is it, Mary's or Tom's, or somebody else's?",
    "",
];

const USAGE_TYPES: [Option<UsageType>; 4] =
    [None, Some(UsageType::SingleUser), Some(UsageType::TemporarySharing), Some(UsageType::MultiUserSharing)];

fn household(people: &str) -> Users {
    people
        .split(", ")
        .map(|person| {
            let (name, role) = person.split_once(" as ").unwrap_or((person, ""));
            let role = (!role.is_empty()).then(|| role.to_owned());
            (UserName::new(name).unwrap(), Background { role, occupation: None })
        })
        .collect()
}

/// All sets of members, the empty one among them; of many members those of up to two and of all but one.
fn owner_sets(users: &Users) -> Vec<Owners> {
    let names: Vec<&UserName> = users.keys().collect();
    (0..1u32 << names.len())
        .filter(|bits| {
            let size = bits.count_ones() as usize;
            names.len() < 5 || size <= 2 || size + 1 >= names.len()
        })
        .map(|bits| {
            let chosen = names.iter().enumerate().filter(|(place, _)| bits >> place & 1 == 1);
            chosen.map(|(_, name)| (*name).clone()).collect()
        })
        .collect()
}

#[rstest]
#[case::alone("Ann as engineer")]
#[case::couple("Bob as husband, Mary as wife")]
#[case::family("Bob as father, Mary as mother, Tom as son")]
#[case::two_children("Bob as father, Mary as mother, Tom as elder son, Tim as younger son")]
#[case::flatmates("Ann as flatmate, James as flatmate, Li, Zoë as landlady")]
#[case::two_words("Mary Ann, Jean-Luc, O'Brien")]
#[case::office("Aya as professor, Ben as secretary, Chris as student, Dana as student, Eun-ji as student")]
fn every_wording_is_read_back_as_the_truth(#[case] people: &str) {
    let users = household(people);
    let roster = Roster::new(&users).unwrap();
    let mut checked = 0;
    let mut misread = Vec::new();
    for owners in owner_sets(&users) {
        let truth = roster.owner_set(&owners).unwrap();
        for speaker in users.keys().step_by(if users.len() < 4 { 1 } else { 3 }) {
            let answered_by = Some(roster.index_of(speaker.as_str()).unwrap());
            let facts = |usage_type| Facts {
                users: &users,
                owners: Some(&owners),
                usage_type,
                speaker: Some(speaker),
            };
            let of_one = USAGE_TYPES.into_iter().flat_map(|usage_type| answers(&facts(usage_type)));
            let of_all = answers_for_all(&facts(None)).into_iter().map(|answer| as_of_one_thing(&answer));
            let wordings = of_one.chain(of_all);
            for answer in wordings.collect::<BTreeSet<String>>() {
                for question in QUESTIONS {
                    checked += 1;
                    let reading = read_answer(&roster, question, &answer, answered_by);
                    if reading.owners != truth || reading.outside_household != truth.is_empty() {
                        misread.push(format!(
                            "{speaker}: {answer:?} to {question:?} is {:?}{}, not {owners:?}",
                            roster.owners(reading.owners),
                            if reading.outside_household { " and an outsider" } else { "" },
                        ));
                    }
                }
            }
        }
    }
    assert!(misread.is_empty(), "{} of {checked}:\n{}", misread.len(), misread.join("\n"));
    assert!(checked >= 10 * QUESTIONS.len(), "{checked}");
}

#[test]
fn what_nobody_knows_is_read_as_open() {
    let users = household("Bob as father, Mary as mother, Tom as son");
    let roster = Roster::new(&users).unwrap();
    for speaker in users.keys() {
        let facts = Facts { users: &users, owners: None, usage_type: None, speaker: Some(speaker) };
        let answered_by = Some(roster.index_of(speaker.as_str()).unwrap());
        for answer in
            answers(&facts).into_iter().chain(answers_for_all(&facts)).chain([NOT_THE_SAME.to_owned()])
        {
            for question in QUESTIONS {
                let reading = read_answer(&roster, question, &answer, answered_by);
                assert!(reading.is_unresolved(), "{answer:?} to {question:?} is {reading:?}");
            }
        }
    }
}
