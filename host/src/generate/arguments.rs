//! `host generate`: what the commands take and do.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use super::homer::HomerData;
use super::{GeneratedEpisode, Protocol, RoutineSettings, generate, generate_homer, write};

/// Writes homes of our own making: people with their week, their things, what was seen of it, and the truth.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct GenerateArguments {
    /// The kind of home
    #[arg(long, value_enum, default_value_t = Protocol::Week)]
    pub protocol: Protocol,
    /// The seed: the same protocol and seed give the same files, byte for byte
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// How many homes to write; with more than one, each goes to OUT/PROTOCOL-SEED for SEED, SEED+1, …
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub count: u64,
    /// The folder to write to: new, empty, or an episode, which is replaced
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Writes homes that live by schedules sampled from the HOMER data set.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct HomerArguments {
    /// The data set's folder: the one that holds executableScriptsByActivity and personaBasedSchedules
    #[arg(long, value_name = "DIR")]
    pub data: PathBuf,
    /// Which homes
    #[command(flatten)]
    pub homes: GenerateArguments,
}

/// Writes homes of our own routines. A failure names the folder, and the homes before it are there.
pub fn run(arguments: &GenerateArguments) -> anyhow::Result<()> {
    write_homes(arguments, |settings| Ok(generate(settings)))
}

/// Writes homes that live by HOMER.
pub fn run_homer(arguments: &HomerArguments) -> anyhow::Result<()> {
    let data = HomerData::read(&arguments.data)?;
    write_homes(&arguments.homes, |settings| Ok(generate_homer(settings, &data)?))
}

fn write_homes(
    arguments: &GenerateArguments,
    home: impl Fn(&RoutineSettings) -> anyhow::Result<GeneratedEpisode>,
) -> anyhow::Result<()> {
    for step in 0..arguments.count {
        let seed = arguments
            .seed
            .checked_add(step)
            .context("the seeds run past the largest one; give a smaller --seed or --count")?;
        let episode = home(&RoutineSettings { seed, protocol: arguments.protocol })?;
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
