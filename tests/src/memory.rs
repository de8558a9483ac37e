//! How much memory a process takes.

use std::fs;

/// The memory of a process that is in RAM, in KiB. Only Linux tells.
pub fn resident_memory(process: u32) -> u64 {
    let path = format!("/proc/{process}/status");
    let status = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let value = status.lines().find_map(|line| line.strip_prefix("VmRSS:")?.strip_suffix(" kB"));
    value.and_then(|value| value.trim().parse().ok()).unwrap_or_else(|| panic!("no VmRSS in {status}"))
}
