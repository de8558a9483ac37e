//! How wide and how colourful the output is.

use std::ffi::OsStr;
use std::fmt::Display;

use console::Term;

/// The width where there is no terminal to ask.
pub const DEFAULT_WIDTH: u16 = 100;

/// Lines longer than this are hard to read, however wide the terminal is.
pub const MAX_WIDTH: u16 = 120;

/// A table cannot be set in less.
pub const MIN_WIDTH: u16 = 40;

/// Whether escape sequences are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Colour {
    /// Plain text.
    Never,
    /// ANSI escape sequences.
    Always,
}

impl Colour {
    /// Colour only at a terminal that shows it, and where the variable `NO_COLOR` is unset or empty
    /// (<https://no-color.org>).
    fn at(terminal: &Term, no_color: Option<&OsStr>) -> Self {
        let unwanted = no_color.is_some_and(|value| !value.is_empty());
        if terminal.is_term() && terminal.features().colors_supported() && !unwanted {
            Self::Always
        } else {
            Self::Never
        }
    }
}

/// How text is set. Colour only repeats what the words say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// The longest line, in columns.
    pub width: u16,
    /// Whether there is colour.
    pub colour: Colour,
}

impl Style {
    /// What suits the program's standard output.
    pub fn of_stdout() -> Self {
        Self::of(&Term::stdout())
    }

    /// What suits the program's standard error.
    pub fn of_stderr() -> Self {
        Self::of(&Term::stderr())
    }

    fn of(terminal: &Term) -> Self {
        let width = match terminal.size_checked() {
            Some((_, columns)) if terminal.is_term() => columns.clamp(MIN_WIDTH, MAX_WIDTH),
            _ => DEFAULT_WIDTH,
        };
        Self { width, colour: Colour::at(terminal, std::env::var_os("NO_COLOR").as_deref()) }
    }

    pub(crate) fn heading(self, text: impl Display) -> String {
        self.apply(console::Style::new().bold(), text)
    }

    pub(crate) fn aside(self, text: impl Display) -> String {
        self.apply(console::Style::new().dim(), text)
    }

    pub(super) fn alarm(self, text: impl Display) -> String {
        self.apply(console::Style::new().red(), text)
    }

    pub(super) fn caution(self, text: impl Display) -> String {
        self.apply(console::Style::new().yellow(), text)
    }

    fn apply(self, style: console::Style, text: impl Display) -> String {
        match self.colour {
            Colour::Never => text.to_string(),
            Colour::Always => style.force_styling(true).apply_to(text).to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_no_colour_without_a_terminal_or_against_the_wish_of_the_user() {
        let no_terminal = Term::read_write_pair(std::fs::File::open("/dev/null").unwrap(), std::io::stderr());
        assert_eq!(Colour::at(&no_terminal, None), Colour::Never);
        assert_eq!(Colour::at(&Term::stderr(), Some(OsStr::new("1"))), Colour::Never);
    }

    #[test]
    fn colour_wraps_the_text_and_plain_style_leaves_it() {
        let plain = Style { width: 80, colour: Colour::Never };
        let colourful = Style { width: 80, colour: Colour::Always };
        assert_eq!(plain.alarm("✗"), "✗");
        assert_eq!(colourful.alarm("✗"), "\u{1b}[31m✗\u{1b}[0m");
        assert_eq!(colourful.heading("id"), "\u{1b}[1mid\u{1b}[0m");
    }
}
