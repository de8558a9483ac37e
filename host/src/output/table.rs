//! The final text of a run: who lives there, whose every thing is, and how good and how dear that was.
//!
//! It says only what the report holds, and it is the same for the same report.

mod figures;
#[cfg(test)]
mod tests;

use std::borrow::Cow;

use coin_schemas::household::{Background, Owners, Users};
use coin_schemas::report::Report;
use coin_server::display::{owners_in_words, plain_text};
use comfy_table::{Cell, CellAlignment, TableComponent};

use super::Style;
use super::conclusions::{facts, how_sure, is_wrong, whose, why};
use super::layout::{columns, labelled};

/// The mark of an owner set that is not the true one.
const WRONG: &str = "✗";

/// The whole text, every line of which ends in a line break and fits the width.
pub fn render(report: &Report, users: &Users, style: Style) -> String {
    let sections = [
        household(report, users, style),
        things(report, &users.keys().cloned().collect(), style),
        figures::accuracy(report, style),
        labelled(&facts(report), 2, 9, style.width),
    ];
    let sections: Vec<String> = sections.into_iter().filter(|section| !section.is_empty()).collect();
    sections.join("\n")
}

fn household(report: &Report, users: &Users, style: Style) -> String {
    let people: Vec<(Cow<'_, str>, String)> = users
        .iter()
        .map(|(name, background)| (plain_text(name.as_str()), background_in_words(background)))
        .collect();
    let rows: Vec<(&str, String)> =
        people.iter().map(|(name, background)| (name.as_ref(), background.clone())).collect();
    let longest = people.iter().map(|(name, _)| name.chars().count()).max().unwrap_or_default();
    let label_width = u16::try_from(longest).unwrap_or(u16::MAX).clamp(1, style.width / 3);
    let title = style.heading(plain_text(&report.episode));
    format!("{title}\n{}", labelled(&rows, 2, label_width, style.width))
}

fn background_in_words(background: &Background) -> String {
    let parts = [&background.role, &background.occupation];
    let parts: Vec<Cow<'_, str>> = parts.into_iter().flatten().map(|part| plain_text(part)).collect();
    parts.join(", ")
}

fn things(report: &Report, household: &Owners, style: Style) -> String {
    let any_wrong = report.objects.iter().any(is_wrong);
    let mut table = columns(style.width);
    table.set_style(TableComponent::HeaderLines, '─');
    let mut header = vec!["id", "thing", "whose", "sure", "why"];
    if any_wrong {
        header.push("in truth");
    }
    table.set_header(header);
    for object in &report.objects {
        let mut row = vec![
            Cell::new(plain_text(object.id.as_str())),
            Cell::new(plain_text(object.class.as_str())),
            Cell::new(whose(object, household)),
            Cell::new(how_sure(object)).set_alignment(CellAlignment::Right),
            Cell::new(why(report, object)),
        ];
        if let (true, Some(truth)) = (any_wrong, &object.truth) {
            let text = format!("{WRONG} {}", owners_in_words(truth, household));
            row.push(Cell::new(if is_wrong(object) { text } else { String::new() }));
        }
        table.add_row(row);
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 2));
    }
    if let Some(ids) = table.column_mut(0) {
        ids.set_padding((2, 2));
        if report.objects.iter().all(|object| object.id.as_str().bytes().all(|byte| byte.is_ascii_digit())) {
            ids.set_cell_alignment(CellAlignment::Right);
        }
    }
    let mut text = String::new();
    for (place, line) in table.lines().enumerate() {
        let line = line.trim_end();
        let line = match place {
            0 => style.heading(line),
            1 => format!("  {}", style.aside(line.chars().skip(2).collect::<String>())),
            _ => line.replace(WRONG, &style.alarm(WRONG)),
        };
        text.push_str(&line);
        text.push('\n');
    }
    text
}
