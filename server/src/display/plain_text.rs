//! Text of foreign origin, made safe to show.

use std::borrow::Cow;

/// Makes text from a map, a person or a model safe to show in one line at a terminal.
///
/// Line breaks and tabs become spaces. Every other control character becomes visible (ESC as `␛`), so that it can
/// neither move the cursor nor change a colour. Characters that turn the direction of text or show nothing at all,
/// which can make a text look like another one, become `�`. Joiners stay, because scripts need them.
pub fn plain_text(text: &str) -> Cow<'_, str> {
    if text.chars().all(|character| shown_as(character) == character) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.replace("\r\n", "\n").chars().map(shown_as).collect())
}

/// How much of foreign words an error repeats, in characters.
const LONGEST_EXCERPT: usize = 200;

/// As much of foreign words as an error may repeat: how they begin, in one line and safe to show.
pub fn excerpt(text: &str) -> String {
    // Far more than is shown, so that a long run of white space does not empty the excerpt.
    let beginning: String = text.chars().take(20 * LONGEST_EXCERPT).collect();
    let line = plain_text(&beginning).split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= LONGEST_EXCERPT {
        return line;
    }
    line.chars().take(LONGEST_EXCERPT - 1).chain(['…']).collect()
}

fn shown_as(character: char) -> char {
    match character {
        '\n' | '\r' | '\t' | '\u{b}' | '\u{c}' | '\u{85}' | '\u{2028}' | '\u{2029}' => ' ',
        '\u{7f}' => '␡',
        '\0'..='\u{1f}' => char::from_u32(0x2400 + u32::from(character)).unwrap_or('�'),
        '\u{80}'..='\u{9f}'
        | '\u{61c}'
        | '\u{200b}'
        | '\u{200e}'
        | '\u{200f}'
        | '\u{202a}'..='\u{202e}'
        | '\u{2066}'..='\u{2069}'
        | '\u{feff}' => '�',
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rstest::rstest;

    use super::*;

    #[rstest]
    #[case("pencil", "pencil")]
    #[case("crème brûlée 🍮 and 👩‍🍳", "crème brûlée 🍮 and 👩‍🍳")]
    #[case("two\nlines\r\nand a\ttab", "two lines and a tab")]
    #[case("\u{1b}[31mred\u{1b}[0m", "␛[31mred␛[0m")]
    #[case("bell\u{7} delete\u{7f} csi\u{9b}2J", "bell␇ delete␡ csi�2J")]
    #[case("Tom\u{202e}yraM", "Tom�yraM")]
    fn shows_what_would_act(#[case] given: &str, #[case] shown: &str) {
        assert_eq!(plain_text(given), shown);
    }

    proptest! {
        #[test]
        fn holds_no_control_character_and_is_stable(text in "\\PC*|[\\x00-\\x{a0}]*|.*") {
            let shown = plain_text(&text).into_owned();
            prop_assert!(!shown.chars().any(char::is_control));
            prop_assert_eq!(plain_text(&shown), shown.as_str());
        }

        #[test]
        fn an_excerpt_is_short_and_acts_on_nothing(text in "(\\PC|[\\x00-\\x{a0}]){0,900}") {
            let shown = excerpt(&text);
            prop_assert!(shown.chars().count() <= LONGEST_EXCERPT);
            prop_assert!(!shown.chars().any(char::is_control));
        }
    }
}
