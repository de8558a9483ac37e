//! The wordings of a true answer.

use coin_schemas::household::{Background, Owners, UsageType, UserName, Users};

/// From this many owners on they are not listed by name where "all of us" says the same.
const LONG_LIST: usize = 5;

/// What the speaker knows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facts<'a> {
    /// Who lives there.
    pub(super) users: &'a Users,
    /// The true owners: nobody of the household where empty, not known where `None`.
    pub(super) owners: Option<&'a Owners>,
    /// How the thing is used, where known.
    pub(super) usage_type: Option<UsageType>,
    /// The member who speaks.
    pub(super) speaker: Option<&'a UserName>,
}

/// Every true answer that the speaker could give, never none.
pub(super) fn answers(facts: &Facts<'_>) -> Vec<String> {
    let Some(owners) = facts.owners else {
        return owned(&["I don't know whose that is.", "No idea, sorry.", "I'm not sure whose it is."]);
    };
    let speaker_owns = facts.speaker.is_some_and(|speaker| owners.contains(speaker));
    let others: Vec<&UserName> = facts.users.keys().filter(|user| !owners.contains(*user)).collect();
    let owners: Vec<&UserName> = owners.iter().collect();
    match owners.as_slice() {
        [] => nobodys(),
        [_] if speaker_owns => mine(facts, &others),
        [owner] => somebodys(facts, owner, &others),
        all if others.is_empty() => everybodys(facts, all),
        several => {
            let several = Named::new(several, facts.speaker);
            shared_by_some(&several, &except_speaker(&others, facts.speaker))
        }
    }
}

/// What is said of several things that are not all the same people's.
pub(super) const NOT_THE_SAME: &str = "No, they are not all the same people's.";

/// Every true answer about several things of the same owners, never none.
pub(super) fn answers_for_all(facts: &Facts<'_>) -> Vec<String> {
    let Some(owners) = facts.owners else { return owned(&["I don't know whose they are."]) };
    let everybody = owners.len() > 1 && owners.len() == facts.users.len();
    let owners: Vec<&UserName> = owners.iter().collect();
    match owners.as_slice() {
        [] => owned(&["They belong to a neighbour."]),
        [owner] if facts.speaker == Some(*owner) => owned(&["They are mine.", "They belong to me."]),
        [owner] => vec![format!("They are {owner}'s."), format!("They belong to {owner}.")],
        _ if everybody => owned(&["We share them.", "They are ours."]),
        several => {
            let Named { subject, object, .. } = Named::new(several, facts.speaker);
            vec![format!("{subject} share them."), format!("They belong to {object}.")]
        }
    }
}

fn nobodys() -> Vec<String> {
    owned(&[
        "It belongs to a neighbour.",
        "It isn't ours; it belongs to a neighbour.",
        "None of us owns it; it's a neighbour's.",
        "It's not ours. It's a neighbour's.",
        "It doesn't belong to any of us.",
    ])
}

fn mine(facts: &Facts<'_>, others: &[&UserName]) -> Vec<String> {
    let mut answers = owned(&[
        "Mine.",
        "It's mine.",
        "That one is mine.",
        "That's mine.",
        "It belongs to me.",
        "Oh, that one belongs to me.",
    ]);
    for other in others {
        answers.push(format!("Not {other}'s; it's mine."));
        answers.push(format!("It isn't {other}'s, it's mine."));
    }
    match facts.usage_type {
        Some(UsageType::SingleUser) => {
            answers.extend(owned(&["It's mine alone.", "Mine; nobody else uses it."]));
        }
        Some(UsageType::TemporarySharing) => {
            answers
                .extend(owned(&["It's mine; the others only borrow it.", "Mine — others just borrow it."]));
        }
        Some(UsageType::MultiUserSharing) | None => {}
    }
    answers
}

fn somebodys(facts: &Facts<'_>, owner: &UserName, others: &[&UserName]) -> Vec<String> {
    let mut answers = vec![
        format!("It's {owner}'s."),
        format!("That one is {owner}'s."),
        format!("That's {owner}'s."),
        format!("It belongs to {owner}."),
        format!("{owner} owns it."),
        format!("Oh, that one belongs to {owner}."),
        format!("{owner} is the owner."),
        format!("I think it's {owner}'s."),
        format!("Not mine; it's {owner}'s."),
    ];
    for other in except_speaker(others, facts.speaker) {
        answers.push(format!("Not {other}'s; it's {owner}'s."));
        answers.push(format!("It isn't {other}'s, it's {owner}'s."));
        answers.push(format!("It's {owner}'s, not {other}'s."));
    }
    if let Some(role) = unique_role(facts.users, owner) {
        answers.push(format!("It's the {role}'s."));
        answers.push(format!("That one belongs to the {role}."));
    }
    match facts.usage_type {
        Some(UsageType::SingleUser) => {
            answers.push(format!("It's {owner}'s alone."));
            answers.push(format!("{owner}'s; nobody else uses it."));
        }
        Some(UsageType::TemporarySharing) => {
            answers.push(format!("{owner}'s — the others only borrow it."));
            answers.push(format!("It's {owner}'s; others just borrow it now and then."));
        }
        Some(UsageType::MultiUserSharing) | None => {}
    }
    answers
}

fn everybodys(facts: &Facts<'_>, owners: &[&UserName]) -> Vec<String> {
    let mut answers = match owners {
        [_, _] => owned(&["It's ours.", "It belongs to both of us.", "We share it.", "We both own it."]),
        _ => owned(&[
            "We all share it.",
            "It's everybody's.",
            "Everyone's.",
            "It belongs to all of us.",
            "It's ours, we all use it.",
            "All of us own it together.",
        ]),
    };
    if owners.len() < LONG_LIST {
        let named = Named::new(owners, facts.speaker);
        answers.push(format!("{} together.", named.subject));
        answers.push(format!("{} share it.", named.subject));
    }
    answers
}

fn shared_by_some(owners: &Named, others: &[&UserName]) -> Vec<String> {
    let Named { subject, object, possessive } = owners;
    let mut answers = vec![
        format!("It belongs to {object}."),
        format!("{subject} share it."),
        format!("{subject} own it together."),
        format!("{subject} together."),
        format!("It's {possessive}."),
        format!("That one is shared by {object}."),
    ];
    for other in others {
        answers.push(format!("Not {other}'s; it belongs to {object}."));
        answers.push(format!("{subject} share it, but it's not {other}'s."));
    }
    answers
}

/// Several owners in the three forms that a sentence needs; the speaker comes last and in the first person.
struct Named {
    subject: String,
    object: String,
    possessive: String,
}

impl Named {
    fn new(owners: &[&UserName], speaker: Option<&UserName>) -> Self {
        let speaks = owners.iter().any(|owner| Some(*owner) == speaker);
        let names: Vec<String> = except_speaker(owners, speaker).iter().map(ToString::to_string).collect();
        let with = |first_person: &str, names: &[String]| {
            let mut names = names.to_vec();
            if speaks {
                names.push(first_person.to_owned());
            }
            enumerate(&names)
        };
        let possessives: Vec<String> = names.iter().map(|name| format!("{name}'s")).collect();
        Self {
            subject: with("I", &names),
            object: with("me", &names),
            possessive: with("mine", &possessives),
        }
    }
}

/// `a`, `a and b`, `a, b and c`.
fn enumerate(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [name] => name.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn except_speaker<'a>(names: &[&'a UserName], speaker: Option<&UserName>) -> Vec<&'a UserName> {
    names.iter().copied().filter(|name| Some(*name) != speaker).collect()
}

/// The role of the owner, where nobody else has it and it reads well behind "the".
fn unique_role<'a>(users: &'a Users, owner: &UserName) -> Option<&'a str> {
    let role_of = |background: &'a Background| background.role.as_deref().map(str::trim);
    let role = role_of(users.get(owner)?)?;
    let reads_well = !role.is_empty()
        && role.chars().all(|letter| letter.is_alphabetic() || letter == ' ' || letter == '-');
    let taken = users.iter().any(|(user, background)| {
        user.as_str().eq_ignore_ascii_case(role)
            || (user != owner && role_of(background).is_some_and(|other| other.eq_ignore_ascii_case(role)))
    });
    (reads_well && !taken).then_some(role)
}

fn owned(sentences: &[&str]) -> Vec<String> {
    sentences.iter().map(|sentence| (*sentence).to_owned()).collect()
}
