use std::sync::{Arc, Mutex};

use coin_schemas::household::Background;

use super::*;
use crate::output::Colour;

/// A stderr that can be read afterwards.
#[derive(Clone, Default)]
struct Heard(Arc<Mutex<Vec<u8>>>);

impl Write for Heard {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Heard {
    fn text(&self) -> String {
        String::from_utf8(self.0.lock().unwrap().clone()).unwrap()
    }
}

fn owners(names: &str) -> Owners {
    names.split_whitespace().map(|name| UserName::new(name).unwrap()).collect()
}

fn changed(id: &str, class: &str, before: &str, after: &str) -> Changed {
    Changed {
        object_id: ObjectId::new(id).unwrap(),
        class: ClassLabel::new(class).unwrap(),
        before: owners(before),
        after: owners(after),
    }
}

fn started(person: PersonKind) -> (Narration, Heard) {
    let heard = Heard::default();
    let style = Style { width: 80, colour: Colour::Never };
    let mut narration = Narration::new(Box::new(heard.clone()), style, person, Bars::Hidden);
    let users: Users = owners("Bob Mary Tom").into_iter().map(|name| (name, Background::default())).collect();
    narration.run_started("small-house", &users, 34);
    (narration, heard)
}

fn tell_everything(narration: &mut Narration) {
    let (tom, mary, nobody) = (owners("Tom"), owners("Mary"), Owners::new());
    let speaker = UserName::new("Tom").unwrap();
    narration.inference_started(0, 34);
    narration.object_inferred();
    let scissors = (ObjectId::new("14").unwrap(), ClassLabel::new("scissors").unwrap());
    narration.model_faltered(&scissors.0, &scissors.1, "no answer within 60 s");
    narration.inference_finished();

    narration.question_asked(
        1,
        "Whose is the pencil that lies beside the mug on the desk in the office, and who uses it?",
    );
    narration.inference_started(1, 5);
    narration.inference_finished();
    let read = AnswerRead {
        said_before: None,
        step: 1,
        answer: "Mine.",
        answered_by: Some(&speaker),
        owners: &tom,
        status: AnswerStatus::Answered,
        before: Some(Belief { owners: &mary, confidence: 0.529 }),
        changed: &[changed("12", "eraser", "Bob", "Tom"), changed("15", "book", "Mary", "Bob Mary Tom")],
    };
    narration.answer_read(&read);
    narration.question_asked(2, "Whose is the umbrella?");
    let answer = "I don't know\u{1b}[2J.";
    narration.answer_read(&AnswerRead { answer, status: AnswerStatus::Unresolved, changed: &[], ..read });
    narration.question_asked(3, "And whose is the umbrella, Mary?");
    let answer = "It belongs to a neighbour.";
    narration.answer_read(&AnswerRead { answer, answered_by: None, owners: &nobody, changed: &[], ..read });
    narration.question_asked(4, "Whose is the cup?");
    let before = Some(Belief { owners: &tom, confidence: 0.6 });
    narration.answer_read(&AnswerRead { answer: "Tom", answered_by: None, before, changed: &[], ..read });
    narration.question_asked(5, "Whose are the scissors?");
    narration.answer_read(&AnswerRead { before: None, changed: &[], ..read });
    narration.question_asked(6, "Whose is the pan?");
    narration.declined();
    narration.question_asked(7, "Whose is the pot?");
    narration.nobody_left();
}

#[test]
fn the_story_of_a_run() {
    let (mut narration, heard) = started(PersonKind::Simulated);
    tell_everything(&mut narration);
    insta::assert_snapshot!(heard.text());
}

#[test]
fn somebody_at_the_terminal_does_not_read_the_question_twice() {
    let (mut narration, heard) = started(PersonKind::Terminal);
    tell_everything(&mut narration);
    insta::assert_snapshot!(heard.text());
}

#[test]
fn many_changes_are_counted() {
    let (narration, _) = started(PersonKind::Simulated);
    let many: Vec<Changed> = (1..=8).map(|id| changed(&id.to_string(), "cup", "Bob", "Mary")).collect();
    let text = narration.changes(&many);
    assert!(text.ends_with("cup 6 (Bob → Mary), 2 more"), "{text}");
}

#[test]
fn one_person_lives_alone_with_one_thing() {
    let (mut narration, heard) = started(PersonKind::Simulated);
    let users: Users = [(UserName::new("Ann").unwrap(), Background::default())].into();
    narration.run_started("cell\u{7}", &users, 1);
    assert!(heard.text().ends_with("cell␇: Ann lives here, with 1 thing.\n"), "{}", heard.text());
}

struct Closed;

impl Write for Closed {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::ErrorKind::BrokenPipe.into())
    }
    fn flush(&mut self) -> io::Result<()> {
        Err(io::ErrorKind::BrokenPipe.into())
    }
}

#[test]
fn a_closed_stderr_stops_nothing() {
    let style = Style { width: 80, colour: Colour::Always };
    let mut narration = Narration::new(Box::new(Closed), style, PersonKind::Scripted, Bars::Drawn);
    tell_everything(&mut narration);
    tell_everything(&mut Narration::silent());
}
