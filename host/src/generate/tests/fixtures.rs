//! The committed episodes: `small-house` is what the generator writes, `three-things` is sound.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use coin_schemas::episode::{CaptionLine, Episode, Truth};

use super::paper::assert_paper_structure;
use super::{Protocol, home, write};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/episodes").join(name)
}

/// `COIN_UPDATE_FIXTURES=1 cargo test -p coin-host small_house` writes the files anew.
#[test]
fn small_house_is_what_the_generator_writes() {
    let committed = fixture("small-house");
    let made = home(Protocol::Paper, 1);
    if std::env::var_os("COIN_UPDATE_FIXTURES").is_some() {
        write(&made, &committed).unwrap();
    }
    let fresh = tempfile::tempdir().unwrap();
    write(&made, fresh.path()).unwrap();
    for file in ["episode.json", "captions.jsonl", "embeddings.npy", "truth.json"] {
        assert!(
            fs::read(committed.join(file)).unwrap() == fs::read(fresh.path().join(file)).unwrap(),
            "{file} of fixtures/episodes/small-house is not what `host generate routine --protocol paper --seed 1` \
             writes; if the change is meant, run COIN_UPDATE_FIXTURES=1 cargo test -p coin-host small_house"
        );
    }
    assert_paper_structure(&committed);
}

#[test]
fn three_things_is_sound() {
    let folder = fixture("three-things");
    let read = |file: &str| fs::read_to_string(folder.join(file)).unwrap();
    let episode: Episode = serde_json::from_str(&read("episode.json")).unwrap();
    let truth: Truth = serde_json::from_str(&read(&episode.truth.clone().unwrap())).unwrap();
    let ids: BTreeSet<_> = episode.objects.iter().map(|object| object.id.clone()).collect();
    assert!(truth.owners.keys().eq(&ids));
    assert!(truth.usage_type.unwrap().keys().eq(&ids));
    assert!(truth.owners.values().flatten().all(|owner| episode.users.contains_key(owner)));
    let captions: Vec<CaptionLine> =
        read(&episode.captions).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!((20..=30).contains(&captions.len()));
    let latest = episode.now.strftime("%Y-%m-%d %H:%M").to_string();
    for line in &captions {
        assert!(ids.contains(&line.object_id));
        assert!(line.caption[..16] <= *latest, "{}", line.caption);
    }
}
