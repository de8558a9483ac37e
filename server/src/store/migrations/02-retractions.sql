-- When an answer was taken back; NULL where it was not. The answer stays in the history.
ALTER TABLE answers ADD COLUMN retracted_at INTEGER;
