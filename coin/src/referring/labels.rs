//! How well words fit the label of a thing.
//!
//! Words and label are a noun with details before it. The nouns have to mean the same, nearly the same, or be spelled
//! nearly the same; details may be confirmed by the other side, contradicted, or be unknown to it.

use std::collections::HashMap;

use super::STEP;
use super::synonyms::{Kinship, is_known, kinship, names_like};
use crate::language::number::singular;
use crate::language::words::{Words, fold};

/// The longest noun of a household thing, in words.
const LONGEST_NOUN: usize = 4;

/// Properties that a thing has one of, so that two of a line contradict each other. A property of another line may be
/// true although the label does not say it.
const PROPERTIES: &[&str] = &[
    "red, blue, green, yellow, orange, purple, pink, brown, black, white, grey, gray, beige, turquoise, violet, \
     golden, gold, silver",
    "big, large, small, little, tiny, huge",
    "old, new",
    "wooden, metal, plastic, ceramic, leather, woolen, steel, paper",
    "dark, bright",
    "long, short",
    "round, square",
    "empty, full",
    "clean, dirty",
    "favourite, favorite, nice, beautiful",
];

/// How well a thing is described, by its noun alone and with the details.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fit {
    /// 0…1
    pub(super) noun: f64,
    /// 0…1, at most `noun`
    pub(super) whole: f64,
}

/// How well words fit the labels of a map. A home has far fewer labels than things, and each is compared once.
pub(super) struct LabelFits<'a> {
    words: &'a [String],
    fits: HashMap<&'a str, Fit>,
}

impl<'a> LabelFits<'a> {
    pub(super) fn new(words: &'a [String]) -> Self {
        Self { words, fits: HashMap::new() }
    }

    pub(super) fn of(&mut self, label: &'a str) -> Fit {
        *self.fits.entry(label).or_insert_with(|| fit(self.words, &words_of(label)))
    }
}

/// The words of a name: lower case, singular, without articles; "deck of cards" is a card deck.
pub(super) fn words_of(name: &str) -> Vec<String> {
    let spaced = name.replace(['_', '-', '/'], " ");
    let words: Vec<String> = Words::new(&spaced).map(|word| fold(word.text(&spaced))).collect();
    if let Some(of) = words.iter().position(|word| word == "of")
        && of > 0
        && of + 1 < words.len()
    {
        return words[of + 1..].iter().chain(&words[..of]).filter_map(|word| noun_word(word)).collect();
    }
    words.iter().filter_map(|word| noun_word(word)).collect()
}

fn noun_word(word: &str) -> Option<String> {
    (!matches!(word, "the" | "a" | "an" | "of")).then(|| singular(word))
}

/// One form for "tooth brush" and "toothbrush".
pub(super) fn joined(words: &[String]) -> String {
    words.concat()
}

/// How well the words fit the label: the best of all ways to take the last words of each as its noun. Every step away
/// from the very words costs the factor [`STEP`]:
/// * a kind of the thing, a misspelling: one step;
/// * a detail that only one side has and that makes another kind of thing ("car" keys): one step;
/// * a property that the label does not tell ("red"): two steps, so that a label that tells it comes first even where
///   its noun is another; a contradicted one excludes the thing, and so do details that name different kinds.
///
/// Words that are properties only ("the red one") fit the labels that tell them.
pub(super) fn fit(words: &[String], label: &[String]) -> Fit {
    if !words.is_empty() && words.iter().all(|word| group(word).is_some()) {
        let told = if words.iter().all(|word| label.contains(word)) { 1.0 } else { 0.0 };
        return Fit { noun: told, whole: told };
    }
    let mut best = Fit { noun: 0.0, whole: 0.0 };
    for asked in 1..=words.len().min(LONGEST_NOUN) {
        let (asked_details, asked_noun) = words.split_at(words.len() - asked);
        for given in 1..=label.len().min(LONGEST_NOUN) {
            let (details, noun) = label.split_at(label.len() - given);
            let same = nouns(asked_noun, noun);
            let whole = same * detail(asked_details, details);
            best = Fit { noun: best.noun.max(same), whole: best.whole.max(whole) };
        }
    }
    best
}

fn nouns(asked: &[String], label: &[String]) -> f64 {
    let (one, other) = (joined(asked), joined(label));
    if one == other {
        return 1.0;
    }
    match kinship(&one, &other) {
        Some(Kinship::Same) => 1.0,
        Some(Kinship::Kind) => STEP,
        None if is_misspelled(asked, &one, &other) => STEP,
        None => 0.0,
    }
}

/// Whether the words are the label or another name for it with a slip: one letter too many, too few, wrong, or
/// exchanged with the next, two in long words. A short word, and a word that names something itself, is no slip.
fn is_misspelled(asked: &[String], one: &str, label: &str) -> bool {
    if asked.iter().all(|word| is_known(word)) {
        return false;
    }
    let mut names = std::iter::once(label.to_owned()).chain(names_like(label).map(str::to_owned));
    names.any(|name| {
        let allowed = match one.chars().count().max(name.chars().count()) {
            0..=4 => 0,
            5..=7 => 1,
            _ => 2,
        };
        strsim::osa_distance(one, &name) <= allowed
    })
}

fn detail(asked: &[String], label: &[String]) -> f64 {
    let missing = |from: &[String], to: &[String]| -> (Vec<String>, Vec<String>) {
        from.iter().filter(|word| !to.contains(word)).cloned().partition(|word| group(word).is_some())
    };
    let (asked_properties, asked_kinds) = missing(asked, label);
    let (label_properties, label_kinds) = missing(label, asked);
    let contradicted =
        asked_properties.iter().any(|word| label_properties.iter().any(|other| group(other) == group(word)));
    if contradicted || !asked_kinds.is_empty() && !label_kinds.is_empty() {
        return 0.0;
    }
    let kinds = if asked_kinds.is_empty() && label_kinds.is_empty() { 1.0 } else { STEP };
    let properties = if asked_properties.is_empty() { 1.0 } else { STEP * STEP };
    kinds * properties
}

/// Puts properties that stand behind the noun before it: "the mug, the blue one" is the blue mug.
pub(super) fn properties_first(mut words: Vec<String>) -> Vec<String> {
    let behind = words.iter().rev().take_while(|word| group(word).is_some()).count();
    words.rotate_right(behind);
    words
}

/// The line of [`PROPERTIES`] in which the word stands.
fn group(word: &str) -> Option<usize> {
    PROPERTIES.iter().position(|line| line.split(", ").any(|listed| listed == word))
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;

    #[rstest]
    #[case::the_word("mug", "mug", 1.0)]
    #[case::several("mugs", "mug", 1.0)]
    #[case::in_two_words("tooth brush", "toothbrush", 1.0)]
    #[case::in_one_word("coffeetable", "coffee_table", 1.0)]
    #[case::another_word("couch", "sofa", 1.0)]
    #[case::with_of("playing cards", "deck of cards", 1.0)]
    #[case::a_kind("cup", "mug", 0.8)]
    #[case::the_general_name("mug", "cup", 0.8)]
    #[case::two_kinds("teacup", "mug", 0.0)]
    #[case::a_slip("kettel", "kettle", 0.8)]
    #[case::no_slip_in_short_words("mog", "mug", 0.0)]
    #[case::a_word_of_its_own("boot", "book", 0.0)]
    #[case::label_says_more("keys", "car keys", 0.8)]
    #[case::words_say_more("car keys", "keys", 0.8)]
    #[case::a_modifier_is_no_noun("phone", "phone charger", 0.0)]
    #[case::other_kinds("laptop charger", "phone charger", 0.0)]
    #[case::a_property_of_the_label("mug", "red mug", 1.0)]
    #[case::a_confirmed_property("red mug", "red mug", 1.0)]
    #[case::an_untold_property("red mug", "mug", 0.64)]
    #[case::a_contradicted_property("red mug", "blue mug", 0.0)]
    #[case::spectacles_are_no_glass("glasses", "glass", 0.0)]
    #[case::a_property_alone("red", "red mug", 1.0)]
    #[case::a_property_alone_untold("red", "mug", 0.0)]
    #[case::nothing_alike("violin", "mug", 0.0)]
    fn words_fit_labels(#[case] words: &str, #[case] label: &str, #[case] expected: f64) {
        let fit = fit(&words_of(words), &words_of(label));
        assert!((fit.whole - expected).abs() < 1e-12, "{words} – {label}: {fit:?}");
    }
}
