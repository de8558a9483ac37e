//! What the thresholds of a run promise, in one or two sentences that promise no more than the method does.

use coin_schemas::calibration::{Calibration, History, NonconformityScore};
use coin_schemas::report::{Gate, Report, Stopped};
use coin_server::display::{count, percent, plain_text};

use crate::calibrate::scored_by;

/// What may be relied on, and from what data that follows.
pub(crate) fn guarantee(report: &Report) -> String {
    let Some(calibration) = &report.calibration else { return no_guarantee(report) };
    if let Some(reason) = voids(calibration, report) {
        return format!("none: {reason}.");
    }
    let promise = match report.gate {
        Gate::Risk => risk(calibration),
        Gate::Adaptive => adaptive(calibration, report),
        Gate::Set => format!(
            "with a probability of {} the true owner set of a thing is among its plausible ones, and \
             everything with more than one was up for a question",
            share(1.0 - calibration.alpha)
        ),
        Gate::Paper => format!(
            "{}; everything whose cp_s is above {:.3} was up for a question",
            prediction_sets(calibration),
            calibration.q_cp
        ),
        Gate::Always => return "none is needed: everything was up for a question.".to_owned(),
        Gate::Never => format!("nothing was asked; {}", prediction_sets(calibration)),
    };
    let beyond = match (report.gate, report.stopped) {
        (Gate::Never, _) | (_, Stopped::Confident) => "",
        (_, Stopped::MaxQuestions | Stopped::NothingLeftToAsk | Stopped::Budget | Stopped::Interrupted) => {
            " It does not cover what was still up for a question in the end."
        }
    };
    format!("{promise} ({}).{beyond}", made_from(calibration))
}

/// Why what a calibration promises does not hold in this run.
fn voids(calibration: &Calibration, report: &Report) -> Option<&'static str> {
    if calibration.samples == 0 {
        return Some("the calibration was made from no data. Make one with host calibrate");
    }
    let (model, scoring) = scored_by(&report.model, report.parameters.scoring);
    if calibration.model != model {
        return Some("the thresholds were made for another model, whose scores mean something else");
    }
    if calibration.scoring != scoring {
        return Some("the thresholds were made for scores of another kind, which mean something else");
    }
    if calibration.withheld != report.parameters.withheld {
        return Some("the thresholds were made for a model that was told more or less than this one");
    }
    if calibration.history == History::TrainingDays {
        return Some(
            "the thresholds were made from the first days of homes, and whole histories are scored otherwise",
        );
    }
    if calibration.episodes.contains(&report.episode) {
        return Some(
            "a home of this name is among those that the thresholds were made from, so they know what they judge",
        );
    }
    None
}

fn risk(calibration: &Calibration) -> String {
    let risk = share(calibration.risk);
    if calibration.lambda > 1.0 {
        return format!("no threshold keeps wrong owner sets at {risk}, so everything was up for a question");
    }
    format!(
        "things at least {} sure are settled without a question, and at most {risk} of all things are expected \
         to be settled at once and wrong",
        percent(calibration.lambda)
    )
}

fn adaptive(calibration: &Calibration, report: &Report) -> String {
    let Some(adapted) = &report.adapted else { return risk(calibration) };
    let target = report.parameters.risk.map(share).unwrap_or_default();
    let errors = count(adapted.errors as u64, "answer differed", "answers differed");
    let seen = format!(
        "{errors} from what was thought most probable, where {:.1} were expected to",
        adapted.expected_errors
    );
    match adapted.lambda {
        Some(lambda) => format!(
            "things at least {} sure are settled without a question; {seen}, and by that at most {target} of all \
             things are expected to be wrong in the end, an estimate for this home and no promise over homes",
            percent(lambda)
        ),
        None => {
            format!("{seen}, and by that only asking about everything keeps wrong owner sets at {target}")
        }
    }
}

fn prediction_sets(calibration: &Calibration) -> String {
    let whom = match calibration.score {
        NonconformityScore::AnyOwner => "at least one true owner",
        NonconformityScore::AllOwners => "all true owners",
    };
    format!(
        "with a probability of {} the plausible owners of a thing include {whom}",
        share(1.0 - calibration.alpha)
    )
}

fn made_from(calibration: &Calibration) -> String {
    format!(
        "calibrated on {} of {}",
        count(calibration.samples as u64, "thing", "things"),
        count(calibration.households as u64, "other home", "other homes"),
    )
}

fn no_guarantee(report: &Report) -> String {
    let model = plain_text(&report.model);
    let from = percent(coin::calibration::UNCALIBRATED_CONFIDENCE);
    format!(
        "none: there is no calibration for the model {model}, so things at least {from} sure are settled \
         without knowing how often that is wrong. Make one: host calibrate --model {model} --episode DIR… --out FILE"
    )
}

/// A share in percent, with as many decimals as it needs and at most two.
fn share(share: f64) -> String {
    let percent = format!("{:.2}", share * 100.0);
    format!("{} %", percent.trim_end_matches('0').trim_end_matches('.'))
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    #[rstest]
    #[case(0.012, "1.2 %")]
    #[case(1.0 - 0.2, "80 %")]
    #[case(0.0, "0 %")]
    #[case(0.1, "10 %")]
    #[case(1.0, "100 %")]
    #[case(0.0005, "0.05 %")]
    fn shares_have_no_idle_decimals(#[case] share: f64, #[case] shown: &str) {
        assert_eq!(super::share(share), shown);
    }
}
