//! What makes a form that a client keeps for a while trustworthy when it comes back.

use rusqlite::OptionalExtension;

use super::{Reader, StoreError, Writer};

/// Bytes of the key that forms are sealed with.
pub const FORM_KEY_BYTES: usize = 32;

/// Bytes of a form's serial number.
pub const SERIAL_BYTES: usize = 16;

/// A form, told from every other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FormSerial(pub [u8; SERIAL_BYTES]);

/// Whether a form counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spending {
    /// It came back for the first time.
    First,
    /// It has counted before.
    Repeated,
}

impl Reader<'_> {
    /// The key that forms are sealed with, as soon as there is one.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn form_key(&self) -> Result<Option<[u8; FORM_KEY_BYTES]>, StoreError> {
        let mut statement = self.connection.prepare_cached("SELECT form_key FROM home")?;
        Ok(statement.query_row([], |row| row.get(0)).optional()?.flatten())
    }
}

impl Writer<'_> {
    /// Takes `key` for the key that forms are sealed with, unless there is one. The key from now on.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn propose_form_key(&self, key: &[u8; FORM_KEY_BYTES]) -> Result<[u8; FORM_KEY_BYTES], StoreError> {
        self.connection
            .prepare_cached("UPDATE home SET form_key = coalesce(form_key, ?1)")?
            .execute([&key[..]])?;
        self.form_key()?.ok_or_else(|| StoreError::damaged("the table home is empty"))
    }

    /// Counts a form, which expires at this time (seconds of UTC), as having come back now.
    ///
    /// # Errors
    /// Failures of the database.
    pub fn spend_form(&self, serial: FormSerial, expires_at: i64, now: i64) -> Result<Spending, StoreError> {
        self.connection.prepare_cached("DELETE FROM spent_forms WHERE expires_at < ?1")?.execute([now])?;
        let inserted = self
            .connection
            .prepare_cached(
                "INSERT INTO spent_forms (serial, expires_at) VALUES (?1, ?2) ON CONFLICT DO NOTHING",
            )?
            .execute((&serial.0[..], expires_at))?;
        Ok(if inserted == 0 { Spending::Repeated } else { Spending::First })
    }
}
