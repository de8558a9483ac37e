-- When a person joined the home, in seconds of its local time; NULL for those who were there from the beginning.
-- What was known of things before then says nothing of this person.
ALTER TABLE users ADD COLUMN joined_at INTEGER;

-- When somebody joined of whom the answer could not speak ("it is everybody's"); NULL where nobody did. From then on
-- the answer is not believed any more, and the thing may be asked about again.
ALTER TABLE answers ADD COLUMN reopened_at INTEGER;

-- Questions that a person heard and did not answer. One that was declined is not put again; one that was put away
-- (cancelled) may be.
CREATE TABLE refusals (
    object_key INTEGER NOT NULL REFERENCES objects (object_key),
    sequence   INTEGER NOT NULL,
    question   TEXT NOT NULL,
    outcome    TEXT NOT NULL CHECK (outcome IN ('declined', 'cancelled')),
    at         INTEGER NOT NULL,
    PRIMARY KEY (object_key, sequence)
) WITHOUT ROWID, STRICT;

-- The key that forms are sealed with. It stands here so that every server of this home opens the forms of every other.
ALTER TABLE home ADD COLUMN form_key BLOB CHECK (form_key IS NULL OR length(form_key) = 32);

-- Forms that came back, so that none counts twice. A row goes when its form would have expired (seconds of UTC).
CREATE TABLE spent_forms (
    serial     BLOB PRIMARY KEY CHECK (length(serial) = 16),
    expires_at INTEGER NOT NULL
) WITHOUT ROWID, STRICT;
