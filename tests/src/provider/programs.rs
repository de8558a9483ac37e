//! `host` with a scripted provider for a service.

use std::path::{Path, PathBuf};

use super::ScriptedProvider;
use crate::binaries::Program;

/// A key as providers give them; nothing but the request to the provider may hold it.
pub const KEY: &str = "sk-proj-Zq7xVn2LmK9tRw4bY8cD1fGh";

/// On so many homes a model is calibrated.
const CALIBRATION_HOMES: u64 = 20;

/// The seed of the first of them.
const CALIBRATION_SEED: u64 = 1001;

impl ScriptedProvider {
    /// `host`, which is told where this provider is, and [`KEY`].
    pub fn host(&self) -> Program {
        Program::new("host").env("OPENAI_BASE_URL", self.openai_url()).env("OPENAI_API_KEY", KEY)
    }

    /// Makes thresholds of its model in a folder, from homes of the kind `week` that are scored with these arguments, and
    /// returns their file.
    pub fn calibration(&self, folder: &Path, arguments: &[&str]) -> PathBuf {
        let seeds = CALIBRATION_SEED..CALIBRATION_SEED + CALIBRATION_HOMES;
        let homes: Vec<PathBuf> = seeds
            .map(|seed| {
                let home = folder.join(format!("home-{seed}"));
                Program::new("host")
                    .args(["generate", "routine", "--protocol", "week", "--seed", &seed.to_string(), "--out"])
                    .arg(&home)
                    .run()
                    .expect_code(0);
                home
            })
            .collect();
        let file = folder.join("calibration.json");
        self.host()
            .args(["calibrate", "--quiet", "--model", "openai:scripted"])
            .args(arguments)
            .arg("--out")
            .arg(&file)
            .arg("--episode")
            .args(&homes)
            .run()
            .expect_code(0);
        file
    }
}
