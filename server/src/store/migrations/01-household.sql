-- "COIN": a file with another mark belongs to another program and is refused.
PRAGMA application_id = 0x434F494E;

-- One row about the home itself. `clock` is the home's present (seconds of local wall-clock time since 1970)
-- where the home was imported from a recording; NULL where the home lives by the wall clock.
CREATE TABLE home (
    id        INTEGER PRIMARY KEY CHECK (id = 1),
    recording TEXT,
    clock     INTEGER
) STRICT;
INSERT INTO home (id) VALUES (1);

-- The key of a person never changes, whoever joins the home later; the place in the roster does.
CREATE TABLE users (
    user_key   INTEGER PRIMARY KEY,
    name       TEXT NOT NULL UNIQUE,
    role       TEXT,
    occupation TEXT
) STRICT;

CREATE TABLE objects (
    object_key INTEGER PRIMARY KEY,
    id         TEXT NOT NULL UNIQUE,
    class      TEXT NOT NULL,
    x          REAL NOT NULL,
    y          REAL NOT NULL,
    z          REAL NOT NULL,
    room       TEXT
) STRICT;

-- 512 numbers of 32 bits, little endian, as they were handed in (not normalised).
CREATE TABLE features (
    object_key INTEGER PRIMARY KEY REFERENCES objects (object_key),
    vector     BLOB NOT NULL CHECK (length(vector) = 2048)
) STRICT;

-- Clustered by thing and time, so that a summary reads one run of pages however large the table is. The raw
-- line belongs to the key: the same line about the same thing is the same event, and lines of the same moment
-- are ordered by their text and not by their arrival.
CREATE TABLE usage_events (
    object_key INTEGER NOT NULL REFERENCES objects (object_key),
    at         INTEGER NOT NULL,
    caption    TEXT NOT NULL,
    actor      INTEGER REFERENCES users (user_key),
    action     INTEGER NOT NULL,
    PRIMARY KEY (object_key, at, caption)
) WITHOUT ROWID, STRICT;

-- What a model last concluded. JSON columns hold names, as the tools exchange them.
CREATE TABLE inferences (
    object_key INTEGER PRIMARY KEY REFERENCES objects (object_key),
    model      TEXT,
    scores     TEXT NOT NULL,
    owner_sets TEXT,
    owners     TEXT NOT NULL,
    confidence REAL NOT NULL,
    settled    INTEGER NOT NULL CHECK (settled IN (0, 1))
) STRICT;

-- Everything that people said, in the order in which it was recorded.
CREATE TABLE answers (
    object_key  INTEGER NOT NULL REFERENCES objects (object_key),
    sequence    INTEGER NOT NULL,
    question    TEXT NOT NULL,
    answer      TEXT NOT NULL,
    ownership   TEXT NOT NULL,
    outside     INTEGER NOT NULL CHECK (outside IN (0, 1)),
    answered_by INTEGER REFERENCES users (user_key),
    at          INTEGER NOT NULL,
    status      TEXT NOT NULL CHECK (status IN ('answered', 'unresolved')),
    PRIMARY KEY (object_key, sequence)
) WITHOUT ROWID, STRICT;

-- The answer that is believed at present. It outweighs any inference.
CREATE TABLE present_answers (
    object_key INTEGER PRIMARY KEY,
    sequence   INTEGER NOT NULL,
    FOREIGN KEY (object_key, sequence) REFERENCES answers (object_key, sequence)
) STRICT;
