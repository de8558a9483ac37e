//! Cursors of lists that come page by page.
//!
//! A cursor names the last thing of its page, so that a thing that is added meanwhile moves no page. It is opaque to
//! clients: what it says may change with the version.

use std::fmt::Write as _;

/// What a cursor begins with; another layout of cursors would begin with something else.
const MARK: &str = "after-";

/// The cursor of the page that ends with this item.
pub(crate) fn after(last: &str) -> String {
    let mut cursor = MARK.to_owned();
    for byte in last.bytes() {
        // Writing to a string does not fail.
        let _ = write!(cursor, "{byte:02x}");
    }
    cursor
}

/// The last item of the page before; `None` where this is no cursor.
pub(crate) fn read(cursor: &str) -> Option<String> {
    let is_digit = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
    let digits =
        cursor.strip_prefix(MARK).filter(|digits| digits.bytes().all(is_digit) && digits.len() % 2 == 0)?;
    let bytes: Option<Vec<u8>> = digits
        .as_bytes()
        .chunks(2)
        .map(|pair| str::from_utf8(pair).ok().and_then(|pair| u8::from_str_radix(pair, 16).ok()))
        .collect();
    String::from_utf8(bytes?).ok()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_cursor_names_its_item(item in ".*") {
            prop_assert_eq!(read(&after(&item)), Some(item));
        }

        #[test]
        fn nothing_else_is_a_cursor(text in "(after-)?[0-9a-f+é-]{0,9}") {
            if let Some(item) = read(&text) {
                prop_assert_eq!(after(&item), text);
            }
        }
    }
}
