//! The calibrations of the embedded model that the program carries, for every way in which it is used out of the box.

use std::collections::BTreeSet;

use coin_schemas::calibration::{Calibration, NonconformityScore};
use coin_schemas::report::{Gate, Withheld};

/// The name of the model that needs no service: the evidence model behind the chat-model interface.
pub const EMBEDDED_MODEL: &str = "embedded";

/// What is withheld, the score of prediction sets over members, and the file that was made so.
const FILES: [(&[Withheld], NonconformityScore, &str); 4] = [
    (&[], NonconformityScore::AllOwners, include_str!("../../../fixtures/calibrations/embedded.json")),
    (
        &[],
        NonconformityScore::AnyOwner,
        include_str!("../../../fixtures/calibrations/embedded-any-owner.json"),
    ),
    (
        &[Withheld::Background],
        NonconformityScore::AllOwners,
        include_str!("../../../fixtures/calibrations/embedded-without-background.json"),
    ),
    (
        &[Withheld::Usage],
        NonconformityScore::AllOwners,
        include_str!("../../../fixtures/calibrations/embedded-without-usage.json"),
    ),
];

/// The score that a gate goes with: the paper's gate with the paper's own, every other with the one whose prediction
/// sets hold all owners.
pub fn score_of(gate: Gate) -> NonconformityScore {
    match gate {
        Gate::Paper => NonconformityScore::AnyOwner,
        Gate::Risk | Gate::Set | Gate::Always | Gate::Never => NonconformityScore::AllOwners,
    }
}

/// The calibration of the embedded model that was made with this score and from a model that was told as much; `None`
/// where the program carries none.
///
/// # Errors
/// If the file that was compiled in is no calibration.
pub fn embedded_calibration(
    score: NonconformityScore,
    withheld: &BTreeSet<Withheld>,
) -> Result<Option<Calibration>, serde_json::Error> {
    FILES
        .iter()
        .find(|(told_without, made_with, _)| *made_with == score && withheld.iter().eq(told_without.iter()))
        .map(|(.., text)| serde_json::from_str(text))
        .transpose()
}
