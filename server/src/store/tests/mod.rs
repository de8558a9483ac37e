mod indexes;
mod observing;
mod together;

use std::path::Path;
use std::sync::Barrier;
use std::thread;

use coin_schemas::household::{Background, UserName};
use rusqlite::Connection;

use super::*;

fn bob() -> UserName {
    UserName::new("Bob").unwrap()
}

#[expect(clippy::redundant_closure_for_method_calls, reason = "the method's path is not general enough")]
fn people(store: &Store) -> Option<Household> {
    store.read(|reader| reader.household()).unwrap()
}

fn add_bob(store: &Store) {
    store.write(|writer| writer.put_user(&bob(), &Background::default())).unwrap();
}

fn opening_fails(path: &Path, access: Access) -> String {
    Store::open(path, access).unwrap_err().to_string().replace(&path.display().to_string(), "FILE")
}

#[test]
fn a_home_is_there_when_the_file_is_opened_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new/folder/home.db");
    add_bob(&Store::open(&path, Access::ReadWrite).unwrap());
    let store = Store::open(&path, Access::ReadOnly).unwrap();
    let household = people(&store).unwrap();
    assert_eq!(household.roster().names().collect::<Vec<_>>(), [&bob()]);
}

#[cfg(unix)]
#[test]
fn a_new_file_is_its_owners_alone() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    let store = Store::open(&path, Access::ReadWrite).unwrap();
    add_bob(&store);
    for name in ["home.db", "home.db-wal", "home.db-shm"] {
        let mode = folder.path().join(name).metadata().unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600, "{name}");
    }
}

#[test]
fn a_file_that_is_no_database_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    std::fs::write(
        &path,
        "a shopping list, long enough to be looked at as a header of a database file\n".repeat(20),
    )
    .unwrap();
    insta::assert_snapshot!(opening_fails(&path, Access::ReadWrite), @"cannot open the database FILE: it is not a SQLite database; name another file with --db");
}

#[test]
fn a_database_of_another_program_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    Connection::open(&path).unwrap().execute_batch("CREATE TABLE notes (text TEXT)").unwrap();
    insta::assert_snapshot!(opening_fails(&path, Access::ReadWrite), @"cannot open the database FILE: it is a SQLite database of another program (application id 0x00000000); name another file with --db");
    let tables: i64 = Connection::open(&path)
        .unwrap()
        .query_row("SELECT count(*) FROM sqlite_schema", [], |row| row.get(0))
        .unwrap();
    assert_eq!(tables, 1, "the foreign file is left alone");
}

#[test]
fn a_database_of_a_newer_version_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    drop(Store::open(&path, Access::ReadWrite).unwrap());
    Connection::open(&path).unwrap().execute_batch("PRAGMA user_version = 99").unwrap();
    insta::assert_snapshot!(opening_fails(&path, Access::ReadWrite), @"cannot open the database FILE: it has version 99 and this program knows versions up to 5; install a newer coin-server");
}

#[test]
fn a_missing_file_is_not_created_for_reading() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    insta::assert_snapshot!(opening_fails(&path, Access::ReadOnly), @"cannot open the database FILE: there is no such file, and read-only access creates none; import an episode into it first");
    assert!(!path.exists());
}

#[test]
fn an_older_database_is_not_migrated_for_reading() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    std::fs::write(&path, "").unwrap();
    insta::assert_snapshot!(opening_fails(&path, Access::ReadOnly), @"cannot open the database FILE: it has version 0 and must be brought to version 5; open it once without --read-only");
}

#[test]
fn a_folder_that_cannot_be_created_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    insta::assert_snapshot!(opening_fails(&file.join("home.db"), Access::ReadWrite), @"cannot open the database FILE: its folder cannot be created: File exists (os error 17)");
}

#[test]
fn a_folder_is_no_database() {
    let folder = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(opening_fails(folder.path(), Access::ReadWrite), @"cannot open the database FILE: it is a folder; name a file in it");
}

#[test]
fn nothing_is_written_through_a_store_that_was_opened_for_reading() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    drop(Store::open(&path, Access::ReadWrite).unwrap());
    let store = Store::open(&path, Access::ReadOnly).unwrap();
    let error = store.write(|writer| writer.put_user(&bob(), &Background::default())).unwrap_err();
    insta::assert_snapshot!(error, @"the database was opened read-only; start coin-server without --read-only to record anything");
}

#[test]
fn a_change_that_fails_leaves_nothing_behind() {
    let store = Store::open_in_memory().unwrap();
    let outcome: Result<(), StoreError> = store.write(|writer| {
        writer.put_user(&bob(), &Background::default())?;
        Err(StoreError::Full)
    });
    assert!(outcome.is_err());
    assert_eq!(people(&store), None);
}

#[test]
fn a_panic_in_a_change_leaves_nothing_behind_and_the_store_usable() {
    let store = Store::open_in_memory().unwrap();
    let panicked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        store.write::<(), StoreError>(|writer| {
            writer.put_user(&bob(), &Background::default())?;
            panic!("in the middle")
        })
    }));
    assert!(panicked.is_err());
    assert_eq!(people(&store), None);
    add_bob(&store);
}

#[test]
fn a_full_disk_is_named_and_keeps_what_was_there() {
    let store = Store::open_in_memory().unwrap();
    add_bob(&store);
    {
        let connection = store.connections.writer().unwrap();
        let pages: i64 = connection.query_row("PRAGMA page_count", [], |row| row.get(0)).unwrap();
        connection.pragma_update(None, "max_page_count", pages).unwrap();
    }
    let error = store
        .write(|writer| {
            (0..1000).try_for_each(|number| {
                writer.put_user(&UserName::new(format!("user {number}")).unwrap(), &Background::default())
            })
        })
        .unwrap_err();
    insta::assert_snapshot!(error, @"the disk is full: nothing of this call was stored, all that was acknowledged before is kept");
    let household = people(&store).unwrap();
    assert_eq!(household.roster().len(), 1);
}

#[test]
fn a_locked_database_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    let store = Store::open(&path, Access::ReadWrite).unwrap();
    store.connections.writer().unwrap().busy_timeout(std::time::Duration::from_millis(1)).unwrap();
    let other = Connection::open(&path).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    let error = store.write(|writer| writer.put_user(&bob(), &Background::default())).unwrap_err();
    insta::assert_snapshot!(error, @"the database is locked by another process for over 5 seconds; try again");
    assert_eq!(people(&store), None, "a reader does not wait");
}

#[test]
fn many_processes_may_create_one_file_together() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    const THREADS: usize = 16;
    let barrier = Barrier::new(THREADS);
    thread::scope(|scope| {
        let handles: Vec<_> = (0..THREADS)
            .map(|number| {
                let (barrier, path) = (&barrier, &path);
                scope.spawn(move || {
                    barrier.wait();
                    let store = Store::open(path, Access::ReadWrite).unwrap();
                    let name = UserName::new(format!("user {number}")).unwrap();
                    store.write(|writer| writer.put_user(&name, &Background::default())).unwrap();
                })
            })
            .collect();
        for handle in handles {
            handle.join().unwrap();
        }
    });
    let store = Store::open(&path, Access::ReadOnly).unwrap();
    assert_eq!(people(&store).unwrap().roster().len(), THREADS);
}

#[test]
fn an_up_to_date_database_opens_while_another_process_writes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("home.db");
    drop(Store::open(&path, Access::ReadWrite).unwrap());
    let other = Connection::open(&path).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    let started = std::time::Instant::now();
    Store::open(&path, Access::ReadWrite).unwrap();
    assert!(started.elapsed() < std::time::Duration::from_secs(2), "opening took the write lock");
}

mod import {
    use coin_schemas::household::Position;
    use jiff::civil::date;

    use super::*;
    use crate::test_home::episode;

    fn contents(store: &Store) -> (Vec<StoredObject>, Option<Household>, u64, Option<jiff::civil::DateTime>) {
        store
            .read::<_, StoreError>(|reader| {
                Ok((reader.objects()?, reader.household()?, reader.event_count()?, reader.clock()?))
            })
            .unwrap()
    }

    #[test]
    fn an_episode_becomes_a_home() {
        let store = Store::open_in_memory().unwrap();
        let summary = store.import(&episode()).unwrap();
        let usage = UsageCounts { recorded: 7, unattributed: 1, duplicates: 0 };
        assert_eq!(summary, ImportSummary { users: 3, objects: 5, usage });
        let (objects, household, events, clock) = contents(&store);
        assert_eq!(objects.len(), 5);
        assert_eq!(objects[0].position.metres(), [0.0, 0.0, 0.0]);
        assert_eq!(household.unwrap().roster(), &episode().roster);
        assert_eq!(events, 7);
        assert_eq!(clock, Some(date(2025, 1, 19).at(23, 0, 0, 0)), "not the later caption's time");
    }

    #[test]
    fn importing_the_same_episode_twice_changes_nothing() {
        let store = Store::open_in_memory().unwrap();
        store.import(&episode()).unwrap();
        let before = contents(&store);
        let summary = store.import(&episode()).unwrap();
        assert_eq!(summary.usage, UsageCounts { recorded: 0, unattributed: 0, duplicates: 7 });
        assert_eq!(contents(&store), before);
    }

    #[test]
    fn a_longer_take_of_the_same_recording_is_added() {
        let mut beginning = episode();
        beginning.captions.truncate(3);
        beginning.observations.truncate(3);
        beginning.episode.now = date(2025, 1, 18).at(12, 0, 0, 0);
        let (continued, whole) = (Store::open_in_memory().unwrap(), Store::open_in_memory().unwrap());
        continued.import(&beginning).unwrap();
        continued.import(&episode()).unwrap();
        whole.import(&episode()).unwrap();
        assert_eq!(contents(&continued), contents(&whole));
    }

    /// People are told by their place among all, which moves when somebody joins whose name comes first.
    #[test]
    fn a_longer_take_is_added_to_a_home_that_somebody_has_joined() {
        let mut beginning = episode();
        beginning.captions.truncate(3);
        beginning.observations.truncate(3);
        let store = Store::open_in_memory().unwrap();
        store.import(&beginning).unwrap();
        let ann = UserName::new("Ann").unwrap();
        let cook = Background { role: None, occupation: Some("cook".to_owned()) };
        store.write(|writer| writer.put_user(&ann, &cook)).unwrap();
        store.write(|writer| writer.put_user(&bob(), &cook)).unwrap();
        store.import(&episode()).unwrap();
        let whole = Store::open_in_memory().unwrap();
        whole.import(&episode()).unwrap();
        assert_eq!(actors(&store), actors(&whole));
    }

    /// Who did what is written down, by name.
    fn actors(store: &Store) -> Vec<(String, Option<String>)> {
        store
            .read(|reader| {
                let household = reader.household()?.unwrap();
                let mut actors = Vec::new();
                for object in reader.objects()? {
                    let log = reader.usage(&household, object.key, i64::MIN, i64::MAX)?;
                    for (place, event) in log.events.iter().enumerate() {
                        let actor = event.actor.map(|user| household.roster().name(user).to_string());
                        actors.push((log.caption(place).to_owned(), actor));
                    }
                }
                Ok::<_, StoreError>(actors)
            })
            .unwrap()
    }

    #[test]
    fn another_home_is_refused_and_the_first_one_kept() {
        type Change = fn(&mut crate::episode::LoadedEpisode);
        let changes: [Change; 6] = [
            |other| other.episode.name = "another home".to_owned(),
            |other| other.episode.objects[0].position = Position::new([9.0, 0.0, 0.0]).unwrap(),
            |other| other.episode.objects[2].id = coin_schemas::household::ObjectId::new("cup-b").unwrap(),
            |other| other.features.as_mut().unwrap()[0][7] = 1.0,
            |other| other.features = None,
            |other| {
                other.episode.users.insert(UserName::new("Ann").unwrap(), Background::default());
            },
        ];
        let store = Store::open_in_memory().unwrap();
        store.import(&episode()).unwrap();
        let before = contents(&store);
        let mut messages = String::new();
        for change in changes {
            let mut other = episode();
            change(&mut other);
            messages.push_str(&store.import(&other).unwrap_err().to_string());
            messages.push('\n');
            assert_eq!(contents(&store), before);
        }
        insta::assert_snapshot!(messages);
    }

    #[test]
    fn a_home_that_was_not_imported_is_refused() {
        let store = Store::open_in_memory().unwrap();
        add_bob(&store);
        insta::assert_snapshot!(store.import(&episode()).unwrap_err(), @"the database already holds another home (it was not imported from an episode); import the episode into a new file, named with --db");
    }

    #[test]
    fn an_import_that_fails_half_way_leaves_nothing_behind() {
        let mut broken = episode();
        broken.captions[6].object_id = coin_schemas::household::ObjectId::new("nothing").unwrap();
        let store = Store::open_in_memory().unwrap();
        store.import(&broken).unwrap_err();
        assert_eq!(contents(&store), (Vec::new(), None, 0, None));
    }

    #[test]
    fn features_come_back_bit_by_bit() {
        let store = Store::open_in_memory().unwrap();
        let mut loaded = episode();
        let feature = &mut loaded.features.as_mut().unwrap()[0];
        for (component, number) in feature.iter_mut().zip(1_u16..) {
            *component = 1.0 / f32::from(number) - 0.1;
        }
        let expected = feature.to_vec();
        store.import(&loaded).unwrap();
        let features = store.read::<_, StoreError>(|reader| {
            let key = reader.object("1")?.unwrap().key;
            Ok((reader.feature(key)?, reader.features()?.remove(&key), reader.features()?.len()))
        });
        assert_eq!(features.unwrap(), (Some(expected.clone()), Some(expected), 4));
    }
}
