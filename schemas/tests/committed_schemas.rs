//! The committed JSON Schemas are those of the types.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use coin_schemas::catalogue::schemas;

const UPDATE: &str = "COIN_UPDATE_SCHEMAS";

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("schema")
}

#[test]
fn committed_schemas_match_the_types() {
    let update = std::env::var_os(UPDATE).is_some();
    if update {
        fs::create_dir_all(folder()).unwrap();
    }
    let mut stale = Vec::new();
    for (name, schema) in schemas() {
        let path = folder().join(name);
        let text = format!("{}\n", serde_json::to_string_pretty(&schema).unwrap());
        if update {
            fs::write(&path, text).unwrap();
        } else if fs::read_to_string(&path).ok().as_deref() != Some(text.as_str()) {
            stale.push(name);
        }
    }
    assert!(
        stale.is_empty(),
        "schemas/schema/ does not match the types: {stale:?}.\n\
         If the change is meant, run `{UPDATE}=1 cargo test -p coin-schemas` and commit the result."
    );
}

#[test]
fn no_schema_is_left_over() {
    let known: BTreeSet<String> = schemas().into_iter().map(|(name, _)| name.to_owned()).collect();
    let present: BTreeSet<String> = fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(present, known);
}
