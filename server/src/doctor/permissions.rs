//! Who may read and write the database. It holds what a family does all day.

use std::path::Path;

use coin_schemas::doctor::Finding;

#[cfg(unix)]
pub(super) fn examine(database: &Path) -> Vec<Finding> {
    unix::examine(database)
}

/// Windows keeps the folders of users apart by itself; only a mark on the file is looked at.
#[cfg(not(unix))]
pub(super) fn examine(database: &Path) -> Vec<Finding> {
    use coin_schemas::doctor::Level;

    let read_only = std::fs::metadata(database).is_ok_and(|file| file.permissions().readonly());
    let found = format!("{} is marked as read-only, so nothing can be recorded", database.display());
    let warning =
        super::advice(Level::Warning, "permissions", found, "remove the mark in the file's properties");
    read_only.then_some(warning).into_iter().collect()
}

#[cfg(unix)]
mod unix {
    use std::fs;
    use std::os::unix::fs::PermissionsExt;
    use std::path::Path;

    use coin_schemas::doctor::{Finding, Level};
    use rustix::fs::{Access, access};

    use crate::doctor::{advice, finding};

    const SUBJECT: &str = "permissions";

    /// Reading and writing by members of the group and all others.
    const BY_OTHERS: u32 = 0o066;

    pub(super) fn examine(database: &Path) -> Vec<Finding> {
        let (Ok(file), Some(folder)) = (fs::metadata(database), database.parent()) else {
            return Vec::new();
        };
        let mut findings = Vec::new();
        if access(database, Access::READ_OK).is_err() {
            let next = format!("chmod u+r {database:?}, or start it as the file's owner");
            findings.push(advice(Level::Problem, SUBJECT, "the database cannot be read by you", next));
        } else if access(database, Access::WRITE_OK).is_err() || access(folder, Access::WRITE_OK).is_err() {
            let found = "the database or its folder cannot be written by you, so nothing can be recorded";
            let next = format!("chmod u+w {database:?} {folder:?}, or serve with --read-only");
            findings.push(advice(Level::Warning, SUBJECT, found, next));
        }
        let mode = file.permissions().mode();
        if mode & BY_OTHERS != 0 {
            let found = format!(
                "other users of this computer may read or write the database (mode {:03o})",
                mode & 0o777
            );
            findings.push(advice(Level::Warning, SUBJECT, found, format!("chmod 600 {database:?}")));
        }
        if findings.is_empty() {
            findings.push(finding(Level::Ok, SUBJECT, "you alone can read and write the database"));
        }
        findings
    }
}
