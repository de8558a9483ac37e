//! What somebody at the terminal sees.

use coin_schemas::household::{Owners, UserName};
use coin_server::display::{count, names_with_and, percent, plain_text};
use console::{measure_text_width, truncate_str};

use super::choices::Choices;
use crate::output::Style;
use crate::output::layout::labelled;
use crate::person::PutQuestion;

/// Where text begins, behind the number of the question; the same as in the story of the run.
const INDENT: u16 = 2;
const LABEL: u16 = 3;
const MARGIN: u16 = INDENT + LABEL + 2;

/// Where the answer is typed.
pub(super) const PROMPT: &str = "  > ";

/// What stands between two choices.
const GAP: &str = "   ";

/// Room for a number before a name and a percentage behind it.
const BESIDE_NAME: u16 = 10;

/// The question, the choices and what else can be typed.
pub(super) fn question(style: Style, question: &PutQuestion<'_>, choices: &Choices<'_>) -> String {
    let number = format!("Q{}", question.step);
    let text = plain_text(question.question.trim()).into_owned();
    let mut screen = format!("\n{}", labelled(&[(&number, text)], INDENT, LABEL, style.width));
    screen.push_str(&offer(style, choices, 1));
    screen.push_str(&words(style, choices));
    let undo = if question.before.is_some() { " undo," } else { "" };
    screen.push_str(&aside(style, &format!("Or your own words. Also: skip,{undo} stop, help.")));
    if let Some(before) = question.before {
        let household: Owners = choices.candidates().iter().map(|candidate| candidate.name.clone()).collect();
        screen.push_str(&aside(
            style,
            &format!("undo takes back: {}.", plain_text(&before.in_words(&household))),
        ));
    }
    match question.remaining {
        Some(0) => screen.push_str(&aside(style, "This is the last question.")),
        Some(more) => {
            let more = count(more as u64, "more thing", "more things");
            screen.push_str(&aside(style, &format!("After this one, at most {more} to ask about.")));
        }
        None => {}
    }
    screen
}

/// Who "somebody else" is, where not everybody had a number.
pub(super) fn who_else(style: Style, shown: &Choices<'_>, all: &Choices<'_>) -> String {
    let first = shown.numbered().len() + 1;
    let outside = flow(style, &[choice(style, "o", "somebody outside the household")]);
    format!(
        "{}{}{outside}{}",
        remark(style, "Who is it then?"),
        offer(style, all, first),
        aside(style, "undo goes back to the question."),
    )
}

/// Who speaks. `last` is who spoke before.
pub(super) fn who_speaks(style: Style, all: &Choices<'_>, last: Option<&UserName>) -> String {
    let enter = match last {
        Some(name) => {
            format!("Enter: {} again. ? leaves it open. undo goes back.", plain_text(name.as_str()))
        }
        None => "Enter leaves it open. undo goes back.".to_owned(),
    };
    format!("{}{}{}", remark(style, "And who are you?"), offer_names(style, all), aside(style, &enter))
}

/// What can be typed, with an example from the household.
pub(super) fn help(style: Style, choices: &Choices<'_>) -> String {
    let names: Vec<&UserName> =
        choices.candidates().iter().take(2).map(|candidate| &candidate.name).collect();
    let example = if names.is_empty() { "Bob".to_owned() } else { names_with_and(&names) };
    let alone = names.len() < 2;
    let people = if alone {
        ("1", format!("The number picks a person. So does the name: {example}."))
    } else {
        ("1 3", format!("Numbers pick people, one or several. So do names: {example}."))
    };
    let mut rows = vec![
        people,
        ("e", "It belongs to everybody who lives here.".to_owned()),
        ("o", "It belongs to somebody who has no number here.".to_owned()),
        ("?", "You do not know; whose it is stays open.".to_owned()),
        ("…", "Anything else is read as your own words, such as: It's mine, but Tom may use it.".to_owned()),
        ("skip", "Passes this question over.".to_owned()),
        ("undo", "Takes the answer before back and asks that question again.".to_owned()),
        ("stop", "Ends the questions; you can go on another time. So does Ctrl-D.".to_owned()),
    ];
    if alone {
        rows.retain(|(word, _)| *word != "e");
    }
    labelled(&rows, MARGIN, 4, style.width)
}

/// A sentence in the column of the question.
pub(super) fn remark(style: Style, text: &str) -> String {
    labelled(&[("", plain_text(text).into_owned())], INDENT, LABEL, style.width)
}

/// A sentence that is there for whoever looks for it.
fn aside(style: Style, text: &str) -> String {
    let text = remark(style, text);
    format!("{}\n", style.aside(text.trim_end_matches('\n')))
}

/// `1 Tom 62 %   2 Mary 4 %`, from this number on.
fn offer(style: Style, choices: &Choices<'_>, first: usize) -> String {
    let informed = choices.candidates().iter().any(|candidate| candidate.score.value() > 0.0);
    let items: Vec<String> = choices
        .numbered()
        .iter()
        .enumerate()
        .skip(first - 1)
        .map(|(place, candidate)| {
            let item = choice(style, &(place + 1).to_string(), &shortened(style, &candidate.name));
            if informed { format!("{item} {}", style.aside(percent(candidate.score.value()))) } else { item }
        })
        .collect();
    flow(style, &items)
}

/// `1 Tom   2 Mary`.
fn offer_names(style: Style, choices: &Choices<'_>) -> String {
    let names = choices.numbered().iter().enumerate();
    let items: Vec<String> = names
        .map(|(place, candidate)| choice(style, &(place + 1).to_string(), &shortened(style, &candidate.name)))
        .collect();
    flow(style, &items)
}

/// The choices that are no people.
fn words(style: Style, choices: &Choices<'_>) -> String {
    let mut items = Vec::new();
    match choices.candidates().len() {
        0 | 1 => {}
        2 => items.push(choice(style, "e", "both")),
        _ => items.push(choice(style, "e", "everybody")),
    }
    let else_where =
        if choices.hides_others_than(&[]) { "somebody else" } else { "somebody outside the household" };
    items.push(choice(style, "o", else_where));
    items.push(choice(style, "?", "I don't know"));
    let mut text = flow(style, &items);
    for name in choices.clashing() {
        let name = plain_text(name.as_str());
        text.push_str(&aside(style, &format!("“{name}” in quotation marks is the person.")));
    }
    text
}

fn choice(style: Style, key: &str, meaning: &str) -> String {
    format!("{} {meaning}", style.heading(key))
}

/// A name that fits into a line with its number.
fn shortened(style: Style, name: &UserName) -> String {
    let width = usize::from(style.width.saturating_sub(MARGIN + BESIDE_NAME));
    truncate_str(&plain_text(name.as_str()), width, "…").into_owned()
}

/// Items one after the other, none of which is broken between two lines.
fn flow(style: Style, items: &[String]) -> String {
    let width = usize::from(style.width);
    let margin = " ".repeat(usize::from(MARGIN));
    let mut text = String::new();
    let mut column = 0;
    for item in items {
        let length = measure_text_width(item);
        if column > 0 && column + GAP.len() + length <= width {
            text.push_str(GAP);
            column += GAP.len() + length;
        } else {
            if column > 0 {
                text.push('\n');
            }
            text.push_str(&margin);
            column = margin.len() + length;
        }
        text.push_str(item);
    }
    if !text.is_empty() {
        text.push('\n');
    }
    text
}
