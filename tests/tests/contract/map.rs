//! `coin-server map`: the home to look at, as a page, as a table and as JSON, from the built program.

use std::fs;
use std::path::Path;

use coin_tests::{EpisodeBuilder, Finished, Home, Program, assert_conforms, fixture, published_schema};
use serde_json::{Value, json};

use super::{answer, furnished_home};

fn map(db: &Path, more: &[&str]) -> Finished {
    Program::new("coin-server").args(["map".as_ref(), "--db".as_ref(), db.as_os_str()]).args(more).run()
}

fn as_json(db: &Path) -> Value {
    let map = map(db, &["--json"]).expect_code(0).json();
    assert_conforms(&published_schema("home-map.schema.json"), &map, "the map");
    map
}

#[test]
fn what_is_shown_is_what_whose_is_tells() {
    let home = Home::import(&fixture("episodes/three-things"));
    let map = as_json(&home.db());
    assert_eq!(map["name"], "three-things");
    assert_eq!(map["as_of"], "2025-01-19T23:00:00");
    assert_eq!(map["users"]["Mary"]["role"], "mother");
    let mut server = home.server();
    let things = map["objects"].as_array().unwrap();
    assert_eq!(things.len(), 3);
    for thing in things {
        let told = server.call("whose_is", json!({"object_id": thing["id"]})).value();
        for key in ["owners", "owner_outside_household", "confidence", "settled", "source"] {
            assert_eq!(thing[key], told[key], "{key} of {thing}");
        }
    }
}

#[test]
fn what_a_person_said_is_shown_as_an_answer() {
    let home = furnished_home();
    home.server().call("record_answer", answer("mug-red", "Mary")).value();
    let map_of = as_json(&home.db());
    let thing = map_of["objects"].as_array().unwrap().iter().find(|thing| thing["id"] == "mug-red").unwrap();
    assert_eq!((&thing["owners"], &thing["source"]), (&json!(["Mary"]), &json!("answer")));
    assert_eq!((&thing["confidence"], &thing["settled"]), (&json!(1.0), &json!(true)));
    let table = map(&home.db(), &[]).expect_code(0).stdout;
    let line = table.lines().find(|line| line.contains("mug-red")).unwrap();
    let words: Vec<&str> = line.split("  ").map(str::trim).filter(|word| !word.is_empty()).collect();
    assert_eq!(words, ["–", "mug", "mug-red", "0.3, 0.4, 0.8", "Mary", "100 %", "by answer"]);
}

#[test]
fn the_columns_of_the_table_are_aligned() {
    let home = Home::import(&fixture("episodes/three-things"));
    let table = map(&home.db(), &[]).expect_code(0).stdout;
    let lines: Vec<&str> = table.lines().collect();
    let column = lines[0].find("owners").unwrap();
    for (line, owners) in lines[1..4].iter().zip(["everybody", "everybody", "Bob"]) {
        assert!(line[column..].starts_with(owners), "{table}");
    }
    assert_eq!(lines[5], "3 things: 0 by answer, 0 inferred, 3 worth a question.");
}

#[test]
fn a_page_stands_alone_and_lets_no_name_act() {
    let hostile = "<script>alert('1')</script>";
    let mut episode = EpisodeBuilder::three_things();
    episode.description["name"] = json!(hostile);
    episode.description["objects"][0]["class"] = json!(hostile);
    episode.description["objects"][0]["room"] = json!(format!("\"/>{hostile}"));
    episode.description["users"][hostile] = json!({"role": hostile});
    let home = Home::of(&episode);
    let file = home.join("home.html");
    let finished = map(&home.db(), &["--html", file.to_str().unwrap()]).expect_code(0);
    assert_eq!(finished.stdout, "", "the page takes the place of the table");
    finished.expect_stderr(&["home.html"]);
    let page = fs::read_to_string(&file).unwrap();
    assert_eq!(page.matches("<script").count(), 0);
    assert!(page.contains("&lt;script&gt;alert('1')&lt;/script&gt;"));
    assert_eq!(page.matches("class=\"thing\"").count(), 3);
    assert!(page.contains("default-src 'none'") && !page.contains(" src="));
    assert_eq!(page.matches("://").count(), page.matches("http://www.w3.org/2000/svg").count());
}

#[test]
fn an_older_page_is_replaced_and_the_home_never() {
    let home = furnished_home();
    let before = fs::read(home.db()).unwrap();
    let file = home.join("home.html");
    fs::write(&file, "an older page").unwrap();
    let both = map(&home.db(), &["--json", "--html", file.to_str().unwrap()]).expect_code(0);
    assert_eq!(both.json()["objects"].as_array().unwrap().len(), 4);
    assert!(fs::read_to_string(&file).unwrap().starts_with("<!DOCTYPE html>"));
    map(&home.db(), &["--html", home.db().to_str().unwrap()])
        .expect_code(2)
        .expect_stderr(&["it is the home's database", "--html"]);
    assert_eq!(fs::read(home.db()).unwrap(), before, "looking changes nothing");
}

#[test]
fn a_database_that_is_missing_is_refused_and_not_made() {
    let folder = tempfile::tempdir().unwrap();
    let (db, page) = (folder.path().join("nowhere.db"), folder.path().join("home.html"));
    let refused = map(&db, &["--html", page.to_str().unwrap()]).expect_code(2);
    assert_eq!(refused.stdout, "");
    refused.expect_stderr(&["nowhere.db", "there is no such file"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn what_cannot_be_drawn_or_written_is_refused() {
    let home = furnished_home();
    map(&home.db(), &["--html", "/nowhere/at/all/home.html"])
        .expect_code(2)
        .expect_stderr(&["cannot write /nowhere/at/all/home.html"]);
    map(&home.db(), &["--svg"]).expect_code(2).expect_stderr(&["--svg"]);
    let empty = home.join("empty.db");
    drop(coin_tests::ServerProcess::start(["--db".as_ref(), empty.as_os_str()], coin_tests::Era::Legacy));
    map(&empty, &[]).expect_code(2).expect_stderr(&["empty.db", "nobody lives in this home yet"]);
}
