//! The paper's tables of results (2 to 6 and 8) with the published figure beside ours, and two of our own: what the schemes cost side by
//! side, and how often the guarantees held.

mod terms;

pub(super) use terms::table as of_terms;

use coin_schemas::experiment::{
    Coverage, ExperimentResults, Guarantee, Method, MethodResults, Metric, MetricSpreads, MetricTest, Spread,
};
use coin_schemas::household::UsageType;

use super::published;
use crate::pages::experiment::method_name;
use crate::pages::table::{Cell, Table};
use crate::pages::thousands;

/// The methods that the paper compares (Tables 2 and 4 to 6), in its order.
const COMPARED: [Method; 6] =
    [Method::Actowl, Method::NlmapLlm, Method::LastUser, Method::Frequency, Method::CoinPaper, Method::Coin];

/// Those of its ablation study (Table 8).
const ABLATED: [Method; 5] =
    [Method::NoQuestions, Method::NoBackground, Method::NoUsage, Method::CoinPaper, Method::Coin];

const METRICS: [(Metric, &str); 5] = [
    (Metric::SubsetAccuracy, "Subset Accuracy"),
    (Metric::MeanJaccard, "Mean Jaccard"),
    (Metric::MicroPrecision, "Micro Precision"),
    (Metric::MicroRecall, "Micro Recall"),
    (Metric::MicroF1, "Micro F1"),
];

const ASTERISK: &str = "Ours, mean ± standard deviation over all runs; in brackets what the paper published. An \
                        asterisk: different from COIN (default gate) by a Mann–Whitney U test with Holm's \
                        correction, p < 0.05. The trials of a method without chance are the same run again and again, \
                        so that between two such methods an asterisk says that they differ on these homes, and not \
                        that they would on others.";

const READ_AS_FIRST: &str = "To be read as Table 2.";

/// All tables, in the order in which they are read.
pub fn tables(results: &ExperimentResults) -> Vec<Table> {
    let mut tables = vec![accuracy(results, "Table 2. All things", None), questions_and_cost(results)];
    for (title, usage_type) in [
        ("Table 4. Things of a single user", UsageType::SingleUser),
        ("Table 5. Things that are borrowed now and then", UsageType::TemporarySharing),
        ("Table 6. Things that several people use", UsageType::MultiUserSharing),
    ] {
        if results.methods.values().any(|method| method.by_usage_type.contains_key(&usage_type)) {
            tables.push(accuracy(results, title, Some(usage_type)));
        }
    }
    tables.push(ablation(results));
    tables.extend(side_by_side(results));
    tables.extend((!results.coverage.is_empty()).then(|| coverage(&results.coverage)));
    tables.push(kruskal_wallis(results));
    tables.extend(results.kinds.iter().map(of_terms));
    tables
}

fn present<'a>(
    results: &'a ExperimentResults,
    methods: &'a [Method],
) -> impl Iterator<Item = (Method, &'a MethodResults)> {
    methods.iter().filter_map(|&method| Some((method, results.methods.get(&method)?)))
}

fn of(spreads: &MetricSpreads, metric: Metric) -> Spread {
    match metric {
        Metric::SubsetAccuracy => spreads.subset_accuracy,
        Metric::MeanJaccard => spreads.mean_jaccard,
        Metric::MicroPrecision => spreads.micro_precision,
        Metric::MicroRecall => spreads.micro_recall,
        Metric::MicroF1 => spreads.micro_f1,
    }
}

/// As the paper rounds: a half goes up in the third decimal.
fn three_decimals(value: f64) -> String {
    format!("{:.3}", (value * 1e3).round() / 1e3)
}

fn spread(value: Spread) -> String {
    format!("{} ± {}", three_decimals(value.mean), three_decimals(value.sd))
}

fn figure(ours: Spread, published: Option<Spread>, mark: &str) -> String {
    match published {
        Some(published) => format!("{}{mark} ({})", spread(ours), spread(published)),
        None => format!("{}{mark}", spread(ours)),
    }
}

fn plain(text: impl Into<String>) -> Cell {
    Cell { text: text.into(), emphasised: false }
}

fn header(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

fn mark(tests: Option<&MetricTest>, method: Method) -> &'static str {
    let significant =
        tests.and_then(|test| test.against_coin.get(&method)).is_some_and(|test| test.significant);
    if significant { "*" } else { "" }
}

fn accuracy_cells(
    results: &ExperimentResults,
    methods: &[Method],
    method: Method,
    of_method: &MethodResults,
    usage_type: Option<UsageType>,
) -> Vec<Cell> {
    let spreads = |of_method: &MethodResults| match usage_type {
        None => Some(of_method.overall),
        Some(kind) => of_method.by_usage_type.get(&kind).copied(),
    };
    let tests = match usage_type {
        None => Some(&results.tests.overall),
        Some(kind) => results.tests.by_usage_type.get(&kind),
    };
    let Some(own) = spreads(of_method) else { return Vec::new() };
    METRICS
        .iter()
        .map(|&(metric, _)| {
            let best = present(results, methods)
                .filter_map(|(_, other)| spreads(other))
                .map(|other| of(&other, metric).mean)
                .fold(f64::NEG_INFINITY, f64::max);
            let ours = of(&own, metric);
            let mark = mark(tests.and_then(|tests| tests.get(&metric)), method);
            Cell {
                text: figure(ours, published::metric(method, usage_type, metric), mark),
                emphasised: three_decimals(ours.mean) == three_decimals(best),
            }
        })
        .collect()
}

fn accuracy(results: &ExperimentResults, title: &str, usage_type: Option<UsageType>) -> Table {
    let columns = std::iter::once("Method").chain(METRICS.iter().map(|&(_, name)| name));
    Table {
        title: title.to_owned(),
        note: if usage_type.is_none() { ASTERISK } else { READ_AS_FIRST }.to_owned(),
        header: columns.map(str::to_owned).collect(),
        rows: present(results, &COMPARED)
            .map(|(method, of_method)| {
                let mut row = vec![plain(method_name(method))];
                row.extend(accuracy_cells(results, &COMPARED, method, of_method, usage_type));
                row
            })
            .collect(),
    }
}

fn ablation(results: &ExperimentResults) -> Table {
    let columns = std::iter::once("Method").chain(METRICS.iter().map(|&(_, name)| name)).chain(["Questions"]);
    Table {
        title: "Table 8. Ablations".to_owned(),
        note: format!(
            "{READ_AS_FIRST} Our ablations are of COIN with its default gate, the paper's of its own; the embedded model \
             reads a role or an occupation only where common sense knows the class."
        ),
        header: columns.map(str::to_owned).collect(),
        rows: present(results, &ABLATED)
            .map(|(method, of_method)| {
                let mut row = vec![plain(method_name(method))];
                row.extend(accuracy_cells(results, &ABLATED, method, of_method, None));
                row.push(plain(match method {
                    Method::NoQuestions => "–".to_owned(),
                    _ => questions(method, of_method),
                }));
                row
            })
            .collect(),
    }
}

fn questions(method: Method, of_method: &MethodResults) -> String {
    counted(of_method.questions, published::questions(method), 1)
}

/// A count with its published counterpart, thousands apart.
fn counted(ours: Spread, published: Option<Spread>, decimals: usize) -> String {
    let show =
        |spread: Spread| format!("{} ± {}", thousands(spread.mean, decimals), thousands(spread.sd, decimals));
    match published {
        Some(published) => format!("{} ({})", show(ours), show(published)),
        None => show(ours),
    }
}

fn questions_and_cost(results: &ExperimentResults) -> Table {
    Table {
        title: "Table 3. Questions, time and tokens of the methods that ask".to_owned(),
        note: "Per run; in brackets what the paper published, whose model is a language model behind a network. Where \
               the model counts no tokens itself, its conversations are counted with the o200k tokenizer: what a \
               language model in its place would have been charged."
            .to_owned(),
        header: header(&["Method", "Questions", "Model calls", "Tokens", "Seconds"]),
        rows: present(results, &[Method::Actowl, Method::CoinPaper, Method::Coin])
            .map(|(method, of_method)| {
                vec![
                    plain(method_name(method)),
                    plain(questions(method, of_method)),
                    plain(counted(of_method.model_calls, None, 0)),
                    plain(counted(of_method.tokens, published::tokens(method), 0)),
                    plain(counted(of_method.seconds, published::seconds(method), 3)),
                ]
            })
            .collect(),
    }
}

/// The paper's scheme of inference against ours, on the same episodes with the same model.
fn side_by_side(results: &ExperimentResults) -> Option<Table> {
    let (paper, ours) = (results.methods.get(&Method::CoinPaper)?, results.methods.get(&Method::Coin)?);
    let row = |name: &str, paper: Spread, ours: Spread, decimals: usize| {
        let share = match paper.mean {
            0.0 => "–".to_owned(),
            mean => format!("{:.3}", ours.mean / mean),
        };
        vec![
            plain(name),
            plain(thousands(paper.mean, decimals)),
            plain(thousands(ours.mean, decimals)),
            plain(share),
        ]
    };
    Some(Table {
        title: "What the two schemes cost".to_owned(),
        note: "Means over the same runs. The paper's scheme infers every unasked thing again after every answer; ours \
               has the evidence weighed without a model, which is asked only where its word could settle something."
            .to_owned(),
        header: header(&["", "The paper's scheme", "Ours", "Ours / the paper's"]),
        rows: vec![
            row("Model calls", paper.model_calls, ours.model_calls, 1),
            row("Tokens", paper.tokens, ours.tokens, 0),
            row("Questions", paper.questions, ours.questions, 1),
        ],
    })
}

fn coverage(coverage: &[Coverage]) -> Table {
    let promise = |row: &Coverage| match row.guarantee {
        Guarantee::AnyOwner => "Γ holds at least one true owner",
        Guarantee::AllOwners => "Γ holds all true owners",
        Guarantee::OwnerSet => "the set gate's prediction set holds the true owner set",
        Guarantee::SettledWrong => "settled at once by the risk gate, and wrong",
        Guarantee::WrongInTheEnd => "wrong after the risk gate's questions (aimed at, not promised)",
        Guarantee::WrongDespiteErrors => "the same where one answer in twenty is wrong",
        Guarantee::WrongAdapted => "wrong after the adaptive gate's questions",
        Guarantee::WrongAdaptedDespiteErrors => "the same where one answer in twenty is wrong",
    };
    Table {
        title: "How often the guarantees held".to_owned(),
        note: "On homes that were made for this and used for nothing else. The interval is the exact binomial \
               (Clopper–Pearson) one at 95 %; the things of one home are alike, so the truth may lie a little further \
               out. A guarantee is one about the mean over calibration sets, and one set may lie beside it: *over \
               splits* is the mean over 200 random splits of these and the calibration homes. What risk control \
               promises is about the state before the first question; an answer can lift another thing over the \
               threshold, and what is wrong in the end is measured, not promised. The guarantees are about homes of \
               the kind that was calibrated on; other kinds are shown to see what is lost, and how much of that the \
               adaptive gate, which goes by the answers of the home itself, gets back. Questions are means over homes."
            .to_owned(),
        header: header(&["Homes", "Guarantee", "Promised", "Measured", "95 % interval", "Over splits", "Questions", "Things", "Households"]),
        rows: coverage
            .iter()
            .map(|row| {
                let sign = if row.guarantee.is_loss() { "≤" } else { "≥" };
                vec![
                    plain(row.protocol.clone()),
                    plain(promise(row)),
                    plain(format!("{sign} {}", three_decimals(row.promised))),
                    plain(format!("{:.4}", row.share)),
                    plain(format!("{:.4} … {:.4}", row.low, row.high)),
                    plain(row.over_splits.map_or("–".to_owned(), |share| format!("{share:.4}"))),
                    plain(row.questions.map_or("–".to_owned(), |questions| format!("{questions:.1}"))),
                    plain(thousands(row.things as f64, 0)),
                    plain(row.households.to_string()),
                ]
            })
            .collect(),
    }
}

fn kruskal_wallis(results: &ExperimentResults) -> Table {
    Table {
        title: "Kruskal–Wallis tests over all methods".to_owned(),
        note: "At the last step, over all things. A run is one method in one trial of one episode."
            .to_owned(),
        header: header(&["Metric", "H", "Degrees of freedom", "p"]),
        rows: METRICS
            .iter()
            .filter_map(|(metric, name)| {
                let test = results.tests.overall.get(metric)?.kruskal_wallis?;
                Some(vec![
                    plain(*name),
                    plain(format!("{:.2}", test.h)),
                    plain(test.degrees_of_freedom.to_string()),
                    plain(if test.p < 0.001 { "< 0.001".to_owned() } else { three_decimals(test.p) }),
                ])
            })
            .collect(),
    }
}

/// The methods with their accuracy, questions and cost, for the terminal.
pub fn summary(results: &ExperimentResults) -> String {
    let mut table = comfy_table::Table::new();
    table.load_preset(comfy_table::presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(["Method", "Subset Accuracy", "Questions", "Model calls", "Tokens"]);
    let mut methods: Vec<(&Method, &MethodResults)> = results.methods.iter().collect();
    methods.sort_by(|left, right| {
        let accuracy = |of: &MethodResults| of.overall.subset_accuracy.mean;
        accuracy(right.1).total_cmp(&accuracy(left.1))
    });
    for (&method, of_method) in methods {
        table.add_row([
            method_name(method).to_owned(),
            spread(of_method.overall.subset_accuracy),
            counted(of_method.questions, None, 1),
            thousands(of_method.model_calls.mean, 0),
            thousands(of_method.tokens.mean, 0),
        ]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(comfy_table::CellAlignment::Right);
    }
    format!("{table}\n")
}
