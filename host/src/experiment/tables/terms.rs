//! What every term of the evidence model is worth, left out one after the other.

use coin_schemas::experiment::{KindResults, Spread, Term, TermResult};

use super::{header, plain, spread, three_decimals};
use crate::pages::table::{Cell, Table};

fn name(left_out: Option<Term>) -> &'static str {
    match left_out {
        None => "nothing: the whole model",
        Some(Term::Class) => "class and people",
        Some(Term::Place) => "place",
        Some(Term::Looks) => "looks",
        Some(Term::Turns) => "turns",
        Some(Term::ChangeOfHands) => "change of hands",
        Some(Term::Habits) => "learning the home's habits",
        Some(Term::BestQuestion) => "the best question",
    }
}

/// One row for the whole model and one without each term.
pub(in crate::experiment) fn table(kind: &KindResults) -> Table {
    let whole = kind.terms.iter().find(|row| row.left_out.is_none()).map(|row| row.questions.mean);
    Table {
        title: format!("What the terms are worth: {}", kind.protocol),
        note: format!(
            "{} homes that were made for this, {} things; every row with thresholds of its own from {} other homes of \
             the kind, so that it keeps the accuracy that it aims at and shows in questions what was left out.",
            kind.households, kind.things, kind.calibrated_on
        ),
        header: header(&[
            "Left out",
            "Right at once",
            "Right in the end",
            "Questions",
            "More than the whole",
        ]),
        rows: kind.terms.iter().map(|row| cells(row, whole)).collect(),
    }
}

fn cells(row: &TermResult, whole: Option<f64>) -> Vec<Cell> {
    let more = match (row.left_out, whole) {
        (Some(_), Some(whole)) => format!("{:+.1}", row.questions.mean - whole),
        _ => "–".to_owned(),
    };
    let Spread { mean, sd } = row.questions;
    vec![
        plain(name(row.left_out)),
        plain(three_decimals(row.at_once.mean)),
        plain(spread(row.in_the_end)),
        plain(format!("{mean:.1} ± {sd:.1}")),
        plain(more),
    ]
}
