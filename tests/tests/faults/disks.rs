//! Disks that are full or read-only. These tests mount small file systems of their own, which takes a Linux
//! machine and the rights of its administrator; elsewhere they say that they are skipped.

use std::path::{Path, PathBuf};
use std::process::Command;

use coin_tests::{Era, Program, ServerProcess};
use serde_json::json;

/// A file system in memory, unmounted at the end.
struct Disk {
    folder: tempfile::TempDir,
}

impl Disk {
    /// Mounts a disk of `kilobytes`; `None`, with a word about it, where that is not possible.
    fn of_kilobytes(kilobytes: usize) -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &format!("size={kilobytes}k"), "tmpfs"])
            .arg(folder.path())
            .output();
        if mounted.is_ok_and(|output| output.status.success()) {
            return Some(Self { folder });
        }
        println!("skipped: no disk can be mounted here");
        None
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("home.db")
    }

    fn make_read_only(&self) {
        let status = Command::new("mount").args(["-o", "remount,ro"]).arg(self.folder.path()).status();
        assert!(status.unwrap().success(), "a disk that was mounted can be remounted");
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        Command::new("umount").arg("--lazy").arg(self.folder.path()).status().ok();
    }
}

fn furnish(db: &Path) {
    super::import(super::furnished().write().path(), db).run().expect_code(0);
}

/// Records captions by the thousand until the disk is full. Returns how many were acknowledged.
fn fill(db: &Path) -> usize {
    let mut server = super::serve(db);
    let mut recorded = 0;
    for batch in 0..400 {
        let captions: Vec<_> = (batch * 1_000..(batch + 1) * 1_000).map(super::caption).collect();
        let answer = server.call("record_usage", json!({"captions": captions}));
        if answer.is_error {
            let text = answer.refusal();
            assert!(text.contains("full"), "{text}");
            // The server lives on, and what was stored can be read.
            let seen = server.ok("get_usage_summary", json!({"object_id": "1"}));
            assert_eq!(seen["user_summary"][0]["total_events"], recorded);
            return recorded;
        }
        recorded += 1_000;
    }
    panic!("the disk did not fill up");
}

#[test]
fn a_full_disk_keeps_what_was_acknowledged() {
    let Some(disk) = Disk::of_kilobytes(4_096) else { return };
    furnish(&disk.path());
    let recorded = fill(&disk.path());
    assert!(recorded > 0);
    assert_eq!(super::count(&disk.path(), "usage_events"), recorded);
    super::assert_sound(&disk.path());
    // It opens again, and looks are answered.
    let mut server = super::serve(&disk.path());
    let seen = server.ok("get_usage_summary", json!({"object_id": "1"}));
    assert_eq!(seen["user_summary"][0]["total_events"], recorded);
}

#[test]
fn an_import_that_does_not_fit_leaves_nothing() {
    let Some(disk) = Disk::of_kilobytes(1_024) else { return };
    let mut episode = super::furnished();
    episode.captions = (0..60_000).map(|number| super::caption(number).to_string()).collect();
    let failed = super::import(episode.write().path(), &disk.path()).run().expect_code(1);
    failed.expect_stderr(&["full"]);
    if disk.path().exists() {
        assert_eq!(super::count(&disk.path(), "objects"), 0);
    }
}

#[test]
fn a_disk_without_room_for_a_database_is_told() {
    let Some(disk) = Disk::of_kilobytes(8) else { return };
    let refused = Program::new("coin-server").arg("--db").arg(disk.path()).run();
    assert!(matches!(refused.code(), 1 | 2), "{refused:?}");
    refused.expect_stderr(&["home.db", "full"]);
}

#[test]
fn a_read_only_disk_is_told() {
    let Some(disk) = Disk::of_kilobytes(4_096) else { return };
    furnish(&disk.path());
    disk.make_read_only();
    let writing = Program::new("coin-server").arg("--db").arg(disk.path()).run().expect_code(2);
    writing.expect_stderr(&["home.db", "read-only"]);
}

#[test]
fn a_home_on_a_read_only_disk_can_be_looked_at() {
    let Some(disk) = Disk::of_kilobytes(4_096) else { return };
    furnish(&disk.path());
    disk.make_read_only();
    let mut reading =
        ServerProcess::start(["--db".as_ref(), disk.path().as_os_str(), "--read-only".as_ref()], Era::Legacy);
    assert_eq!(reading.ok("list_objects", json!({}))["total"], 3);
}

#[test]
fn a_new_database_cannot_be_made_where_nothing_can_be_written() {
    let db = Path::new("/proc/coin/home.db");
    if !Path::new("/proc/self").exists() {
        println!("skipped: there is no /proc here");
        return;
    }
    let refused = Program::new("coin-server").arg("--db").arg(db).run().expect_code(2);
    refused.expect_stderr(&["/proc/coin/home.db", "folder"]);
}
