//! What a run took, why it ended, and what may be relied on.

use coin_schemas::report::{ContextSource, Cost, Estimator, ExpectedWrong, Gate, Report, Scoring, Stopped};
use coin_server::display::{count, plain_text};

use super::guarantee::guarantee;
use super::{is_unsettled, is_wrong};

/// Each with its label, in the order in which they are read.
pub(crate) fn facts(report: &Report) -> Vec<(&'static str, String)> {
    let cost = &report.cost;
    let mut rows = Vec::new();
    rows.extend(correct(report).map(|correct| ("correct", correct)));
    rows.extend(report.expected_wrong.map(|wrong| ("expected", expected(wrong))));
    rows.extend([("questions", questions(report)), ("ended", ended(report)), ("effort", effort(cost))]);
    if cost.prompt_tokens + cost.completion_tokens > 0 {
        let sent = count(cost.prompt_tokens, "sent", "sent");
        let received = count(cost.completion_tokens, "received", "received");
        rows.push(("tokens", format!("{sent}, {received}")));
    }
    rows.push(("settings", settings(report)));
    rows.push(("guarantee", guarantee(report)));
    rows
}

fn effort(cost: &Cost) -> String {
    let mut parts = vec![count(cost.model_calls, "model call", "model calls")];
    if cost.remembered_replies > 0 {
        parts.push(count(cost.remembered_replies, "remembered reply", "remembered replies"));
    }
    parts.push(count(cost.tool_calls, "tool call", "tool calls"));
    parts.push(duration(cost.seconds));
    parts.join(", ")
}

fn correct(report: &Report) -> Option<String> {
    let judged = report.objects.iter().filter(|object| object.truth.is_some()).count();
    let wrong = report.objects.iter().filter(|object| is_wrong(object)).count();
    (judged > 0).then(|| format!("{} of {}", judged - wrong, count(judged as u64, "owner set", "owner sets")))
}

/// What may be wrong by the run's own probabilities, so that neither doubt nor erring people go unsaid.
fn expected(ExpectedWrong { inferred, answered }: ExpectedWrong) -> String {
    /// What would be shown as none.
    const NONE: f64 = 0.05;
    match (inferred >= NONE, answered >= NONE) {
        (_, true) => {
            format!(
                "{inferred:.1} inferred owner sets wrong, {answered:.1} answered ones if one answer in twenty is"
            )
        }
        (true, false) => format!("{inferred:.1} inferred owner sets wrong"),
        (false, false) => "hardly any owner set wrong".to_owned(),
    }
}

fn settings(report: &Report) -> String {
    let gate = match report.gate {
        Gate::Risk => "risk",
        Gate::Adaptive => "adaptive",
        Gate::Set => "set",
        Gate::Paper => "paper",
        Gate::Always => "always",
        Gate::Never => "never",
    };
    let model = plain_text(&report.model);
    let scoring = scoring(report.parameters.scoring);
    format!("model {model}, {scoring}gate {gate}, seed {}", report.seed)
}

/// How the scores were made; nothing where it was as the paper has it.
fn scoring(scoring: Scoring) -> String {
    let Scoring { estimator, context, batch } = scoring;
    if scoring.is_default() {
        return String::new();
    }
    let by = match estimator {
        Estimator::Model => "its scores alone",
        Estimator::Evidence => return "the evidence model's scores, ".to_owned(),
        Estimator::Fused => "its scores fused with the evidence",
    };
    let from = match context {
        ContextSource::Tools => "context by tool calls",
        ContextSource::Given => "context in the prompt",
    };
    match batch {
        1 => format!("{by}, {from}, "),
        many => format!("{by}, {from} of {many} things at once, "),
    }
}

fn questions(report: &Report) -> String {
    let asked = report.metrics.questions as u64;
    let most = report.parameters.max_questions;
    let answers = match report.parameters.answers.as_str() {
        "simulated" => "a simulated household".to_owned(),
        "terminal" => "somebody at the terminal".to_owned(),
        "scripted" => "a file".to_owned(),
        other => plain_text(other).into_owned(),
    };
    match asked {
        0 => "none".to_owned(),
        _ => format!("{asked} of at most {most}, put to {answers}"),
    }
}

fn ended(report: &Report) -> String {
    let unsettled = report.objects.iter().filter(|object| is_unsettled(report, object)).count();
    let left = match unsettled {
        0 => String::new(),
        many => format!("; {} not settled", count(many as u64, "thing is", "things are")),
    };
    let reason = match report.stopped {
        Stopped::Confident => "the gate finds nothing more to ask",
        Stopped::MaxQuestions => "as many questions as are allowed were asked",
        Stopped::NothingLeftToAsk => "nobody can say more",
        Stopped::Budget => "the tokens that could be spent were spent",
        Stopped::Interrupted => "it was stopped for now",
    };
    format!("{reason}{left}")
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 10.0 => format!("{s:.2} s"),
        s if s < 60.0 => format!("{s:.0} s"),
        s => {
            let whole = s.round() as u64;
            format!("{} min {} s", whole / 60, whole % 60)
        }
    }
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::duration;

    #[rstest]
    #[case(0.0, "0.00 s")]
    #[case(0.4271, "0.43 s")]
    #[case(12.3, "12 s")]
    #[case(59.9, "60 s")]
    #[case(625.8, "10 min 26 s")]
    fn durations_are_short(#[case] seconds: f64, #[case] shown: &str) {
        assert_eq!(duration(seconds), shown);
    }
}
