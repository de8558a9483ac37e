//! `host ask`: a person's words, and what comes of them.

use coin_tests::{EpisodeBuilder, Home, Program};
use rstest::rstest;
use serde_json::json;

/// Bob's mug and two of Mary's, as both have told.
fn told() -> Home {
    let episode = EpisodeBuilder::new()
        .object("1", "mug", [1.0, 0.5, 0.9])
        .object("2", "mug", [4.0, 0.5, 0.9])
        .object("3", "red mug", [7.0, 0.5, 0.9])
        .with("/objects/0/room", json!("kitchen"))
        .with("/objects/1/room", json!("study"));
    let home = Home::of(&episode);
    let mut server = home.server();
    for (id, owner) in [("1", "Bob"), ("2", "Mary"), ("3", "Mary")] {
        server.ok(
            "record_answer",
            json!({"object_id": id, "question": "Whose is this?", "answer": format!("{owner}'s"),
                "ownership": {owner: true}}),
        );
    }
    home
}

fn ask(home: &Home, arguments: &[&str]) -> Program {
    Program::new("host").arg("ask").args(arguments).arg("--db").arg(home.db())
}

#[test]
fn the_thing_is_told_with_its_place_and_why() {
    let run = ask(&told(), &["bring me my mug", "--speaker", "Bob"]).run().expect_code(0);
    let [place, why] = run.stdout.lines().collect::<Vec<_>>()[..] else { panic!("{}", run.stdout) };
    assert_eq!(place, "Mug (id 1) in the kitchen, at 1.00, 0.50, 0.90 m.");
    assert!(why.contains("Bob"), "{why}");
}

#[rstest]
#[case("my mug", "Mary", "Which one do you mean: the mug or the red mug?\n")]
#[case("my red mug", "Tom", "I know of no red mug of yours. I know the red mug, which is Mary's.\n")]
#[case("my violin", "Bob", "I know of no violin.\n")]
fn a_question_or_a_reason_takes_its_place(
    #[case] words: &str,
    #[case] speaker: &str,
    #[case] told_words: &str,
) {
    let run = ask(&told(), &[words, "--speaker", speaker]).run().expect_code(3);
    assert_eq!(run.stdout, told_words);
}

#[test]
fn whose_a_thing_is_comes_first_where_that_is_asked() {
    let run = ask(&told(), &["whose red mug is this?"]).run().expect_code(0);
    assert!(run.stdout.lines().next().unwrap().contains("Mary"), "{}", run.stdout);
    assert!(run.stdout.ends_with("Red Mug (id 3), at 7.00, 0.50, 0.90 m.\n"), "{}", run.stdout);
}

#[test]
fn the_result_is_there_as_json() {
    let home = told();
    let result = ask(&home, &["my mug", "--speaker", "Bob", "--json"]).run().expect_code(0).json();
    let of_the_tool = home.server().ok("find_object", json!({"query": "my mug", "speaker": "Bob"}));
    assert_eq!(result, of_the_tool);
}

#[test]
fn an_episode_will_do() {
    let episode = coin_tests::small_house();
    let run =
        Program::new("host").args(["ask", "Bob's calculator", "--episode"]).arg(episode).run().expect_code(0);
    assert!(run.stdout.starts_with("Calculator (id 1) in the study"), "{}", run.stdout);
}

#[test]
fn wrong_use_is_refused() {
    let home = told();
    ask(&home, &["my mug", "--speaker", "Bobby"])
        .run()
        .expect_code(2)
        .expect_stderr(&["speaker", "Bobby", "Bob"]);
    Program::new("host").args(["ask", "my mug"]).run().expect_code(2).expect_stderr(&["--db", "--episode"]);
    let missing = home.join("missing.db");
    Program::new("host").args(["ask", "my mug", "--db"]).arg(missing).run().expect_code(2);
}
