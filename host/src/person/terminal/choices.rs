//! What is offered to a person who types, and what a typed line picks.

use coin_schemas::household::UserName;

use crate::person::Candidate;

/// How many people are offered as numbered choices at first; the others can be named.
pub(super) const MOST_NUMBERED: usize = 9;

/// Words that stand for every member.
const EVERYBODY: [&str; 3] = ["e", "everybody", "everyone"];
/// Words that stand for every member where there are two.
const BOTH: &str = "both";
/// Words that stand for somebody who is not among the offered people.
const SOMEBODY_ELSE: [&str; 3] = ["o", "somebody else", "someone else"];
/// What stands between the picked.
const AND: &str = "and";
/// Words by which the person says not to know.
const UNSURE: [&str; 7] = ["?", "i don't know", "i dont know", "don't know", "dont know", "dunno", "no idea"];
const SKIP: [&str; 1] = ["skip"];
const UNDO: [&str; 1] = ["undo"];
const STOP: [&str; 3] = ["stop", "quit", "exit"];
const HELP: [&str; 1] = ["help"];
/// Words by which speakers mean themselves, so that an answer needs a name beside it.
pub(super) const FIRST_PERSON: [&str; 4] = ["mine", "my", "me", "i"];

/// A line, as it was meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Typed {
    /// An empty line.
    Nothing,
    /// Some of the choices.
    Picked(Picked),
    /// The person does not know.
    Unsure,
    /// The question is passed over.
    Skip,
    /// The last answer is taken back.
    Undo,
    /// The person goes on another time.
    Stop,
    /// The person wants to know what can be typed.
    Help,
    /// A number that stands for nobody.
    OutOfRange,
    /// A name that means several people, because theirs differ in capitals only.
    Ambiguous(Vec<UserName>),
    /// A single character or a sign that means nothing.
    Meaningless,
    /// Anything else: the speaker's own words.
    OwnWords,
}

/// Choices that were picked together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Picked {
    /// Members of the household, each once.
    pub(super) members: Vec<UserName>,
    /// Whether there is somebody besides them.
    pub(super) besides: Besides,
}

/// Who else was picked, besides members by number or name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Besides {
    /// Nobody.
    Nobody,
    /// Somebody who is not among the offered people.
    SomebodyElse,
}

impl Picked {
    /// Adds the only one of these; where there are several, somebody has to say which.
    fn add(&mut self, found: Vec<UserName>) -> Option<Typed> {
        if found.len() > 1 {
            return Some(Typed::Ambiguous(found));
        }
        self.members.extend(found);
        None
    }

    /// What was picked before, and this as well. Who "somebody else" was is said by the later one.
    pub(super) fn after(self, before: Vec<UserName>) -> Self {
        let mut members = before;
        members.extend(self.members);
        Self { members: each_once(members), besides: self.besides }
    }
}

/// The members of the household as choices.
#[derive(Debug, Clone, Copy)]
pub(super) struct Choices<'a> {
    candidates: &'a [Candidate],
    numbered: usize,
}

impl<'a> Choices<'a> {
    /// The likeliest by number, all by name.
    pub(super) fn likeliest(candidates: &'a [Candidate]) -> Self {
        Self { candidates, numbered: candidates.len().min(MOST_NUMBERED) }
    }

    /// All by number and by name.
    pub(super) fn all(candidates: &'a [Candidate]) -> Self {
        Self { candidates, numbered: candidates.len() }
    }

    /// Every member.
    pub(super) fn candidates(&self) -> &'a [Candidate] {
        self.candidates
    }

    /// Those who have numbers, the first of whom has 1.
    pub(super) fn numbered(&self) -> &'a [Candidate] {
        &self.candidates[..self.numbered]
    }

    /// Whether some members have no number and are not among these.
    pub(super) fn hides_others_than(&self, members: &[UserName]) -> bool {
        self.candidates[self.numbered..].iter().any(|candidate| !members.contains(&candidate.name))
    }

    /// Members whose names mean something else here unless they stand in quotation marks.
    pub(super) fn clashing(&self) -> impl Iterator<Item = &'a UserName> {
        let choices = *self;
        self.candidates
            .iter()
            .map(|candidate| &candidate.name)
            .filter(move |name| choices.is_reserved(name.as_str()))
    }

    fn is_reserved(&self, name: &str) -> bool {
        let name = normalised(name);
        let words = [&EVERYBODY[..], &SOMEBODY_ELSE, &UNSURE, &SKIP, &UNDO, &STOP, &HELP, &FIRST_PERSON];
        words.concat().contains(&name.as_str())
            || name == AND
            || (name == BOTH && self.candidates.len() == 2)
            || name.bytes().all(|byte| byte.is_ascii_digit())
    }

    /// What a line means.
    pub(super) fn read(&self, line: &str) -> Typed {
        let line = line.trim();
        if line.is_empty() {
            return Typed::Nothing;
        }
        if let Some(typed) = self.pick(line) {
            return typed;
        }
        let word = quoted(line).filter(|(_, rest)| rest.is_empty()).map_or(line, |(word, _)| word);
        let word = normalised(word);
        let commands = [
            (&UNSURE[..], Typed::Unsure),
            (&SKIP, Typed::Skip),
            (&UNDO, Typed::Undo),
            (&STOP, Typed::Stop),
            (&HELP, Typed::Help),
        ];
        if let Some((_, command)) = commands.into_iter().find(|(words, _)| words.contains(&word.as_str())) {
            return command;
        }
        // A single letter is a slip of the finger; in other scripts it may be a word.
        let slip = word.len() == 1 && !FIRST_PERSON.contains(&word.as_str());
        if slip || !word.chars().any(char::is_alphanumeric) { Typed::Meaningless } else { Typed::OwnWords }
    }

    /// Reads `2`, `1 3`, `1 and Mary`, `Bob's`, `e`, `Tom, o`. `None` where any other word stands in it.
    fn pick(&self, line: &str) -> Option<Typed> {
        let mut picked = Picked { members: Vec::new(), besides: Besides::Nobody };
        let mut outcome = None;
        let mut rest = line.trim_start_matches(is_separator);
        while !rest.is_empty() {
            let all = || self.candidates.iter().map(|candidate| candidate.name.clone());
            if let Some((name, after)) = quoted(rest) {
                let (found, _) = self.named(name, Quotation::Quoted).filter(|(_, end)| end.is_empty())?;
                rest = after;
                outcome = picked.add(found).or(outcome);
            } else if let Some(after) = without_word(rest, AND) {
                rest = after;
            } else if let Some(after) = EVERYBODY.iter().find_map(|word| without_word(rest, word)) {
                rest = after;
                picked.members.extend(all());
            } else if let Some(after) = without_word(rest, BOTH).filter(|_| self.candidates.len() == 2) {
                rest = after;
                picked.members.extend(all());
            } else if let Some(after) = SOMEBODY_ELSE.iter().find_map(|word| without_word(rest, word)) {
                rest = after;
                picked.besides = Besides::SomebodyElse;
            } else if let Some((found, after)) = self.named(rest, Quotation::Plain) {
                rest = after;
                outcome = picked.add(found).or(outcome);
            } else {
                let (number, after) = number(rest)?;
                rest = after;
                match number.checked_sub(1).and_then(|place| self.numbered().get(place)) {
                    Some(candidate) => picked.members.push(candidate.name.clone()),
                    None => outcome = Some(Typed::OutOfRange),
                }
            }
            rest = rest.trim_start_matches(is_separator);
        }
        picked.members = each_once(picked.members);
        let nothing = picked.members.is_empty() && picked.besides == Besides::Nobody;
        outcome.or((!nothing).then_some(Typed::Picked(picked)))
    }

    /// The people whose name a text begins with, and what follows the name. There are several where their names
    /// differ in capitals only and the text agrees with none.
    fn named<'t>(&self, text: &'t str, quotation: Quotation) -> Option<(Vec<UserName>, &'t str)> {
        let found: Vec<(&UserName, &str)> = self
            .candidates
            .iter()
            .map(|candidate| &candidate.name)
            .filter(|name| quotation == Quotation::Quoted || !self.is_reserved(name.as_str()))
            .filter_map(|name| Some((name, without_name(text, name.as_str().trim())?)))
            .collect();
        // "Mary Ann" is not Mary.
        let shortest_rest = found.iter().map(|(_, rest)| rest.len()).min()?;
        let longest = found.into_iter().filter(|(_, rest)| rest.len() == shortest_rest);
        let (names, rests): (Vec<&UserName>, Vec<&str>) = longest.unzip();
        let exact = names.iter().find(|name| text.starts_with(name.as_str().trim()));
        let names = exact
            .map_or_else(|| names.iter().map(|&name| name.clone()).collect(), |&name| vec![name.clone()]);
        Some((names, rests[0]))
    }
}

/// Whether a name stands in quotation marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quotation {
    Plain,
    Quoted,
}

fn each_once(names: Vec<UserName>) -> Vec<UserName> {
    let mut once: Vec<UserName> = Vec::new();
    for name in names {
        if !once.contains(&name) {
            once.push(name);
        }
    }
    once
}

fn is_separator(letter: char) -> bool {
    letter.is_whitespace() || ",;+&.!".contains(letter)
}

/// In lower case, with straight apostrophes, single spaces and no stop at the end.
fn normalised(text: &str) -> String {
    let text = text.to_lowercase().replace('’', "'");
    let words: Vec<&str> = text.trim_end_matches(is_separator).split_whitespace().collect();
    words.join(" ")
}

/// What stands between the quotation marks that a text begins with, and what follows them.
fn quoted(text: &str) -> Option<(&str, &str)> {
    const MARKS: [(char, char); 4] = [('"', '"'), ('“', '”'), ('\'', '\''), ('‘', '’')];
    MARKS.iter().find_map(|&(open, close)| text.strip_prefix(open)?.split_once(close))
}

/// What follows the word that a text begins with, in any capitals.
fn without_word<'t>(text: &'t str, word: &str) -> Option<&'t str> {
    without_prefix(text, word).filter(|rest| !rest.starts_with(|next| !is_separator(next)))
}

/// What follows the name that a text begins with, in any capitals; `Bob's` is Bob.
fn without_name<'t>(text: &'t str, name: &str) -> Option<&'t str> {
    let rest = without_prefix(text, name)?;
    let without_apostrophe = rest.strip_prefix(['\'', '’']);
    let without_ending = without_apostrophe.map(|rest| rest.strip_prefix(['s', 'S']).unwrap_or(rest));
    without_ending.into_iter().chain([rest]).find(|rest| !rest.starts_with(|next| !is_separator(next)))
}

fn without_prefix<'t>(text: &'t str, prefix: &str) -> Option<&'t str> {
    let length = prefix.chars().count();
    let end = text.char_indices().nth(length).map_or(text.len(), |(end, _)| end);
    let (start, rest) = text.split_at(end);
    (start.chars().count() == length && start.to_lowercase() == prefix.to_lowercase()).then_some(rest)
}

/// The number that a text begins with, and what follows it.
fn number(text: &str) -> Option<(usize, &str)> {
    let end = text.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    let stands_alone = !digits.is_empty() && !rest.starts_with(|next| !is_separator(next));
    // What has too many digits is as far out of range as can be.
    stands_alone.then(|| (digits.parse().unwrap_or(usize::MAX), rest))
}
