//! `host ask`: a person's words, and what comes of them.

use std::sync::Arc;

use coin_schemas::episode::FEATURE_DIMENSIONS;
use coin_tests::provider::{Script, ScriptedProvider, refused_url};
use coin_tests::{EpisodeBuilder, Home, Program, feature};
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
fn the_help_says_it_in_plain_characters() {
    let help = Program::new("host").args(["ask", "--help"]).run().expect_code(0).stdout;
    assert!(help.contains("without, \"my\" is nobody's") && help.contains("Exit status: 0"), "{help}");
    assert!(!help.contains('\\'), "{help}");
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

/// Ten vases, each of its own looks.
fn vases() -> Home {
    let mut episode = EpisodeBuilder::new().features((0..10).map(|place| feature(&[(place, 1.0)])));
    for number in 0..10 {
        episode = episode.object(&number.to_string(), "vase", [f64::from(number), 1.0, 0.9]);
    }
    Home::of(&episode)
}

/// Finds that the vase 7 looks like what is asked for, and the others more or less not.
fn seventh(_: &str) -> Vec<f64> {
    (0..FEATURE_DIMENSIONS).map(|place| if place == 7 { 1.0 } else { (place % 3) as f64 / 50.0 }).collect()
}

#[test]
fn a_thing_is_found_by_its_looks() {
    let provider = ScriptedProvider::start(Script { encoder: Arc::new(seventh), ..Script::default() });
    let home = vases();
    let asked = || ask(&home, &["the zebra on the shelf", "--json"]);
    assert_eq!(asked().run().expect_code(3).json()["matches"], json!([]));
    let by_looks = asked().args(["--encoder", "openai:clip"]).env("OPENAI_BASE_URL", provider.openai_url());
    let result = by_looks.run().expect_code(0).json();
    assert_eq!(result["object"]["id"], "7", "{result}");
    provider.assert_no_violations();
    let requests = provider.requests();
    let [request] = &requests[..] else { panic!("{requests:?}") };
    let body = json!({"model": "clip", "input": "zebra", "encoding_format": "float"});
    assert_eq!((&*request.path, &request.body), ("/v1/embeddings", &body));
}

#[test]
fn an_encoder_that_is_of_no_use_is_told() {
    let home = vases();
    let asked = |encoder| ask(&home, &["the zebra", "--encoder", encoder]);
    asked("clip").run().expect_code(2).expect_stderr(&["\"clip\" names no encoder", "openai:NAME"]);
    let nobody = refused_url();
    asked("openai:clip").env("OPENAI_BASE_URL", &nobody).run().expect_code(1).expect_stderr(&[
        "no model answers at",
        &nobody,
        "ask without --encoder",
    ]);
    let provider =
        ScriptedProvider::start(Script { encoder: Arc::new(|_| vec![1.0; 768]), ..Script::default() });
    asked("openai:other").env("OPENAI_BASE_URL", provider.openai_url()).run().expect_code(2).expect_stderr(
        &[
            "query_embedding: 768 numbers were given; 512",
            "from the encoder that made the features of the map",
        ],
    );
}
