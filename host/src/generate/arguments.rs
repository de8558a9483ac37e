//! `host generate`: what the commands take and do.

use std::path::PathBuf;

use anyhow::Context;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};

use super::homer::HomerData;
use super::{GeneratedEpisode, Protocol, RoutineSettings, generate, generate_homer, write};

/// Writes homes of our own making: people with their week, their things, what was seen of it, and the truth.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct GenerateArguments {
    /// The kind of home
    #[arg(long, value_enum, default_value_t = Protocol::Week)]
    pub protocol: Protocol,
    /// Which of them, and where to
    #[command(flatten)]
    pub homes: HomesArguments,
}

/// Writes homes that live by schedules sampled from the HOMER data set.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct HomerArguments {
    /// The data set's folder: the one that holds executableScriptsByActivity and personaBasedSchedules
    #[arg(long, value_name = "DIR")]
    pub data: PathBuf,
    /// The kind of home
    #[arg(long, value_parser = homer_protocols(), default_value = Protocol::Week.name())]
    pub protocol: Protocol,
    /// Which of them, and where to
    #[command(flatten)]
    pub homes: HomesArguments,
}

/// How many homes of a kind are written, and where to.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct HomesArguments {
    /// The seed: the same protocol, seed and data give the same files, byte for byte
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// How many homes to write, with the seeds SEED, SEED+1, …; with more than one, each goes to a folder of its own in
    /// OUT, named as the home is (week-7; homer-week-7 where it is sampled from HOMER)
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub count: u64,
    /// The folder to write to: new, empty, or an episode, which is replaced
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// The protocols as `generate homer` lists them. The office is understood, so that its refusal can say where there is
/// one, and not listed.
fn homer_protocols() -> impl TypedValueParser<Value = Protocol> {
    let named = Protocol::ALL.into_iter().filter_map(|protocol| {
        let value = protocol.to_possible_value()?;
        Some(match protocol {
            Protocol::Paper => value.help(
                "The paper's family, its numbers of owners and usage types, and about its number of captions",
            ),
            Protocol::Office => value.hide(true),
            _ => value,
        })
    });
    PossibleValuesParser::new(named).try_map(|name| Protocol::from_str(&name, false))
}

/// Writes homes of our own routines. A failure names the folder, and the homes before it are there.
pub fn run(arguments: &GenerateArguments) -> anyhow::Result<()> {
    write_homes(arguments.protocol, &arguments.homes, |settings| Ok(generate(settings)))
}

/// Writes homes that live by HOMER.
pub fn run_homer(arguments: &HomerArguments) -> anyhow::Result<()> {
    let data = HomerData::read(&arguments.data)?;
    write_homes(arguments.protocol, &arguments.homes, |settings| Ok(generate_homer(settings, &data)?))
}

fn write_homes(
    protocol: Protocol,
    arguments: &HomesArguments,
    home: impl Fn(&RoutineSettings) -> anyhow::Result<GeneratedEpisode>,
) -> anyhow::Result<()> {
    for step in 0..arguments.count {
        let seed = arguments
            .seed
            .checked_add(step)
            .context("the seeds run past the largest one; give a smaller --seed or --count")?;
        let episode = home(&RoutineSettings { seed, protocol })?;
        let folder = match arguments.count {
            1 => arguments.out.clone(),
            _ => arguments.out.join(&episode.episode.name),
        };
        write(&episode, &folder)?;
        tracing::info!(
            folder = %folder.display(),
            objects = episode.episode.objects.len(),
            captions = episode.captions.len(),
            "wrote an episode"
        );
    }
    Ok(())
}
