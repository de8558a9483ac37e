//! `coin-server observe`: recorded detections become things of the map.

use std::cmp::Ordering;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::PathBuf;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

use clap::Args;
use coin_schemas::tools::{MAX_OBSERVATIONS, Observation, ObserveObjectsResult, SeenView};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};
use serde_json::Value;

use super::{Failure, failed, open, print, refused, say};
use crate::observations::Batch;
use crate::store::Access;

/// So many detections are stored together at least, where there are as many. What is known of a thing is written once
/// for all of them.
const BATCH: usize = 16_000;

/// So many are stored together at most: views are kept whole, as far as one call of the tool could hold them.
const LARGEST_BATCH: usize = BATCH + MAX_OBSERVATIONS;

/// So many refused lines are told one by one.
const TOLD_LINES: u64 = 20;

const EXAMPLES: &str = "\
Examples:
  coin-server observe --file detections.jsonl --db home.db
  robot-detections | coin-server observe --file - --db home.db
  coin-server observe --file detections.jsonl --json | jq .object_id

A line is a detection or what a view had in sight:
  {\"class\": \"cup\", \"position\": [1.2, 0.4, 0.8], \"radius\": 0.05, \"seen_at\": \"2025-01-19T19:00:00\", \"view\": \"17\"}
  {\"view\": \"17\", \"least\": [0, 0, 0], \"greatest\": [3, 2, 2]}
Optional keys of a detection: embedding (512 numbers), view (the image that it is from), room.
Lines that cannot be stored are told and left out; the same file again changes nothing.

Exit status: 0 done; 1 failed; 2 wrong use, or a file or database that cannot be opened.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Observe {
    /// The detections, one JSON object a line; - for standard input
    #[arg(long, value_name = "FILE.jsonl")]
    file: PathBuf,
    /// The database; it is created where it is missing [default: home.db in the user's data folder]
    #[arg(long, value_name = "FILE")]
    db: Option<PathBuf>,
    /// Print what became of each line, one JSON object a line; index counts the lines of the file from 0
    #[arg(long)]
    json: bool,
}

/// What came of a file.
#[derive(Debug, Default, Clone, Copy)]
struct Totals {
    stored: u64,
    new: u64,
    moved: u64,
    rejected: u64,
}

pub(super) fn run(arguments: &Observe) -> Result<(), Failure> {
    let (input, bytes): (Box<dyn Read + Send>, Option<u64>) = if arguments.file.as_os_str() == "-" {
        (Box::new(std::io::stdin()), None)
    } else {
        let unreadable =
            |source: std::io::Error| refused(format!("cannot read {}: {source}", arguments.file.display()));
        let file = File::open(&arguments.file).map_err(unreadable)?;
        let metadata = file.metadata().map_err(unreadable)?;
        if metadata.is_dir() {
            return Err(refused(format!("cannot read {}: it is a folder", arguments.file.display())));
        }
        (Box::new(file), metadata.is_file().then_some(metadata.len()))
    };
    let store = open(arguments.db.as_deref(), Access::ReadWrite)?;
    let bar = progress(bytes);
    // One batch is read while the one before it is stored.
    let (filled, batches) = sync_channel(1);
    let totals = thread::scope(|scope| {
        let input = bar.wrap_read(input);
        let reading = scope.spawn(move || read(input, &filled));
        let totals = batches.iter().try_fold(Totals::default(), |totals, batch| {
            let result = batch.observe(&store).map_err(failed)?;
            bar.suspend(|| tell(&result, totals.rejected, arguments))?;
            let totals = totals.with(&result);
            bar.set_message(format!("{} detections", totals.stored));
            Ok::<_, Failure>(totals)
        });
        // Whoever reads ends when nobody takes what was read.
        drop(batches);
        match (totals, reading.join()) {
            (Err(failure), _) => Err(failure),
            (Ok(_), Ok(Err(source))) => {
                Err(failed(format!("cannot read {}: {source}", arguments.file.display())))
            }
            (Ok(totals), Ok(Ok(()))) => Ok(totals),
            (_, Err(panic)) => std::panic::resume_unwind(panic),
        }
    })?;
    bar.finish_and_clear();
    say(&totals.to_string());
    Ok(())
}

impl Totals {
    fn with(self, result: &ObserveObjectsResult) -> Self {
        Self {
            stored: self.stored + result.results.len() as u64,
            new: self.new + result.results.iter().filter(|seen| seen.new).count() as u64,
            moved: self.moved + result.moved.len() as u64,
            rejected: self.rejected + result.rejected.len() as u64,
        }
    }
}

impl std::fmt::Display for Totals {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { stored, new, moved, rejected } = self;
        write!(
            formatter,
            "Detections {stored} stored and {rejected} left out; things {new} new and {moved} moved."
        )
    }
}

/// Reads lines into batches until there are none, or nobody takes them.
fn read(input: impl Read, filled: &SyncSender<Batch>) -> std::io::Result<()> {
    let mut input = BufReader::with_capacity(1 << 16, input);
    let mut line = Vec::new();
    let mut batch = Batch::new();
    let mut last_view = None;
    for index in 0_u64.. {
        line.clear();
        if input.read_until(b'\n', &mut line)? == 0 {
            break;
        }
        let read = Line::of(&line);
        let is_within_a_view = read.view().is_some() && read.view() == last_view.as_deref();
        let is_full = batch.len() >= if is_within_a_view { LARGEST_BATCH } else { BATCH };
        if is_full && filled.send(std::mem::replace(&mut batch, Batch::new())).is_err() {
            return Ok(());
        }
        last_view = read.view().map(str::to_owned);
        match read {
            Line::Detection(observation) => batch.add(index, observation),
            Line::View(view) => {
                if let Err(reason) = batch.add_view(&view) {
                    batch.reject(index, reason);
                }
            }
            Line::Unclear(value) => batch.add_value(index, &value),
            Line::NoJson(reason) => batch.reject(index, reason),
            Line::Empty => {}
        }
    }
    // Where nobody takes the last batch, storing has failed and is told.
    let _ = filled.send(batch);
    Ok(())
}

/// What a line says.
enum Line {
    Detection(Observation),
    View(SeenView),
    Unclear(Value),
    NoJson(String),
    Empty,
}

impl Line {
    fn of(line: &[u8]) -> Self {
        if line.trim_ascii().is_empty() {
            return Self::Empty;
        }
        if let Ok(observation) = serde_json::from_slice(line) {
            return Self::Detection(observation);
        }
        if let Ok(view) = serde_json::from_slice(line) {
            return Self::View(view);
        }
        match serde_json::from_slice(line) {
            Ok(value) => Self::Unclear(value),
            Err(source) if line.windows(3).any(|letters| letters == b"NaN" || letters == b"Inf") => {
                Self::NoJson(format!("it is no JSON, which has neither NaN nor infinity: {source}"))
            }
            Err(source) => Self::NoJson(format!("it is no JSON: {source}")),
        }
    }

    fn view(&self) -> Option<&str> {
        match self {
            Self::Detection(observation) => observation.view.as_deref(),
            Self::View(view) => Some(&view.view),
            Self::Unclear(_) | Self::NoJson(_) | Self::Empty => None,
        }
    }
}

/// Tells which lines were left out, and with `--json` what became of every line.
fn tell(result: &ObserveObjectsResult, told: u64, arguments: &Observe) -> Result<(), Failure> {
    let ObserveObjectsResult { results, rejected, .. } = result;
    for (line, number) in rejected.iter().zip(told..) {
        match number.cmp(&TOLD_LINES) {
            Ordering::Less => say(&format!("line {}: {}", line.index + 1, line.reason)),
            Ordering::Equal => say("Further lines that are left out are only counted."),
            Ordering::Greater => break,
        }
    }
    if arguments.json {
        let mut lines: Vec<(u64, String)> = Vec::with_capacity(results.len() + rejected.len());
        for seen in results {
            lines.push((seen.index, serde_json::to_string(seen).map_err(failed)?));
        }
        for line in rejected {
            lines.push((line.index, serde_json::to_string(line).map_err(failed)?));
        }
        lines.sort_unstable();
        let text: String = lines.into_iter().map(|(_, line)| line + "\n").collect();
        print(&text)?;
    }
    Ok(())
}

/// A bar of bytes where the length is known, otherwise a count; nothing where nobody looks.
fn progress(bytes: Option<u64>) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(bytes, ProgressDrawTarget::stderr())
        .with_finish(ProgressFinish::AndClear);
    let template = match bytes {
        Some(_) => "  {bar:30} {percent:>3} %  {msg}",
        None => "  {msg}",
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("━━─"));
    }
    bar
}
