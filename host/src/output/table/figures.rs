//! The paper's metrics as a table.

use coin_schemas::household::UsageType;
use coin_schemas::report::{MetricsSummary, Report};
use comfy_table::{Cell, CellAlignment};

use crate::output::Style;
use crate::output::layout::columns;

/// A table of the paper's metrics; empty where the truth is not known.
pub(super) fn accuracy(report: &Report, style: Style) -> String {
    let Some(overall) = &report.metrics.overall else { return String::new() };
    let mut table = columns(style.width);
    let header = ["accuracy", "things", "exact", "Jaccard", "precision", "recall", "F1"];
    table.set_header(header);
    table.add_row(figures("all things", overall));
    for (usage_type, summary) in report.metrics.by_usage_type.iter().flatten() {
        table.add_row(figures(usage_type_in_words(*usage_type), summary));
    }
    for (place, column) in table.column_iter_mut().enumerate() {
        column.set_padding((if place == 0 { 2 } else { 0 }, 2));
        if place > 0 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let mut text = String::new();
    for (place, line) in table.lines().enumerate() {
        let line = line.trim_end();
        text.push_str(&if place == 0 { style.heading(line) } else { line.to_owned() });
        text.push('\n');
    }
    text
}

fn figures(label: &str, summary: &MetricsSummary) -> Vec<Cell> {
    let shares = [
        summary.subset_accuracy,
        summary.mean_jaccard,
        summary.micro_precision,
        summary.micro_recall,
        summary.micro_f1,
    ];
    let mut row = vec![Cell::new(label), Cell::new(summary.objects)];
    row.extend(shares.map(|share| Cell::new(format!("{share:.3}"))));
    row
}

fn usage_type_in_words(usage_type: UsageType) -> &'static str {
    match usage_type {
        UsageType::SingleUser => "used by one",
        UsageType::TemporarySharing => "lent now and then",
        UsageType::MultiUserSharing => "used by several",
    }
}
