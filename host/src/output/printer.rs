//! The one place that owns the program's two streams: the result goes to stdout, everything else to stderr.

use std::io::{self, ErrorKind, Write};

use coin_schemas::household::Users;
use coin_schemas::report::Report;
use coin_server::display::plain_text;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::narration::{Bars, Narration};
use super::{Style, table};
use crate::person::PersonKind;

/// In which form the result appears on stdout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ResultFormat {
    /// For a person to read.
    Text,
    /// The report, and it alone.
    Json,
}

/// Whether the story is told on stderr.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Progress {
    /// It is.
    Told,
    /// It is not; errors still are.
    Quiet,
}

/// Writes to the program's streams.
///
/// Whoever reads stdout may stop at any time, as `head` does: that is a clean end, not an error.
#[derive(Debug, Clone, Copy)]
pub struct Printer {
    format: ResultFormat,
    progress: Progress,
}

impl Printer {
    /// A printer of results in this form, with or without the story.
    pub fn new(format: ResultFormat, progress: Progress) -> Self {
        Self { format, progress }
    }

    /// The teller of the story, for a run in which this kind of person answers.
    pub fn narration(&self, person: PersonKind) -> Narration {
        match self.progress {
            Progress::Quiet => Narration::silent(),
            Progress::Told => {
                let bars = if console::Term::stderr().is_term() { Bars::Drawn } else { Bars::Hidden };
                Narration::new(Box::new(io::stderr()), Style::of_stderr(), person, bars)
            }
        }
    }

    /// A bar for work of this many pieces, drawn where somebody watches.
    pub fn bar(&self, pieces: usize, what: &'static str) -> ProgressBar {
        let watched = self.progress == Progress::Told && console::Term::stderr().is_term();
        let target = if watched { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(pieces as u64), target);
        if let Ok(template) = ProgressStyle::with_template("  {bar:30} {pos}/{len} {msg} · {elapsed}") {
            bar.set_style(template.progress_chars("━━─"));
        }
        bar.set_message(what);
        bar
    }

    /// Bars for work in several parts, one after the other.
    pub fn bars(&self) -> PartBars {
        PartBars { printer: *self, bar: None }
    }

    /// Prints the report on stdout.
    ///
    /// # Errors
    /// If stdout takes no more, unless its reader has gone.
    pub fn report(&self, report: &Report, users: &Users) -> io::Result<()> {
        match self.format {
            ResultFormat::Text => {
                // The story and the result stand apart where both reach the same terminal.
                self.progress("");
                self.text(&table::render(report, users, Style::of_stdout()))
            }
            ResultFormat::Json => {
                let mut json = serde_json::to_string_pretty(report)?;
                json.push('\n');
                self.text(&json)
            }
        }
    }

    /// Prints a result that is already text on stdout.
    ///
    /// # Errors
    /// If stdout takes no more, unless its reader has gone.
    pub fn text(&self, text: &str) -> io::Result<()> {
        write_all(&mut io::stdout().lock(), text)
    }

    /// Tells on stderr what is being done, unless the printer is quiet.
    pub fn progress(&self, text: &str) {
        if self.progress == Progress::Told {
            complain(&format!("{text}\n"));
        }
    }

    /// Tells on stderr why the program fails, and what to do next.
    pub fn failure(&self, reason: &str) {
        let label = Style::of_stderr().alarm("error:");
        let reason: Vec<_> = reason.lines().map(plain_text).collect();
        complain(&format!("{label} {}\n", reason.join("\n")));
    }
}

/// Where stderr is closed there is nobody left to tell.
fn complain(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

fn write_all(writer: &mut impl Write, text: &str) -> io::Result<()> {
    match writer.write_all(text.as_bytes()).and_then(|()| writer.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written,
    }
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;

    struct Failing(ErrorKind);

    impl Write for Failing {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[rstest]
    #[case(ErrorKind::BrokenPipe, None)]
    #[case(ErrorKind::StorageFull, Some(ErrorKind::StorageFull))]
    fn a_reader_who_has_gone_is_a_clean_end(#[case] kind: ErrorKind, #[case] error: Option<ErrorKind>) {
        let written = write_all(&mut Failing(kind), "a line\n");
        assert_eq!(written.err().map(|error| error.kind()), error);
    }

    #[test]
    fn text_is_written_as_it_is() {
        let mut written = Vec::new();
        write_all(&mut written, "a line\n").unwrap();
        assert_eq!(written, b"a line\n");
    }
}

/// A bar for each part of a long work.
#[derive(Debug)]
pub struct PartBars {
    printer: Printer,
    bar: Option<ProgressBar>,
}

impl crate::experiment::Progress for PartBars {
    fn begin(&mut self, pieces: usize, what: &'static str) {
        let bar = self.printer.bar(pieces, what);
        if bar.is_hidden() {
            self.printer.progress(&format!("{pieces} {what} …"));
        }
        self.bar = Some(bar);
    }

    fn step(&mut self) {
        if let Some(bar) = &self.bar {
            bar.inc(1);
        }
    }

    fn end(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}
