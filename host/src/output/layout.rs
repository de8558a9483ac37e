//! Columns that the story and the final text share.

use comfy_table::presets::NOTHING;
use comfy_table::{ColumnConstraint, ContentArrangement, Table, Width};

/// A table without lines whose columns stand two apart and whose text wraps inside its column.
pub(super) fn columns(width: u16) -> Table {
    let mut table = Table::new();
    table.load_preset(NOTHING).set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
    table
}

/// Labels on the left, text on the right, which wraps under itself. Every line ends in a line break.
pub(crate) fn labelled(rows: &[(&str, String)], indent: u16, label_width: u16, width: u16) -> String {
    let mut table = columns(width);
    table.add_rows(rows.iter().map(|(label, text)| [(*label).to_owned(), text.clone()]));
    if let Some(column) = table.column_mut(0) {
        column.set_padding((indent, 2));
        column.set_constraint(ColumnConstraint::Absolute(Width::Fixed(indent + label_width + 2)));
    }
    if let Some(column) = table.column_mut(1) {
        column.set_padding((0, 0));
    }
    format!("{}\n", table.trim_fmt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_wraps_under_itself() {
        let text = "Whose is the pencil that lies beside the mug on the desk in the office?";
        insta::assert_snapshot!(labelled(&[("Q1", text.to_owned()), ("", "“Mine.”".to_owned())], 2, 3, 40), @"
        Q1   Whose is the pencil that lies
             beside the mug on the desk in the
             office?
             “Mine.”
        ");
    }
}
