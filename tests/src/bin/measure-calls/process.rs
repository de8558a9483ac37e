//! What the system knows of a process. Only Linux tells.

use std::fs;
use std::time::Duration;

/// The unit in which Linux tells processor time.
const TICK: Duration = Duration::from_millis(10);

/// The processor time that all threads of a process took.
pub(crate) fn used(process: u32) -> Duration {
    let stat = read(process, "stat");
    // The program's name, which may hold anything, ends with the last parenthesis; times are the 14th and 15th field.
    let (_, fields) = stat.rsplit_once(')').expect("stat names the program");
    let ticks = fields
        .split_whitespace()
        .skip(11)
        .take(2)
        .map(|ticks| ticks.parse::<u32>().expect("ticks are a number"));
    TICK * ticks.sum::<u32>()
}

/// The most memory that a process ever had in RAM, in KiB.
pub(crate) fn peak_memory(process: u32) -> u64 {
    let status = read(process, "status");
    let value = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.strip_suffix(" kB"));
    value.and_then(|value| value.trim().parse().ok()).expect("status tells the peak")
}

fn read(process: u32, name: &str) -> String {
    let path = format!("/proc/{process}/{name}");
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}
