//! Where things are, and which tests run.

use std::path::{Path, PathBuf};

/// The root of the repository.
pub fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the tests lie in a folder of the repository")
}

/// A file or folder under `fixtures/`.
pub fn fixture(path: &str) -> PathBuf {
    repository().join("fixtures").join(path)
}

/// The week of a family of three that the README shows.
pub fn small_house() -> PathBuf {
    fixture("episodes/small-house")
}

/// Whether tests that take long are to run: with `COIN_SLOW_TESTS=1`, and of optimised programs, since the figures of others
/// say nothing. Where not, says so for `name`.
pub fn is_slow_run(name: &str) -> bool {
    let wanted = std::env::var("COIN_SLOW_TESTS").is_ok_and(|value| value == "1");
    let lacking = match (wanted, cfg!(debug_assertions)) {
        (true, false) => return true,
        (true, true) => "it is run with --release",
        (false, _) => "COIN_SLOW_TESTS=1 runs it",
    };
    announce(&format!("{name}: skipped; {lacking}"));
    false
}

/// Says something to whoever reads the test's output.
fn announce(text: &str) {
    eprintln!("{text}");
}
