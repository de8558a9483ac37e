//! The words of a text with short forms written out, each with its place in the text.

use super::vocabulary::CONTRACTIONS;
use super::words::{Gap, Word, fold};

/// A word, or one of the words that a short form stands for.
#[derive(Debug, Clone)]
pub(crate) struct Token {
    /// Lower case.
    pub(crate) text: String,
    /// The place of the word in the text.
    pub(crate) word: usize,
    pub(crate) possessive: bool,
    pub(crate) capital: bool,
    pub(crate) gap: Gap,
}

/// Words whose "'s" means "is".
const WITH_IS: &[&str] = &["it", "that", "this", "he", "she", "who", "what", "there", "here", "where", "how"];

/// Endings that stand for a word of their own.
const ENDINGS: &[(&str, &str)] =
    &[("n't", "not"), ("'m", "am"), ("'re", "are"), ("'ve", "have"), ("'ll", "will"), ("'d", "would")];

pub(crate) fn tokens(text: &str, words: &[Word]) -> Vec<Token> {
    let mut tokens = Vec::with_capacity(words.len());
    for (place, word) in words.iter().enumerate() {
        let folded = fold(word.text(text));
        let mut push = |text: &str, possessive: bool, gap: Gap| {
            tokens.push(Token { text: text.to_owned(), word: place, possessive, capital: word.capital, gap });
        };
        if let Some((_, spelled)) = CONTRACTIONS.iter().find(|(short, _)| *short == folded) {
            for (index, part) in spelled.split(' ').enumerate() {
                push(part, false, if index == 0 { word.gap } else { Gap::Space });
            }
        } else if word.possessive && WITH_IS.contains(&folded.as_str()) {
            push(&folded, false, word.gap);
            push("is", false, Gap::Space);
        } else if word.possessive && folded == "let" {
            // "let's see" lets nobody use anything.
            push("let's", false, word.gap);
        } else if let Some((stem, ending)) = split_ending(&folded) {
            push(stem, false, word.gap);
            push(ending, false, Gap::Space);
        } else {
            push(&folded, word.possessive, word.gap);
        }
    }
    tokens
}

fn split_ending(folded: &str) -> Option<(&str, &'static str)> {
    ENDINGS
        .iter()
        .find_map(|&(ending, meaning)| folded.strip_suffix(ending).map(|stem| (stem, meaning)))
        .filter(|(stem, _)| !stem.is_empty())
}

/// The longest run of up to `most` tokens, only spaces between them, that means something. `meaning` is told
/// whether the last token is possessive; no other one may be.
pub(crate) fn longest<T>(
    tokens: &[Token],
    most: usize,
    meaning: impl Fn(&str, bool) -> Option<T>,
) -> Option<(T, usize)> {
    let mut phrase = String::new();
    let mut best = None;
    for (index, token) in tokens.iter().take(most).enumerate() {
        if index > 0 {
            if token.gap != Gap::Space || tokens[index - 1].possessive {
                break;
            }
            phrase.push(' ');
        }
        phrase.push_str(&token.text);
        best = meaning(&phrase, token.possessive).map(|meant| (meant, index + 1)).or(best);
    }
    best
}
