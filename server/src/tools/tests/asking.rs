//! `ask_owner`: forms, what comes back, and the chat where there are no forms.

use serde_json::json;

use super::*;
use crate::test_home;
use crate::tools::{Form, Reply};

fn ask(store: &Store, arguments: Value, person: Person) -> Result<Turn<Value>, ToolError> {
    let arguments: JsonObject = serde_json::from_value(arguments).unwrap();
    registry().get("ask_owner").unwrap().call(store, &arguments, person)
}

fn form(store: &Store, arguments: Value) -> Form {
    match ask(store, arguments, Person::WithinReach).unwrap() {
        Turn::Ask(form) => form,
        Turn::Done(result) => panic!("nobody is asked: {result}"),
    }
}

fn bring_back(store: &Store, form: &Form, reply: Reply) -> Result<Value, ToolError> {
    match ask(store, json!({}), Person::Replied { state: form.state.clone(), reply })? {
        Turn::Done(result) => Ok(result),
        Turn::Ask(form) => panic!("asked again: {form:?}"),
    }
}

fn filled(content: Value) -> Reply {
    Reply::Accepted(serde_json::from_value(content).unwrap())
}

fn whose(store: &Store, object: &str) -> Value {
    done(store, "whose_is", json!({"object_id": object}))
}

#[test]
fn a_form_offers_everybody_alone_and_together() {
    let form = form(&test_home::store(), json!({"object_id": "sofa"}));
    insta::assert_snapshot!(form.message, @"Do you all share the sofa, or is it just Bob's or Mary's?");
    assert_eq!(
        form.choices,
        [
            "Bob",
            "Mary",
            "Tom",
            "Bob and Mary",
            "Bob and Tom",
            "Mary and Tom",
            "all of us",
            "nobody here owns it",
            "I do not know"
        ]
    );
}

#[test]
fn a_picked_choice_settles_the_thing() {
    let store = test_home::store();
    let form = form(&store, json!({"object_id": "sofa"}));
    let result = bring_back(&store, &form, filled(json!({"owner": "Bob and Mary"}))).unwrap();
    insta::assert_json_snapshot!(result, @r#"
    {
      "status": "answered",
      "object": {
        "id": "sofa",
        "name": "Sofa"
      },
      "question": "Do you all share the sofa, or is it just Bob's or Mary's?",
      "answer": "Bob and Mary",
      "owners": [
        "Bob",
        "Mary"
      ],
      "owner_outside_household": false,
      "scores": {
        "Bob": 1.0,
        "Mary": 1.0,
        "Tom": 0.0
      }
    }
    "#);
    let told = whose(&store, "sofa");
    assert_eq!((&told["owners"], &told["source"]), (&json!(["Bob", "Mary"]), &json!("answer")));
}

#[test]
fn own_words_are_kept_beside_the_choice() {
    let store = test_home::store();
    let form = form(&store, json!({"object_id": "sofa"}));
    let content = json!({"owner": "Bob", "in_your_words": "a present from Mary"});
    let result = bring_back(&store, &form, filled(content)).unwrap();
    assert_eq!(result["answer"], "Bob (a present from Mary)");
    assert_eq!(result["owners"], json!(["Bob"]));
}

#[test]
fn an_owner_from_outside_and_nobody_are_told_apart() {
    let store = test_home::store();
    let outside = form(&store, json!({"object_id": "sofa"}));
    let result = bring_back(&store, &outside, filled(json!({"owner": "nobody here owns it"}))).unwrap();
    assert_eq!((&result["status"], &result["owner_outside_household"]), (&json!("answered"), &json!(true)));
    let unknown = form(&store, json!({"object_id": "key"}));
    let result = bring_back(&store, &unknown, filled(json!({"owner": "I do not know"}))).unwrap();
    assert_eq!((&result["status"], &result["owners"]), (&json!("unresolved"), &json!([])));
    assert_eq!(whose(&store, "key")["settled"], false);
}

#[test]
fn a_form_counts_once() {
    let store = test_home::store();
    let form = form(&store, json!({"object_id": "sofa"}));
    bring_back(&store, &form, filled(json!({"owner": "Bob"}))).unwrap();
    let error = bring_back(&store, &form, filled(json!({"owner": "Mary"}))).unwrap_err();
    assert!(matches!(error, ToolError::StaleForm { .. }), "{error}");
    assert_eq!(whose(&store, "sofa")["owners"], json!(["Bob"]));
}

#[test]
fn a_form_that_is_filled_in_wrongly_can_be_mended() {
    let store = test_home::store();
    let form = form(&store, json!({"object_id": "sofa"}));
    for (content, problem) in [
        (json!({}), "owner"),
        (json!({"owner": "Zoe"}), "\"Zoe\" is none of the choices"),
        (json!({"owner": ["Bob"]}), "a text is expected"),
        (json!({"owner": "Bob", "in_your_words": "a".repeat(3000)}), "3000 bytes"),
    ] {
        let error = bring_back(&store, &form, filled(content)).unwrap_err().to_string();
        assert!(error.contains(problem), "{error}");
    }
    bring_back(&store, &form, filled(json!({"owner": "Bob"}))).unwrap();
}

#[test]
fn who_declines_is_not_asked_again() {
    let store = test_home::store();
    let form = form(&store, json!({}));
    let id = form.state.object_id.to_string();
    let result = bring_back(&store, &form, Reply::Declined).unwrap();
    assert_eq!((&result["status"], &result["object"]["id"]), (&json!("declined"), &json!(id)));
    assert_ne!(done(&store, "next_question", json!({}))["object"]["id"], id);
    let again = ask(&store, json!({"object_id": id}), Person::WithinReach).unwrap();
    let Turn::Done(again) = again else { panic!("asked again") };
    assert_eq!(again["status"], "declined");
    let told = done(&store, "ask_owner", json!({"object_id": id, "owner": "It is Tom's after all."}));
    assert_eq!(told["status"], "answered", "what a person says of their own accord always counts");
}

#[test]
fn who_puts_a_form_away_may_be_asked_another_time() {
    let store = test_home::store();
    let first = form(&store, json!({}));
    let id = first.state.object_id.to_string();
    assert_eq!(bring_back(&store, &first, Reply::Cancelled).unwrap()["status"], "cancelled");
    assert_ne!(done(&store, "next_question", json!({}))["object"]["id"], id, "others come first");
    let again = form(&store, json!({"object_id": id}));
    assert!(again.message.starts_with("Sorry to ask again"), "{}", again.message);
}

#[test]
fn a_client_without_forms_is_told_to_ask_in_the_chat() {
    let message = refused(&test_home::store(), "ask_owner", json!({"object_id": "sofa"}));
    insta::assert_snapshot!(message, @r#"this client cannot show a form to a person. Ask in the chat: "Do you all share the sofa, or is it just Bob's or Mary's?" Then call ask_owner with object_id "sofa" and what the person said as owner."#);
}

#[test]
fn what_was_said_in_the_chat_is_read_and_kept() {
    let store = test_home::store();
    let result = done(&store, "ask_owner", json!({"object_id": "sofa", "owner": "That's Mary's and Tom's."}));
    assert_eq!((&result["status"], &result["owners"]), (&json!("answered"), &json!(["Mary", "Tom"])));
    assert_eq!(result["answer"], "That's Mary's and Tom's.");
    assert_eq!(super::recording::history(&store, "sofa"), ["That's Mary's and Tom's."]);
    done(&store, "ask_owner", json!({"object_id": "sofa", "owner": "That's Mary's and Tom's."}));
    assert_eq!(super::recording::history(&store, "sofa").len(), 1, "the same call twice leaves one answer");
    let unclear = done(&store, "ask_owner", json!({"object_id": "key", "owner": "Hm, ask me later"}));
    assert_eq!(unclear["status"], "unresolved");
}

#[test]
fn a_home_in_which_all_is_settled_has_nothing_to_ask() {
    let store = test_home::store();
    for object in ["1", "2", "cup-a", "sofa", "key"] {
        done(&store, "record_answer", super::recording::answer(object, "Bob's", &json!({"Bob": true})));
    }
    let Turn::Done(result) = ask(&store, json!({}), Person::WithinReach).unwrap() else { panic!("asked") };
    assert_eq!(result["status"], "nothing_to_ask");
}

#[test]
fn what_was_said_is_said_of_a_thing() {
    let store = test_home::store();
    let message = refused(&store, "ask_owner", json!({"owner": "Bob's"}));
    assert!(message.starts_with("object_id: it is missing"), "{message}");
    let message = refused(&store, "ask_owner", json!({"owner": "Bob's", "object_id": "mug"}));
    assert!(message.starts_with("object_id: there is no object"), "{message}");
    assert_eq!(done(&store, "next_question", json!({}))["unsettled"], 5);
}

#[test]
fn a_form_that_lay_open_for_too_long_does_not_count() {
    let store = test_home::store();
    let mut form = form(&store, json!({"object_id": "sofa"}));
    form.state.expires_at -= 2 * i64::try_from(crate::tools::FORM_LIFETIME.as_secs()).unwrap();
    let error = bring_back(&store, &form, filled(json!({"owner": "Bob"}))).unwrap_err().to_string();
    assert!(error.contains("has expired"), "{error}");
    assert_eq!(whose(&store, "sofa")["source"], "inferred");
}

#[test]
fn all_of_us_means_those_who_were_asked() {
    let store = test_home::store();
    let form = form(&store, json!({"object_id": "sofa"}));
    done(&store, "add_user", json!({"name": "Ann"}));
    let error = bring_back(&store, &form, filled(json!({"owner": "all of us"}))).unwrap_err().to_string();
    assert!(error.contains("before somebody joined"), "{error}");
    assert_eq!(whose(&store, "sofa")["source"], "inferred");
}
