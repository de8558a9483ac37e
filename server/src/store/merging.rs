//! Two things are found to be one: everything that was known under the one key is known under the other from then on.

use rusqlite::OptionalExtension;

use super::map::ObjectKey;
use super::{StoreError, Writer};

/// An answer, by its place among those about its thing, and when it was given.
type PresentAnswer = (i64, i64);

impl Writer<'_> {
    /// Gives everything that is known of a thing to another one, and takes it out of the map. Its id names the other one
    /// from then on.
    pub(super) fn absorb(&self, part: ObjectKey, whole: ObjectKey, id: &str) -> Result<(), StoreError> {
        self.keep_recorded_feature(part)?;
        self.give_answers(part, whole)?;
        let keys = (part.0, whole.0);
        for statement in [
            "INSERT INTO usage_events SELECT ?2, at, caption, actor, action FROM usage_events WHERE object_key = ?1
             ON CONFLICT DO NOTHING",
            "UPDATE OR IGNORE inferences SET object_key = ?2 WHERE object_key = ?1",
            "UPDATE refusals SET object_key = ?2, sequence = sequence +
                 (SELECT coalesce(max(sequence), 0) FROM refusals WHERE object_key = ?2) WHERE object_key = ?1",
            "UPDATE sightings SET object_key = ?2 WHERE object_key = ?1",
            "UPDATE map_changes SET object_key = ?2 WHERE object_key = ?1",
            "UPDATE former_ids SET object_key = ?2 WHERE object_key = ?1",
        ] {
            self.connection.prepare_cached(statement)?.execute(keys)?;
        }
        for table in
            ["usage_events", "inferences", "map_entries", "map_moves", "told_apart", "features", "objects"]
        {
            self.connection
                .prepare_cached(&format!("DELETE FROM {table} WHERE object_key = ?1"))?
                .execute([part.0])?;
        }
        self.connection
            .prepare_cached("INSERT INTO former_ids (id, object_key) VALUES (?1, ?2)")?
            .execute((id, whole.0))?;
        Ok(())
    }

    /// The answers follow those about the other thing; of the two that are believed, the later one is.
    fn give_answers(&self, part: ObjectKey, whole: ObjectKey) -> Result<(), StoreError> {
        let given = self.present_answer(part)?;
        let believed = self.present_answer(whole)?;
        let before: i64 = self
            .connection
            .prepare_cached("SELECT coalesce(max(sequence), 0) FROM answers WHERE object_key = ?1")?
            .query_row([whole.0], |row| row.get(0))?;
        self.connection
            .prepare_cached("DELETE FROM present_answers WHERE object_key = ?1")?
            .execute([part.0])?;
        self.connection
            .prepare_cached(
                "UPDATE answers SET object_key = ?2, sequence = sequence + ?3 WHERE object_key = ?1",
            )?
            .execute((part.0, whole.0, before))?;
        if let Some((sequence, at)) = given
            && believed.is_none_or(|(_, believed_at)| at > believed_at)
        {
            self.connection
                .prepare_cached(
                    "INSERT INTO present_answers (object_key, sequence) VALUES (?1, ?2)
                     ON CONFLICT (object_key) DO UPDATE SET sequence = excluded.sequence",
                )?
                .execute((whole.0, sequence + before))?;
        }
        Ok(())
    }

    fn present_answer(&self, object: ObjectKey) -> Result<Option<PresentAnswer>, StoreError> {
        let mut statement = self.connection.prepare_cached(
            "SELECT sequence, at FROM present_answers JOIN answers USING (object_key, sequence) WHERE object_key = ?1",
        )?;
        Ok(statement.query_row([object.0], |row| Ok((row.get(0)?, row.get(1)?))).optional()?)
    }
}
