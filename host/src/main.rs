//! The program `host`: reads the command line, runs what it names, and ends with an exit status.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use clap::{Parser, ValueEnum};
use coin::calibration::{households_wanted, too_few_samples};
use coin_host::ask::AskArguments;
use coin_host::calibrate::{CalibrateSettings, calibrate_on, read_calibration};
use coin_host::cli::{
    CalibrateArguments, Command, CommandLine, ExperimentArguments, GenerateCommand, MethodArgument,
    ModelArguments, RunArguments, default_levels,
};
use coin_host::experiment::{CoverageHomes, ExperimentSettings, check_folder, write};
use coin_host::generate;
use coin_host::journal::Beginning;
use coin_host::model::ChatModel;
use coin_host::model::choice::{self, ModelSettings};
use coin_host::observer::Chronicle;
use coin_host::output::{EventLog, Printer, Progress, ResultFormat};
use coin_host::pages::episode::{EpisodePage, episode as page};
use coin_host::person::{Answers, ErrorRate, PersonKind};
use coin_host::run::{EvidenceKept, ForeignCalibration, RunSettings, run_episode};
use coin_schemas::report::Stopped;
use coin_schemas::tools::FindDecision;
use coin_server::output_file::{OutputFile, OutputFileError};
use mimalloc::MiMalloc;
use tokio_util::sync::CancellationToken;
use tracing_subscriber::EnvFilter;

#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

/// Why the program ends without its result.
enum Failure {
    /// What was given is refused; the same call will fail again. Exit status 2.
    Refused(String),
    /// Something failed on the way. Exit status 1.
    Failed(String),
    /// Nothing failed, but what was printed is a question or a refusal. Exit status 3.
    NotFound,
}

impl From<OutputFileError> for Failure {
    fn from(source: OutputFileError) -> Self {
        match source {
            OutputFileError::Refused { .. } => Self::Refused(source.to_string()),
            OutputFileError::Failed { .. } => Self::Failed(source.to_string()),
        }
    }
}

fn main() -> ExitCode {
    let arguments = CommandLine::parse();
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_ansi(false)
        .with_env_filter(EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new("warn")))
        .init();
    let outcome = match &arguments.command {
        None => run(&arguments.run),
        Some(Command::Calibrate(arguments)) => calibrate(arguments),
        Some(Command::Ask(arguments)) => ask(arguments),
        Some(Command::Experiment(arguments)) => experiment(arguments),
        Some(Command::Generate(GenerateCommand::Homer(arguments))) => {
            generate::run_homer(arguments).map_err(|error| Failure::Refused(format!("{error:#}")))
        }
        Some(Command::Generate(GenerateCommand::Routine(arguments))) => {
            generate::run(arguments).map_err(|error| Failure::Refused(format!("{error:#}")))
        }
    };
    let printer = Printer::new(ResultFormat::Text, Progress::Told);
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Refused(reason)) => {
            printer.failure(&reason);
            ExitCode::from(2)
        }
        Err(Failure::Failed(reason)) => {
            printer.failure(&reason);
            ExitCode::from(1)
        }
        Err(Failure::NotFound) => ExitCode::from(3),
    }
}

/// Classifies an error by whether what was given is at fault.
fn failure(is_refusal: bool, error: &impl std::error::Error) -> Failure {
    if is_refusal { Failure::Refused(error.to_string()) } else { Failure::Failed(error.to_string()) }
}

fn runtime() -> Result<tokio::runtime::Runtime, Failure> {
    tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .map_err(|error| Failure::Failed(format!("the runtime does not start: {error}")))
}

/// What is added to the name of the database where replies are kept beside it.
const CACHE_SUFFIX: &str = ".replies.jsonl";

fn model(arguments: &ModelArguments, seed: u64, db: Option<&Path>) -> Result<Arc<dyn ChatModel>, Failure> {
    let beside_db = db.map(|db| {
        let mut name = db.as_os_str().to_owned();
        name.push(CACHE_SUFFIX);
        PathBuf::from(name)
    });
    let settings = ModelSettings {
        seed,
        timeout: Duration::from_secs(arguments.timeout),
        budget: arguments.budget,
        cache: arguments.cache.as_deref().or(beside_db.as_deref()),
        record: arguments.record.as_deref(),
    };
    choice::ready(&arguments.model, &settings).map_err(|error| failure(error.is_refusal(), &error))
}

/// The status of a program that Ctrl-C ended.
const INTERRUPTED: i32 = 130;

#[expect(clippy::exit, reason = "who presses Ctrl-C twice wants no more tidying up")]
fn leave_at_once() {
    std::process::exit(INTERRUPTED);
}

/// A token that Ctrl-C cancels. A second Ctrl-C ends the program at once.
fn until_interrupted(printer: Printer) -> CancellationToken {
    let stop = CancellationToken::new();
    let cancelled = stop.clone();
    tokio::spawn(async move {
        if tokio::signal::ctrl_c().await.is_err() {
            return;
        }
        printer.progress("\nStopping; what was learnt is kept. Once more ends it at once.");
        cancelled.cancel();
        if tokio::signal::ctrl_c().await.is_ok() {
            leave_at_once();
        }
    });
    stop
}

fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let episode = arguments.episode.clone().ok_or_else(|| {
        Failure::Refused("no episode is given; name its folder with --episode DIR".to_owned())
    })?;
    arguments.check().map_err(Failure::Refused)?;
    let calibration = match &arguments.calibration {
        Some(file) => Some(read_calibration(file).map_err(|error| failure(true, &error))?),
        None => None,
    };
    // The files are opened before the work begins, so that an hour's work does not end at a misspelt folder.
    let log = match &arguments.events {
        Some(file) => Some(EventLog::create(file).map_err(|error| failure(true, &error))?),
        None => None,
    };
    let report_file = arguments.report.as_deref().map(OutputFile::create).transpose()?;
    let page_file = arguments.html.as_deref().map(OutputFile::create).transpose()?;
    let model = model(&arguments.model, arguments.seed, arguments.db.as_deref())?;
    let scoring = arguments.scoring.scoring(model.name()).map_err(Failure::Refused)?;
    let settings = RunSettings {
        episode,
        db: arguments.db.clone(),
        server: arguments.server.clone(),
        gate: arguments.gate.into(),
        risk: arguments.risk.unwrap_or(default_levels().risk),
        calibration,
        answers: arguments.answers.clone(),
        max_questions: arguments.max_questions,
        seed: arguments.seed,
        wrong_answers: arguments.wrong_answers.unwrap_or(ErrorRate::NONE),
        reinference: arguments.reinference.into(),
        withheld: arguments.without.iter().copied().map(Into::into).collect(),
        foreign_calibration: match arguments.force_calibration {
            true => ForeignCalibration::Used,
            false => ForeignCalibration::Refused,
        },
        scoring,
        concurrency: arguments.model.concurrency,
        beginning: if arguments.resume { Beginning::WhereItEnded } else { Beginning::Anew },
        evidence: if page_file.is_some() { EvidenceKept::All } else { EvidenceKept::None },
    };
    let format = if arguments.json { ResultFormat::Json } else { ResultFormat::Text };
    let progress = if arguments.quiet { Progress::Quiet } else { Progress::Told };
    let printer = Printer::new(format, progress);
    let person = match settings.answers {
        Answers::Simulated => PersonKind::Simulated,
        Answers::Terminal => PersonKind::Terminal,
        Answers::Scripted(_) => PersonKind::Scripted,
    };
    let mut chronicle = Chronicle::new(log, printer.narration(person));
    let (result, was_interrupted) = runtime()?.block_on(async {
        let stop = until_interrupted(printer);
        let result = run_episode(&settings, model.as_ref(), &mut chronicle, stop.clone()).await;
        (result, stop.is_cancelled())
    });
    let result = result.map_err(|error| failure(error.is_refusal(), &error))?;
    if let Some(file) = report_file {
        file.write_json(&result.report)?;
    }
    if let Some(file) = page_file {
        file.write(&page(EpisodePage {
            episode: &result.episode,
            report: &result.report,
            history: &result.history,
            evidence: &result.evidence,
        }))?;
    }
    printer
        .report(&result.report, &result.episode.users)
        .map_err(|error| Failure::Failed(format!("standard output takes no more: {error}")))?;
    let next_step = match (result.report.stopped, &arguments.db) {
        (Stopped::Interrupted | Stopped::Budget, Some(db)) => {
            format!("go on with the same command and --resume; what was learnt is in {}", db.display())
        }
        (Stopped::Interrupted | Stopped::Budget, None) => {
            "with --db FILE a run can go on where it ended, and nothing is lost".to_owned()
        }
        (Stopped::Confident | Stopped::MaxQuestions | Stopped::NothingLeftToAsk, _) => return Ok(()),
    };
    match was_interrupted {
        true => Err(Failure::Failed(format!("the run was interrupted; {next_step}"))),
        false => {
            printer.progress(&format!("This run ended early; {next_step}."));
            Ok(())
        }
    }
}

fn ask(arguments: &AskArguments) -> Result<(), Failure> {
    let reply = runtime()?
        .block_on(coin_host::ask::ask(arguments))
        .map_err(|error| failure(error.is_refusal(), &error))?;
    Printer::new(ResultFormat::Text, Progress::Quiet)
        .text(&reply.text)
        .map_err(|error| Failure::Failed(format!("standard output takes no more: {error}")))?;
    match reply.decision {
        FindDecision::Found => Ok(()),
        FindDecision::Ambiguous | FindDecision::None => Err(Failure::NotFound),
    }
}

fn calibrate(arguments: &CalibrateArguments) -> Result<(), Failure> {
    let out = OutputFile::create(&arguments.out)?;
    let progress = if arguments.quiet { Progress::Quiet } else { Progress::Told };
    let printer = Printer::new(ResultFormat::Text, progress);
    let model = model(&arguments.model, 0, None)?;
    let settings = CalibrateSettings {
        episodes: arguments.episode.clone(),
        levels: arguments.levels(),
        score: arguments.score.into(),
        history: arguments.history.into(),
        withheld: arguments.without.iter().copied().map(Into::into).collect(),
        scoring: arguments.scoring.scoring(model.name()).map_err(Failure::Refused)?,
        concurrency: arguments.model.concurrency,
    };
    let bar = printer.bar(settings.episodes.len(), "homes scored");
    let calibration = runtime()?
        .block_on(calibrate_on(&settings, &model, || bar.inc(1)))
        .map_err(|error| failure(error.is_refusal(), &error))?;
    bar.finish_and_clear();
    out.write_json(&calibration)?;
    for lack in too_few_samples(calibration.samples, settings.levels) {
        printer.progress(&format!(
            "Too few samples for --{} {}: {} things were scored and at least {} are needed, so {} keeps nothing out: \
             {}. Calibrate on more homes.",
            lack.level_name, lack.level, calibration.samples, lack.needed, lack.threshold, lack.consequence,
        ));
    }
    let wanted = households_wanted(settings.levels);
    if calibration.households < wanted {
        printer.progress(&format!(
            "{} calibrated on, and the things of one home are alike: with fewer than {wanted} homes, what --risk {} \
             promises may be missed on average over homes.",
            match calibration.households {
                1 => "One home was".to_owned(),
                many => format!("{many} homes were"),
            },
            calibration.risk,
        ));
    }
    printer.progress(&format!(
        "{}: {} things of {} homes; settled without a question from {:.3} on.",
        arguments.out.display(),
        calibration.samples,
        calibration.households,
        calibration.lambda,
    ));
    Ok(())
}

/// How many homes of a kind are judged without each term, as many as the method's own table has.
const JUDGED_BY_TERMS: usize = 12;

fn experiment(arguments: &ExperimentArguments) -> Result<(), Failure> {
    check_folder(&arguments.out).map_err(|error| failure(true, &error))?;
    let methods: Vec<MethodArgument> = match arguments.methods.is_empty() {
        true => MethodArgument::value_variants().to_vec(),
        false => arguments.methods.clone(),
    };
    let coverage = arguments
        .coverage_protocols
        .iter()
        .map(|&protocol| CoverageHomes { protocol, households: arguments.coverage_homes });
    let settings = ExperimentSettings {
        episodes: arguments.episode.clone(),
        calibrate_on: arguments.calibrate_on.clone(),
        levels: default_levels(),
        methods: methods.into_iter().map(Into::into).collect(),
        trials: usize::try_from(arguments.trials).unwrap_or(usize::MAX),
        seed: arguments.seed,
        concurrency: arguments.model.concurrency,
        coverage: coverage.filter(|homes| homes.households > 0).collect(),
        kinds: arguments
            .terms
            .iter()
            .map(|&protocol| CoverageHomes { protocol, households: JUDGED_BY_TERMS })
            .collect(),
    };
    let progress = if arguments.quiet { Progress::Quiet } else { Progress::Told };
    let printer = Printer::new(ResultFormat::Text, progress);
    let mut bars = printer.bars();
    let model = model(&arguments.model, arguments.seed, None)?;
    let results = runtime()?
        .block_on(coin_host::experiment::run(&settings, model, &mut bars))
        .map_err(|error| failure(error.is_refusal(), &error))?;
    write(&results, &arguments.out).map_err(|error| failure(false, &error))?;
    printer.progress(&format!("Open {} in a browser.", arguments.out.join("index.html").display()));
    printer
        .text(&coin_host::experiment::summary(&results))
        .map_err(|error| Failure::Failed(format!("standard output takes no more: {error}")))
}
