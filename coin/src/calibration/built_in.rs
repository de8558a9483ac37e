//! The calibrations of the embedded model that the program carries, for every way in which it is used out of the box.

use std::collections::BTreeSet;

use coin_schemas::calibration::{Calibration, NonconformityScore};
use coin_schemas::report::{ContextSource, Estimator, Gate, Scoring, Withheld};

/// The name of the model that needs no service: the evidence model.
pub const EMBEDDED_MODEL: &str = "embedded";

/// How scores are made where there is no language model: the evidence of the whole home speaks alone.
pub const EMBEDDED_SCORING: Scoring =
    Scoring { estimator: Estimator::Evidence, context: ContextSource::Tools, batch: 1 };

/// The embedded model behind the chat-model interface, which judges each thing by itself as a language model would, with
/// the bare formula.
const BY_TOOL_CALLS: Scoring = Scoring { estimator: Estimator::Model, ..EMBEDDED_SCORING };

/// How the scores were made, what was withheld, the score of prediction sets over members, and the file of it.
const FILES: [(Scoring, &[Withheld], NonconformityScore, &str); 6] = [
    (
        EMBEDDED_SCORING,
        &[],
        NonconformityScore::AllOwners,
        include_str!("../../../fixtures/calibrations/embedded.json"),
    ),
    (
        EMBEDDED_SCORING,
        &[],
        NonconformityScore::AnyOwner,
        include_str!("../../../fixtures/calibrations/embedded-any-owner.json"),
    ),
    (
        EMBEDDED_SCORING,
        &[Withheld::Background],
        NonconformityScore::AllOwners,
        include_str!("../../../fixtures/calibrations/embedded-without-background.json"),
    ),
    (
        EMBEDDED_SCORING,
        &[Withheld::Usage],
        NonconformityScore::AllOwners,
        include_str!("../../../fixtures/calibrations/embedded-without-usage.json"),
    ),
    (
        BY_TOOL_CALLS,
        &[],
        NonconformityScore::AllOwners,
        include_str!("../../../fixtures/calibrations/embedded-by-tool-calls.json"),
    ),
    (
        BY_TOOL_CALLS,
        &[],
        NonconformityScore::AnyOwner,
        include_str!("../../../fixtures/calibrations/embedded-by-tool-calls-any-owner.json"),
    ),
];

/// The score that a gate goes with: the paper's gate with the paper's own, every other with the one whose prediction
/// sets hold all owners.
pub fn score_of(gate: Gate) -> NonconformityScore {
    match gate {
        Gate::Paper => NonconformityScore::AnyOwner,
        Gate::Risk | Gate::Adaptive | Gate::Set | Gate::Always | Gate::Never => NonconformityScore::AllOwners,
    }
}

/// The calibration of the embedded model for scores that are made so, with this score of prediction sets and from a model
/// that was told as much; `None` where the program carries none.
///
/// # Errors
/// If the file that was compiled in is no calibration.
pub fn embedded_calibration(
    scoring: Scoring,
    score: NonconformityScore,
    withheld: &BTreeSet<Withheld>,
) -> Result<Option<Calibration>, serde_json::Error> {
    FILES
        .iter()
        .find(|(made_so, told_without, made_with, _)| {
            (*made_so, *made_with) == (scoring, score) && withheld.iter().eq(told_without.iter())
        })
        .map(|(.., text)| serde_json::from_str(text))
        .transpose()
}
