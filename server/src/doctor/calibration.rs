//! Whether the thresholds that the program carries can be used.

use std::collections::BTreeSet;

use coin::calibration::{EMBEDDED_SCORING, embedded_calibration};
use coin_schemas::calibration::NonconformityScore;
use coin_schemas::doctor::{Finding, Level};

use super::{advice, finding};

const SUBJECT: &str = "calibration";

pub(super) fn examine() -> Finding {
    match embedded_calibration(EMBEDDED_SCORING, NonconformityScore::AllOwners, &BTreeSet::new()) {
        Ok(Some(calibration)) => finding(
            Level::Ok,
            SUBJECT,
            format!(
                "the built-in thresholds were made from {} things of {} homes",
                calibration.samples, calibration.households
            ),
        ),
        Ok(None) => advice(Level::Problem, SUBJECT, "the program carries no thresholds", "install it again"),
        Err(error) => advice(
            Level::Problem,
            SUBJECT,
            format!("the built-in thresholds cannot be read: {error}"),
            "install the program again",
        ),
    }
}
