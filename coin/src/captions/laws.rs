use jiff::civil::DateTime;
use proptest::prelude::*;

use super::test_support::roster;
use super::{Action, CaptionReader, civil_seconds, from_civil_seconds};

/// Text made of the grammar's own words, which reaches more of the rules than random letters do.
fn sentence() -> impl Strategy<Value = String> {
    let words = prop::sample::select(vec![
        "Bob", "Mary", "Tom", "Bob's", "Mary's", "the", "a", "father", "Mom", "son's", "someone", "Steve",
        "is", "was", "being", "gets", "not", "takes", "taken", "taking", "picked", "picks", "up", "by", "to",
        "of", "with", "and", "or", "who", "that", "while", "in", "kitchen", "mug", "uses", "put", "back",
        "off", "looks", "for", "gives", "knocked", ",", "/", ";", "🙂", "it", "her", "starts",
    ]);
    prop::collection::vec(words, 1..14).prop_map(|words| words.join(" "))
}

fn actor_of(members: &[(&str, &str)], text: &str) -> (Option<String>, Action) {
    let roster = roster(members);
    let seen = CaptionReader::new(&roster).read(&format!("2025-01-19 19:00 {text}")).unwrap();
    (seen.actor.map(|user| roster.name(user).to_string()), seen.action)
}

proptest! {
    #[test]
    fn no_line_makes_the_reader_panic(line in any::<String>()) {
        let reader = CaptionReader::new(&roster(&[("Bob", "father"), ("Zoé", "\u{301}")]));
        let _ = reader.read(&line);
        let _ = reader.read(&format!("2025-01-19 19:00 {line}"));
    }

    #[test]
    fn every_line_of_plain_text_after_a_time_is_an_observation(text in "[^\\p{C} ][^\\p{C}]{0,300}") {
        let reader = CaptionReader::new(&roster(&[("Bob", "father"), ("Mary", "mother")]));
        let line = format!("2025-01-19 19:00 {text}");
        prop_assert!(reader.read(&line).is_ok(), "{}", line);
    }

    #[test]
    fn another_name_in_the_caption_is_another_actor_and_nothing_else(text in sentence()) {
        let (actor, action) = actor_of(&[("Bob", "father"), ("Mary", "mother"), ("Tom", "son")], &text);
        let renamed = text.replace("Bob", "Zacharias").replace("Mary", "Änne-Sophie").replace("Tom", "Ali");
        let members = [("Zacharias", "father"), ("Änne-Sophie", "mother"), ("Ali", "son")];
        let expected = actor.map(|name| {
            name.replace("Bob", "Zacharias").replace("Mary", "Änne-Sophie").replace("Tom", "Ali")
        });
        prop_assert_eq!(actor_of(&members, &renamed), (expected, action));
    }

    #[test]
    fn a_text_without_a_member_has_no_actor(text in sentence()) {
        let (actor, _) = actor_of(&[("Xenia", ""), ("Yusuf", "")], &text);
        prop_assert_eq!(actor, None);
    }

    #[test]
    fn the_actor_is_somebody_whom_the_text_names(text in sentence()) {
        if let (Some(actor), _) = actor_of(&[("Bob", ""), ("Mary", ""), ("Tom", "")], &text) {
            prop_assert!(text.contains(&actor));
        }
    }

    #[test]
    fn case_does_not_matter(text in sentence()) {
        let members = [("Bob", "father"), ("Mary", "mother"), ("Tom", "son")];
        prop_assert_eq!(actor_of(&members, &text), actor_of(&members, &text.to_uppercase()));
    }

    #[test]
    fn civil_seconds_go_both_ways(seconds in -62_000_000_000_i64..250_000_000_000) {
        let at = from_civil_seconds(seconds).unwrap();
        prop_assert_eq!(civil_seconds(at), seconds);
        let later = from_civil_seconds(seconds + 1).unwrap();
        prop_assert!(at < later);
    }

    #[test]
    fn every_time_of_a_caption_comes_back(seconds in -62_000_000_000_i64..250_000_000_000) {
        let at: DateTime = from_civil_seconds(seconds).unwrap();
        let reader = CaptionReader::new(&roster(&[("Bob", "")]));
        for line in [at.strftime("%Y-%m-%d %H:%M:%S Bob").to_string(), at.strftime("%Y-%m-%dT%H:%M:%S Bob").to_string()] {
            prop_assert_eq!(reader.read(&line).unwrap().at, at);
        }
    }
}
