//! The folder that an experiment leaves behind.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use coin_schemas::experiment::ExperimentResults;
use thiserror::Error;

use super::tables::tables;
use crate::pages::experiment::{figures, index};

/// The file that makes a folder the result of an experiment.
const RESULTS_FILE: &str = "results.json";

/// Why results were not written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The folder holds other files.
    #[error(
        "{} is not empty and holds no {RESULTS_FILE}, so it is left alone; name an empty or new folder, or one that \
         holds an experiment, which is then replaced",
        folder.display()
    )]
    NotAnExperiment {
        /// The folder.
        folder: PathBuf,
    },
    /// The operating system refused.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What it said.
        source: io::Error,
    },
    /// The results have no JSON form.
    #[error("cannot write {RESULTS_FILE} as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// Refuses a folder in which something else lies, before hours of work end at it.
pub fn check_folder(folder: &Path) -> Result<(), WriteError> {
    let failed = |source| WriteError::Io { path: folder.to_owned(), source };
    let mut entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(failed(error)),
    };
    if entries.next().is_some() && !folder.join(RESULTS_FILE).is_file() {
        return Err(WriteError::NotAnExperiment { folder: folder.to_owned() });
    }
    Ok(())
}

/// Writes `results.json`, `tables.md`, `figures/*.svg` and `index.html`.
pub fn write(results: &ExperimentResults, folder: &Path) -> Result<(), WriteError> {
    check_folder(folder)?;
    let tables = tables(results);
    let figures = figures(results);
    let mut json = serde_json::to_string_pretty(results)?;
    json.push('\n');
    let markdown = markdown(results, &tables);
    let page = index(results, &tables, &figures);

    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| WriteError::Io { path, source }
    };
    let figure_folder = folder.join("figures");
    fs::create_dir_all(&figure_folder).map_err(failed(&figure_folder))?;
    for figure in &figures {
        let path = figure_folder.join(figure.file_name.as_ref());
        fs::write(&path, &figure.svg).map_err(failed(&path))?;
    }
    // The results come last: a folder that holds them is whole.
    for (name, text) in [("tables.md", &markdown), ("index.html", &page), (RESULTS_FILE, &json)] {
        let path = folder.join(name);
        let partial = folder.join(format!("{name}.partial"));
        fs::write(&partial, text).map_err(failed(&partial))?;
        fs::rename(&partial, &path).map_err(failed(&path))?;
    }
    Ok(())
}

/// The tables on one page of Markdown.
fn markdown(results: &ExperimentResults, tables: &[crate::pages::table::Table]) -> String {
    let trials = if results.trials == 1 { "trial" } else { "trials" };
    let mut text = format!(
        "# Whose is this? The paper's experiment, repeated\n\nEpisodes: {}. {} {trials} each, seed {}, model `{}`.\n",
        results.episodes.join(", "),
        results.trials,
        results.seed,
        results.model,
    );
    for table in tables {
        text.push('\n');
        text.push_str(&table.to_markdown());
    }
    text
}
