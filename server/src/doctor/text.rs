//! A diagnosis for a person.

use coin_schemas::doctor::{Diagnosis, Level};

/// One line for each finding, in columns, and below it what to do next.
pub(crate) fn render(diagnosis: &Diagnosis) -> String {
    let Diagnosis { program_version, findings, .. } = diagnosis;
    let width = findings.iter().map(|finding| finding.subject.len()).max().unwrap_or(0);
    let mut text = format!("coin-server {program_version}\n\n");
    for finding in findings {
        let level = word(finding.level);
        text.push_str(&format!("{level:<7}  {:<width$}  {}\n", finding.subject, finding.found));
        if let Some(next_step) = &finding.next_step {
            text.push_str(&format!("{:7}  {:width$}  → {next_step}\n", "", ""));
        }
    }
    let count = |level| findings.iter().filter(|finding| finding.level == level).count();
    text.push_str(&format!(
        "\nProblems {}, warnings {}. Nothing was changed.\n",
        count(Level::Problem),
        count(Level::Warning)
    ));
    text
}

fn word(level: Level) -> &'static str {
    match level {
        Level::Ok => "ok",
        Level::Note => "note",
        Level::Warning => "warning",
        Level::Problem => "problem",
    }
}
