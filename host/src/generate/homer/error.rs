//! Why HOMER's data are refused: which file, what stands there, what may stand there.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::data::{HISTOGRAMS, PERSONAS, SCENE, SCRIPTS, SLOTS};
use super::sampler::{COMING_HOME, DAYS_TRIED, LEAVING_HOME};
use super::script::Verb;

/// Why the data cannot be used. The whole reason is in the message, so nothing is named as its source: whoever prints
/// the chain would say it twice.
#[derive(Debug, Error)]
pub enum HomerError {
    /// A file or folder cannot be read.
    #[error(
        "cannot read {}: {reason}; --data names the folder that holds {SCRIPTS}, {PERSONAS}, {HISTOGRAMS} and {SCENE}",
        path.display()
    )]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// A file is damaged or no text.
    #[error("{}, line {line}: this is not UTF-8 text; take the file from the data set again", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
    },
    /// A file is not in its form.
    #[error("{} is not in HOMER's form: {reason}", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// Where it differs.
        reason: serde_json::Error,
    },
    /// A histogram has another length.
    #[error(
        "{}, cluster {cluster} of {activity:?}: {given} numbers are given, and there must be {SLOTS}, one for each hour \
         from 06:00 to midnight",
        path.display()
    )]
    HistogramLength {
        /// The file.
        path: PathBuf,
        /// The activity.
        activity: String,
        /// The cluster.
        cluster: usize,
        /// How many numbers it has.
        given: usize,
    },
    /// A histogram holds what is no share.
    #[error(
        "{}, cluster {cluster} of {activity:?}: {given} is given for the hour from {hour:02}:00, and a share is 0 to 1",
        path.display()
    )]
    HistogramShare {
        /// The file.
        path: PathBuf,
        /// The activity.
        activity: String,
        /// The cluster.
        cluster: usize,
        /// The hour of the day.
        hour: usize,
        /// What stands there.
        given: f64,
    },
    /// A persona names a cluster that is not there.
    #[error(
        "{}, {activity:?} of {persona:?}: cluster {cluster} is given, and {HISTOGRAMS} holds {known} of this activity, \
         counted from 0",
        path.display()
    )]
    UnknownCluster {
        /// The file.
        path: PathBuf,
        /// The persona.
        persona: String,
        /// The activity.
        activity: String,
        /// The cluster.
        cluster: usize,
        /// How many clusters the activity has.
        known: usize,
    },
    /// A persona does what nobody wrote a script for.
    #[error(
        "{}, {activity:?} of {persona:?}: there is no script of it; put one into {SCRIPTS}/{activity}, or take the \
         activity from the persona (null)",
        path.display()
    )]
    NoScript {
        /// The file.
        path: PathBuf,
        /// The persona.
        persona: String,
        /// The activity.
        activity: String,
    },
    /// A persona never does anything.
    #[error(
        "{}, {persona:?}: every hour of every activity at home is empty; give it clusters of {HISTOGRAMS} that are not",
        path.display()
    )]
    IdlePersona {
        /// The file.
        path: PathBuf,
        /// The persona.
        persona: String,
    },
    /// A persona goes out for good.
    #[error(
        "{}, {persona:?}: after {LEAVING_HOME} there is no {COMING_HOME} before midnight, on none of {DAYS_TRIED} \
         sampled days; give {COMING_HOME} a cluster of {HISTOGRAMS} with a share in a later hour",
        path.display()
    )]
    NeverHome {
        /// The file.
        path: PathBuf,
        /// The persona.
        persona: String,
    },
    /// A script does what is not known.
    #[error("{}, line {line}: [{given}] is no verb of HOMER's; its verbs are {}", path.display(), Verb::names())]
    UnknownVerb {
        /// The script.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The verb that stands there.
        given: String,
    },
    /// A step has too few things or too many.
    #[error(
        "{}, line {line}: [{}] takes {} (such as `<bowl> (1024)`), and {given} are given",
        path.display(),
        verb.name(),
        verb.takes()
    )]
    Things {
        /// The script.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The verb.
        verb: Verb,
        /// How many things stand there.
        given: usize,
    },
    /// A line of a script is not a step.
    #[error("{}, line {line}: {given:?} is no step such as `[GRAB] <bowl> (1024) [5]`", path.display())]
    Step {
        /// The script.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What stands there.
        given: String,
    },
    /// There is nothing to live by.
    #[error("{} holds {what}; take it from the data set again", path.display())]
    Empty {
        /// The file or folder.
        path: PathBuf,
        /// What is missing.
        what: &'static str,
    },
    /// Too few things are used often enough.
    #[error(
        "{}: a home of this kind needs {needed} classes of things with {sessions} or more uses in {days} days, and of \
         {tried} sampled schedules the richest has {found}; add scripts that handle more things, or take another \
         --protocol",
        path.display()
    )]
    TooFewClasses {
        /// The folder.
        path: PathBuf,
        /// How many classes are needed.
        needed: usize,
        /// The most that there were.
        found: usize,
        /// How many sessions each must have.
        sessions: usize,
        /// In how many days.
        days: usize,
        /// How many schedules were sampled.
        tried: usize,
    },
    /// HOMER is a home.
    #[error(
        "HOMER is a home and knows no office; take another protocol, or `host generate routine --protocol office`"
    )]
    NoSuchPlace,
}
