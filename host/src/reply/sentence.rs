//! Reading the one question that a model worded.

use coin_server::display::excerpt;
use pulldown_cmark::{Event, Parser};
use serde::de::IgnoredAny;
use thiserror::Error;

use super::{UnreadableReply, check_length};

/// The longest question that a person is asked, in characters.
pub const MOST_CHARACTERS: usize = 300;

/// So much text may stand around a question of [`MOST_CHARACTERS`], in bytes. What is longer is no short question,
/// however it is marked up.
const MOST_BYTES_WITH_MARKUP: usize = 4096;

/// Why a reply is not the one question that was asked for.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SentenceFault {
    /// There is nothing in it.
    #[error("it is empty; answer with the question")]
    Empty,
    /// It has several lines.
    #[error(
        "it has {lines} lines; answer with the question alone, in one line, without a word before or after it"
    )]
    SeveralLines {
        /// How many.
        lines: usize,
    },
    /// It is longer than [`MOST_CHARACTERS`].
    #[error(
        "it has {characters} characters, and at most {MOST_CHARACTERS} are allowed; ask one short question"
    )]
    TooLong {
        /// How many.
        characters: usize,
    },
    /// It is JSON.
    #[error("it is JSON; answer with the question in plain words")]
    Json,
    /// It holds a character that no screen shows.
    #[error("it holds the control character U+{code:04X}; use plain text")]
    ControlCharacter {
        /// The character's code point.
        code: u32,
    },
    /// It does not end as a question does.
    #[error("it ends with {end:?}; end with a question mark")]
    NoQuestionMark {
        /// Its last characters.
        end: String,
    },
}

/// Reads the question that a model was asked to word.
///
/// Markdown (code fences, emphasis and the like), quotation marks around the whole, a label "Question:" and repeated
/// white space are taken off.
///
/// # Errors
/// If what is left is empty, JSON, more than one line, longer than [`MOST_CHARACTERS`], holds a control character, or
/// does not end with a question mark. The error tells the model what was wrong.
pub fn read_sentence(text: &str) -> Result<String, UnreadableReply> {
    check_length(text)?;
    sentence(text).map_err(UnreadableReply::Sentence)
}

fn sentence(text: &str) -> Result<String, SentenceFault> {
    let mut text = trimmed(text).to_owned();
    if text.len() > MOST_BYTES_WITH_MARKUP {
        return Err(SentenceFault::TooLong { characters: text.chars().count() });
    }
    // Emphasis may stand within quotes within a fence; every round takes something off.
    loop {
        let bare = trimmed(without_label(without_quotes(trimmed(&without_markdown(&text))))).to_owned();
        if bare.len() >= text.len() {
            break;
        }
        text = bare;
    }
    if text.is_empty() {
        return Err(SentenceFault::Empty);
    }
    if is_json(&text) {
        return Err(SentenceFault::Json);
    }
    let lines = text.lines().filter(|line| !line.trim().is_empty()).count();
    if lines > 1 {
        return Err(SentenceFault::SeveralLines { lines });
    }
    let words: Vec<&str> = text.split_whitespace().collect();
    let text = words.join(" ");
    if let Some(control) = text.chars().find(|character| is_control(*character)) {
        return Err(SentenceFault::ControlCharacter { code: u32::from(control) });
    }
    let characters = text.chars().count();
    if characters > MOST_CHARACTERS {
        return Err(SentenceFault::TooLong { characters });
    }
    if !text.ends_with(['?', '？', '؟']) {
        let end = text.char_indices().rev().take(20).last().map_or(0, |(place, _)| place);
        return Err(SentenceFault::NoQuestionMark { end: excerpt(&text[end..]) });
    }
    Ok(text)
}

fn is_json(text: &str) -> bool {
    text.starts_with('{') || text.starts_with('[') && serde_json::from_str::<IgnoredAny>(text).is_ok()
}

fn trimmed(text: &str) -> &str {
    text.trim_matches(|character: char| character.is_whitespace() || character == '\u{feff}')
}

/// The words of a text in Markdown, a line for each of its lines.
fn without_markdown(text: &str) -> String {
    let mut words = String::with_capacity(text.len());
    for event in Parser::new(text) {
        match event {
            Event::Text(part) | Event::Code(part) | Event::InlineHtml(part) | Event::Html(part) => {
                words.push_str(&part);
            }
            Event::SoftBreak | Event::HardBreak => words.push('\n'),
            Event::End(end) if !is_inline(end) => words.push('\n'),
            _ => {}
        }
    }
    words
}

fn is_inline(end: pulldown_cmark::TagEnd) -> bool {
    use pulldown_cmark::TagEnd;
    matches!(end, TagEnd::Emphasis | TagEnd::Strong | TagEnd::Link | TagEnd::Image)
}

/// The text without quotation marks that enclose the whole of it.
fn without_quotes(text: &str) -> &str {
    const QUOTES: [(char, char); 7] =
        [('"', '"'), ('\'', '\''), ('“', '”'), ('„', '“'), ('‘', '’'), ('«', '»'), ('»', '«')];
    QUOTES
        .into_iter()
        .find_map(|(open, close)| {
            let inside = text.strip_prefix(open)?.strip_suffix(close)?;
            // `"Bob" or "Mary"` is not one text in quotes, and the apostrophe of `'Is it Bob's?'` opens nothing.
            let opens_again = inside.split_whitespace().skip(1).any(|word| word.starts_with(open));
            (!opens_again).then_some(inside)
        })
        .unwrap_or(text)
}

fn without_label(text: &str) -> &str {
    const LABEL: &str = "question:";
    match text.get(..LABEL.len()) {
        Some(start) if start.eq_ignore_ascii_case(LABEL) => &text[LABEL.len()..],
        _ => text,
    }
}

/// Control characters, and those that turn the direction of text, so that a person would read another question.
fn is_control(character: char) -> bool {
    character.is_control() || matches!(character, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}
