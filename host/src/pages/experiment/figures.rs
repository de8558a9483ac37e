//! The figures of an experiment: the paper's, and those that it lacks.

use std::borrow::Cow;

use coin_schemas::experiment::{
    ExperimentResults, Guarantee, KindResults, Method, MethodResults, StepSpread,
};
use coin_schemas::household::UsageType;
use maud::Markup;

use super::method_name;
use crate::pages::chart::{
    Bar, BarChart, BarGroup, Dot, Interval, IntervalChart, LineChart, Look, Point, ScatterChart, Series,
    Shape, tenth_below,
};
use crate::pages::thousands;

/// A figure in a file of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// The file's name.
    pub file_name: Cow<'static, str>,
    /// What it shows, in a few words.
    pub title: String,
    /// How to read it.
    pub caption: String,
    /// The figure.
    pub svg: String,
}

const ASKING: [Method; 3] = [Method::Coin, Method::CoinPaper, Method::Actowl];
const ABLATED: [Method; 4] = [Method::Coin, Method::NoBackground, Method::NoUsage, Method::NoQuestions];
const QUESTIONS: &str = "questions asked";
const ACCURACY: &str = "Subset Accuracy";
const BAND: &str =
    "The band is one standard deviation over the runs; a run that has stopped stays at its last value.";

/// Every figure for which there is something to show.
pub fn figures(results: &ExperimentResults) -> Vec<Figure> {
    let mut figures = vec![by_question(results)];
    for (file_name, title, usage_type) in [
        ("accuracy-by-question-single-user.svg", "Things of a single user", UsageType::SingleUser),
        (
            "accuracy-by-question-temporary-sharing.svg",
            "Things that are borrowed now and then",
            UsageType::TemporarySharing,
        ),
        (
            "accuracy-by-question-multi-user-sharing.svg",
            "Things that several people use",
            UsageType::MultiUserSharing,
        ),
    ] {
        if results.methods.values().any(|of| of.curve_by_usage_type.contains_key(&usage_type)) {
            figures.push(by_question_and_type(results, file_name, title, usage_type));
        }
    }
    figures.push(ablation(results));
    figures.push(questions_and_accuracy(results));
    figures.push(survival(results));
    figures.push(by_method(results));
    figures.extend(cost(results));
    figures.extend(coverage(results));
    figures.extend(results.kinds.iter().map(of_kind));
    figures
}

fn figure(
    file_name: impl Into<Cow<'static, str>>,
    title: &str,
    caption: impl Into<String>,
    svg: Markup,
) -> Figure {
    Figure {
        file_name: file_name.into(),
        title: title.to_owned(),
        caption: caption.into(),
        svg: svg.into_string(),
    }
}

fn look(method: Method) -> Look {
    Look(match method {
        Method::Coin => 0,
        Method::CoinPaper => 1,
        Method::Actowl => 2,
        Method::NoBackground => 3,
        Method::NoUsage => 4,
        Method::NoQuestions => 5,
        Method::NlmapLlm => 6,
        Method::LastUser => 7,
        Method::Frequency => 8,
    })
}

fn present<'a>(
    results: &'a ExperimentResults,
    methods: &'a [Method],
) -> impl Iterator<Item = (Method, &'a MethodResults)> {
    methods.iter().filter_map(|&method| Some((method, results.methods.get(&method)?)))
}

fn points(curve: &[StepSpread]) -> Vec<Point> {
    curve.iter().map(|step| Point { x: step.step as f64, y: step.mean, spread: step.sd }).collect()
}

fn series(method: Method, curve: &[StepSpread]) -> Series {
    let shape = if curve.len() == 1 { Shape::Level } else { Shape::Line };
    Series {
        name: method_name(method).to_owned(),
        look: look(method),
        shape,
        points: points(curve),
        strokes: Vec::new(),
    }
}

/// Where each curve begins and ends, in words.
fn described(series: &[Series]) -> String {
    let each = series.iter().filter_map(|series| {
        let (first, last) = (series.points.first()?, series.points.last()?);
        Some(format!("{}: {:.3} at first, {:.3} after {} questions", series.name, first.y, last.y, last.x))
    });
    format!("{}.", each.collect::<Vec<_>>().join("; "))
}

fn curves(title: &str, series: Vec<Series>) -> Markup {
    LineChart {
        title: title.to_owned(),
        description: described(&series),
        x_label: QUESTIONS.to_owned(),
        y_label: ACCURACY.to_owned(),
        lowest: tenth_below(
            series.iter().flat_map(|series| &series.points).map(|point| point.y - point.spread),
        ),
        series,
    }
    .svg()
}

fn by_question(results: &ExperimentResults) -> Figure {
    let title = "Accuracy by question";
    let drawn = present(results, &ASKING).map(|(method, of)| series(method, &of.curve)).collect();
    let caption = format!("The methods that ask, over all things. {BAND}");
    figure("accuracy-by-question.svg", title, caption, curves(title, drawn))
}

/// What a question is worth on homes of a kind: whoever goes on asking, the paper's gate, and who knows what is wrong.
fn of_kind(kind: &KindResults) -> Figure {
    let title = format!("Accuracy by question: {}", kind.protocol);
    let named = |name: &str, place: usize, curve: &[StepSpread]| Series {
        name: name.to_owned(),
        look: Look(place),
        shape: if curve.len() == 1 { Shape::Level } else { Shape::Line },
        points: points(curve),
        strokes: Vec::new(),
    };
    let drawn = vec![
        named("COIN, asking on", 0, &kind.asked_on),
        named(method_name(Method::CoinPaper), 1, &kind.paper),
        named("oracle: the wrong ones first", 5, &kind.oracle),
    ];
    let stops = kind.terms.iter().find(|row| row.left_out.is_none()).map_or(String::new(), |row| {
        format!(
            " The default gate stops after {:.1} questions on average, with {:.3} right.",
            row.questions.mean, row.in_the_end.mean
        )
    });
    let caption = format!(
        "{} homes that were made for this. COIN asks about everything here, the least sure first.{stops} {BAND}",
        kind.households
    );
    let svg = curves(&title, drawn);
    figure(format!("curve-{}.svg", kind.protocol), &title, caption, svg)
}

fn by_question_and_type(
    results: &ExperimentResults,
    file_name: &'static str,
    title: &str,
    usage_type: UsageType,
) -> Figure {
    let drawn = present(results, &ASKING)
        .filter_map(|(method, of)| Some(series(method, of.curve_by_usage_type.get(&usage_type)?)))
        .collect();
    figure(
        file_name,
        title,
        "The same for one usage type; questions about other things count too.",
        curves(title, drawn),
    )
}

fn ablation(results: &ExperimentResults) -> Figure {
    let title = "What each part is worth";
    let drawn = present(results, &ABLATED).map(|(method, of)| series(method, &of.curve)).collect();
    let caption = format!("COIN with one part left out. {BAND}");
    figure("ablation.svg", title, caption, curves(title, drawn))
}

fn questions_and_accuracy(results: &ExperimentResults) -> Figure {
    let title = "Questions against accuracy";
    let dots: Vec<Dot> = results
        .methods
        .iter()
        .map(|(&method, of)| Dot {
            name: method_name(method).to_owned(),
            look: look(method),
            x: of.questions.mean,
            y: of.overall.subset_accuracy.mean,
        })
        .collect();
    let path = |name: &str, look, curve: &[StepSpread]| Series {
        name: name.to_owned(),
        look,
        shape: Shape::Line,
        points: points(curve),
        strokes: Vec::new(),
    };
    let mut paths = Vec::new();
    if let Some(coin) = results.methods.get(&Method::Coin) {
        paths.push(path("the way of COIN (default gate)", Look(0), &coin.curve));
    }
    if !results.oracle.is_empty() {
        paths.push(path("oracle: only what is wrong", Look(6), &results.oracle));
    }
    let named = dots.iter().map(|dot| format!("{}: {:.1} questions, {:.3}", dot.name, dot.x, dot.y));
    let chart = ScatterChart {
        title: title.to_owned(),
        description: format!("{}.", named.collect::<Vec<_>>().join("; ")),
        x_label: QUESTIONS.to_owned(),
        y_label: ACCURACY.to_owned(),
        lowest: tenth_below(dots.iter().map(|dot| dot.y)),
        dots,
        paths,
    };
    let caption = "Every method where it ends: up and to the left is better. The oracle asks about exactly the things \
                   that are wrong at once, which nobody can know; above it one gets only by answers that settle more than \
                   their own thing.";
    figure("questions-and-accuracy.svg", title, caption, chart.svg())
}

fn survival(results: &ExperimentResults) -> Figure {
    let title = "Reaching the target";
    let shown = [Method::Coin, Method::CoinPaper, Method::Actowl, Method::NoUsage];
    let last_steps = present(results, &shown).filter_map(|(_, of)| of.survival.last());
    let last_step = last_steps.map(|step| step.step).max().unwrap_or(0) as f64;
    let drawn: Vec<Series> = present(results, &shown)
        .map(|(method, of)| {
            let start = Point { x: 0.0, y: 0.0, spread: 0.0 };
            let steps = of.survival.iter().map(|step| Point {
                x: step.step as f64,
                y: 1.0 - step.survival,
                spread: 0.0,
            });
            // A run that has reached the target stays there.
            let end =
                of.survival.last().map(|step| Point { x: last_step, y: 1.0 - step.survival, spread: 0.0 });
            let censored = of.survival.iter().filter(|step| step.censored > 0);
            Series {
                name: method_name(method).to_owned(),
                look: look(method),
                shape: Shape::Steps,
                points: std::iter::once(start).chain(steps).chain(end).collect(),
                strokes: censored.map(|step| (step.step as f64, 1.0 - step.survival)).collect(),
            }
        })
        .collect();
    let chart = LineChart {
        title: title.to_owned(),
        description: described(&drawn),
        x_label: QUESTIONS.to_owned(),
        y_label: format!("share of runs at {:.2} or better", results.target_accuracy),
        lowest: 0.0,
        series: drawn,
    };
    let caption = format!(
        "Kaplan–Meier: the share of runs that have reached a Subset Accuracy of {:.2}. An upright stroke: runs that \
         ended there without reaching it.",
        results.target_accuracy
    );
    figure("reaching-the-target.svg", title, caption, chart.svg())
}

fn by_method(results: &ExperimentResults) -> Figure {
    let title = "Accuracy by method and usage type";
    let mut methods: Vec<(Method, &MethodResults)> =
        results.methods.iter().map(|(&method, of)| (method, of)).collect();
    methods.sort_by(|left, right| {
        let accuracy = |of: &MethodResults| of.overall.subset_accuracy.mean;
        accuracy(right.1).total_cmp(&accuracy(left.1))
    });
    let groups: Vec<BarGroup> = methods
        .into_iter()
        .map(|(method, of)| {
            let bar = |name: &str, look, spread: coin_schemas::experiment::Spread| Bar {
                name: name.to_owned(),
                look: Look(look),
                value: spread.mean,
                spread: spread.sd,
                label: format!("{:.3}", spread.mean),
            };
            let mut bars = vec![bar("all", 0, of.overall.subset_accuracy)];
            for (usage_type, name, look) in [
                (UsageType::SingleUser, "single user", 2),
                (UsageType::TemporarySharing, "borrowed", 1),
                (UsageType::MultiUserSharing, "several users", 3),
            ] {
                bars.extend(of.by_usage_type.get(&usage_type).map(|of| bar(name, look, of.subset_accuracy)));
            }
            BarGroup { name: method_name(method).to_owned(), bars }
        })
        .collect();
    let chart = BarChart {
        title: title.to_owned(),
        description: bars_in_words(&groups),
        label: ACCURACY.to_owned(),
        highest: 1.0,
        groups,
    };
    figure(
        "accuracy-by-method.svg",
        title,
        "At the end of each run; the thin line is one standard deviation.",
        chart.svg(),
    )
}

/// Every bar's value, in words.
fn bars_in_words(groups: &[BarGroup]) -> String {
    let each = groups.iter().map(|group| {
        let bars: Vec<String> = group.bars.iter().map(|bar| format!("{} {}", bar.name, bar.label)).collect();
        format!("{}: {}", group.name, bars.join(", "))
    });
    format!("{}.", each.collect::<Vec<_>>().join("; "))
}

/// Both schemes as parts of the paper's; nothing where one of them did not run.
fn cost(results: &ExperimentResults) -> Option<Figure> {
    let title = "What the two schemes cost";
    let (papers, ours) = (results.methods.get(&Method::CoinPaper)?, results.methods.get(&Method::Coin)?);
    let group = |name: &str, papers: f64, ours: f64| {
        let part = |value: f64| if papers > 0.0 { value / papers } else { 0.0 };
        let bar = |method: Method, value: f64| Bar {
            name: if method == Method::Coin { "ours" } else { "the paper's" }.to_owned(),
            look: look(method),
            value: part(value),
            spread: 0.0,
            label: thousands(value, 0),
        };
        BarGroup {
            name: name.to_owned(),
            bars: vec![bar(Method::CoinPaper, papers), bar(Method::Coin, ours)],
        }
    };
    let groups = vec![
        group("Model calls", papers.model_calls.mean, ours.model_calls.mean),
        group("Tokens", papers.tokens.mean, ours.tokens.mean),
        group("Questions", papers.questions.mean, ours.questions.mean),
    ];
    let highest = groups.iter().flat_map(|group| &group.bars).map(|bar| bar.value).fold(1.0, f64::max);
    let chart = BarChart {
        title: title.to_owned(),
        description: bars_in_words(&groups),
        label: "as a part of the paper's scheme".to_owned(),
        highest,
        groups,
    };
    Some(figure("cost.svg", title, "Means over the same runs, with the same model.", chart.svg()))
}

fn coverage(results: &ExperimentResults) -> Option<Figure> {
    let title = "How often the guarantees held";
    if results.coverage.is_empty() {
        return None;
    }
    let rows: Vec<Interval> = results
        .coverage
        .iter()
        .map(|row| {
            // Everything is drawn as what should be, so that right of the promise is good in every row.
            let is_loss = row.guarantee.is_loss();
            let turned = |share: f64| if is_loss { 1.0 - share } else { share };
            let (low, high) = if is_loss { (turned(row.high), turned(row.low)) } else { (row.low, row.high) };
            let name = match row.guarantee {
                Guarantee::AnyOwner => "Γ holds at least one true owner",
                Guarantee::AllOwners => "Γ holds all true owners",
                Guarantee::OwnerSet => "the prediction set holds the true owner set",
                Guarantee::SettledWrong => "not settled wrongly at once",
                Guarantee::WrongInTheEnd => "right after the questions",
                Guarantee::WrongDespiteErrors => "right though answers are wrong",
                Guarantee::WrongAdapted => "right after the adaptive gate",
                Guarantee::WrongAdaptedDespiteErrors => "the same though answers are wrong",
            };
            Interval {
                name: format!("{name} ({}, {} homes)", row.protocol, row.households),
                share: turned(row.share),
                low,
                high,
                promised: turned(row.promised),
            }
        })
        .collect();
    let each = rows.iter().map(|row| {
        format!(
            "{}: {:.4}, between {:.4} and {:.4}, promised {:.3}",
            row.name, row.share, row.low, row.high, row.promised
        )
    });
    let chart = IntervalChart {
        title: title.to_owned(),
        description: format!("{}.", each.collect::<Vec<_>>().join("; ")),
        label: "share of things".to_owned(),
        rows,
    };
    let caption = "On homes that were used for nothing else, with the exact binomial interval at 95 %. The upright stroke \
                   is what was promised: at or right of it the promise was kept.";
    Some(figure("coverage.svg", title, caption, chart.svg()))
}
