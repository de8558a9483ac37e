use proptest::prelude::*;
use rstest::rstest;

use super::*;

fn entry() -> Entry {
    Entry {
        command: "/opt/coin/coin-server".to_owned(),
        args: vec!["--db".to_owned(), "/people/ann/home.db".to_owned()],
    }
}

fn entered(text: &str, host: Host) -> String {
    enter(text, host, "coin", &entry()).unwrap()
}

#[test]
fn an_empty_file_gets_the_entry_alone() {
    insta::assert_snapshot!(entered("", Host::VsCode), @r#"
    {
      "servers": {
        "coin": {
          "type": "stdio",
          "command": "/opt/coin/coin-server",
          "args": ["--db", "/people/ann/home.db"]
        }
      }
    }
    "#);
}

#[test]
fn comments_and_other_servers_stay() {
    let text = "{\n\t// mine\n\t\"mcpServers\": {\n\t\t\"files\": {\"command\": \"npx\"}, // keep\n\t},\n\t\"theme\": \"dark\",\n}\n";
    let made = entered(text, Host::Cursor);
    insta::assert_snapshot!(made.replace('\t', "  "), @r#"
    {
      // mine
      "mcpServers": {
        "files": {"command": "npx"}, // keep
        "coin": {
          "command": "/opt/coin/coin-server",
          "args": ["--db", "/people/ann/home.db"],
        },
      },
      "theme": "dark",
    }
    "#);
    assert_eq!(remove(&made, None, Host::Cursor, "coin"), Ok(Remainder::Text(text.to_owned())));
}

#[test]
fn what_others_changed_since_stays_when_the_entry_goes() {
    let before = r#"{"mcpServers": {"files": {"command": "npx"}}}"#;
    let since = entered(before, Host::Cursor).replace("npx", "uvx");
    let Ok(Remainder::Text(left)) = remove(&since, Some(before), Host::Cursor, "coin") else {
        panic!("the entry goes")
    };
    let left: Value = serde_json::from_str(&left).unwrap();
    assert_eq!(left, serde_json::json!({"mcpServers": {"files": {"command": "uvx"}}}));
}

#[test]
fn a_file_that_was_made_for_the_entry_goes_with_it() {
    let made = entered("", Host::ClaudeDesktop);
    assert_eq!(remove(&made, None, Host::ClaudeDesktop, "coin"), Ok(Remainder::Nothing));
}

#[test]
fn an_older_entry_is_brought_up_to_date_and_keeps_its_environment() {
    let text = r#"{"mcpServers": {"coin": {"command": "/old/coin-server", "env": {"RUST_LOG": "debug"}, "args": []}}}"#;
    let made: Value = serde_json::from_str(&entered(text, Host::Cursor)).unwrap();
    let coin = &made["mcpServers"]["coin"];
    assert_eq!(coin["command"], "/opt/coin/coin-server");
    assert_eq!(coin["args"][1], "/people/ann/home.db");
    assert_eq!(coin["env"]["RUST_LOG"], "debug");
}

#[test]
fn a_copy_that_holds_an_older_entry_is_not_given_back() {
    let older = Entry { args: Vec::new(), ..entry() };
    let before = enter(r#"{"mcpServers": {"files": {}}}"#, Host::Cursor, "coin", &older).unwrap();
    let made = entered(&before, Host::Cursor);
    let Ok(Remainder::Text(left)) = remove(&made, Some(&before), Host::Cursor, "coin") else {
        panic!("the entry goes")
    };
    assert_eq!(entries(&left, Host::Cursor), Ok(Vec::new()));
}

#[rstest]
#[case("{\"mcpServers\": {}\n  \"theme\": 1}", "line 1, column 18 is no valid JSON")]
#[case("{\n  \"mcpServers\": nothing\n}", "line 2, column 17 is no valid JSON")]
#[case("{'mcpServers': {}}", "line 1, column 2 is no valid JSON")]
#[case("[]", "the whole file must be a JSON object")]
#[case(r#"{"mcpServers": []}"#, "\"mcpServers\" must be a JSON object")]
#[case(r#"{"mcpServers": {"coin": {"command": "npx"}}}"#, "the server \"coin\" in it is not a coin-server")]
#[case(r#"{"mcpServers": {"coin": 1}}"#, "the server \"coin\" in it is not a coin-server")]
fn what_cannot_be_changed_safely_is_refused(#[case] text: &str, #[case] expected: &str) {
    let error = enter(text, Host::Cursor, "coin", &entry()).unwrap_err().to_string();
    assert!(error.starts_with(expected), "{error}");
}

#[test]
fn another_program_of_our_name_is_not_removed() {
    let text = r#"{"mcpServers": {"coin": {"command": "npx"}}}"#;
    assert_eq!(remove(text, None, Host::Cursor, "coin"), Err(not_ours("coin")));
    assert_eq!(remove(text, None, Host::Cursor, "other"), Ok(Remainder::Unchanged));
}

/// Configurations of many shapes: other keys, other servers, comments, trailing commas, indents and line ends.
fn configuration() -> impl Strategy<Value = String> {
    let servers = proptest::option::of(proptest::collection::vec("[a-z]{1,8}", 0..4));
    let others = proptest::collection::vec("[A-Z]{1,6}", 0..3);
    let break_ = prop_oneof![
        Just(""),
        Just(" "),
        Just("\n"),
        Just("\n  "),
        Just("\r\n\t"),
        Just(" /* why */ "),
        Just("\n// why\n")
    ];
    let shape = (servers, others, break_, any::<bool>(), any::<bool>());
    shape.prop_map(|(servers, others, space, trailing, mark)| {
        let object = |properties: Vec<String>| {
            let comma = if trailing && !properties.is_empty() { "," } else { "" };
            format!("{{{space}{}{comma}{space}}}", properties.join(&format!(",{space}")))
        };
        let mut properties: Vec<String> = others.iter().map(|key| format!("\"{key}\":{space}1.50")).collect();
        if let Some(names) = servers {
            let inner =
                names.iter().map(|name| format!("\"{name}0\": {{\"command\":{space}\"npx\"}}")).collect();
            properties.push(format!("\"mcpServers\": {}", object(inner)));
        }
        format!("{}{}{space}", if mark { "\u{feff}" } else { "" }, object(properties))
    })
}

/// The configuration as data, without the entry.
fn others(text: &str) -> Value {
    let root = parse(split_mark(text).1).unwrap();
    let mut value = root.to_serde_value().unwrap();
    if let Some(servers) = value.get_mut("mcpServers").and_then(Value::as_object_mut) {
        servers.shift_remove("coin");
        if servers.is_empty() {
            value.as_object_mut().unwrap().shift_remove("mcpServers");
        }
    }
    value
}

proptest! {
    #[test]
    fn entering_and_removing_gives_back_every_byte(text in configuration()) {
        let made = entered(&text, Host::Cursor);
        prop_assert_ne!(&made, &text);
        prop_assert_eq!(remove(&made, Some(&text), Host::Cursor, "coin"), Ok(Remainder::Text(text)));
    }

    #[test]
    fn everything_else_is_kept(text in configuration()) {
        let made = entered(&text, Host::Cursor);
        prop_assert_eq!(entries(&made, Host::Cursor).unwrap(), vec![("coin".to_owned(), entry())]);
        prop_assert_eq!(others(&made), others(&text));
        prop_assert_eq!(made.matches("why").count(), text.matches("why").count());
        prop_assert_eq!(&entered(&made, Host::Cursor), &made, "the same again changes nothing");
        match remove(&made, None, Host::Cursor, "coin").unwrap() {
            Remainder::Text(left) => prop_assert_eq!(others(&left), others(&text)),
            Remainder::Nothing => prop_assert_eq!(others(&text), serde_json::json!({})),
            Remainder::Unchanged => prop_assert!(false, "the entry goes"),
        }
    }
}
