-- The map of things as it is made from what a robot sees (`coin::map`). What a thing is and where it is stands in
-- `objects` and `features`, as it does for things that were recorded; what follows is what the map has to remember beside that.

-- `recorded_at`: when the things of the recording were where it has them (seconds of local time). `map_revision` grows with
-- every change of the map, so that what a process keeps of it in memory is known to be out of date. The other two count the
-- ids that were given to things and to sightings, none of which is ever given again.
ALTER TABLE home ADD COLUMN recorded_at INTEGER;
ALTER TABLE home ADD COLUMN map_revision INTEGER NOT NULL DEFAULT 0;
ALTER TABLE home ADD COLUMN next_object INTEGER NOT NULL DEFAULT 1;
ALTER TABLE home ADD COLUMN next_sighting INTEGER NOT NULL DEFAULT 1;
UPDATE home SET recorded_at = clock;

CREATE TRIGGER new_objects_change_the_map AFTER INSERT ON objects BEGIN
    UPDATE home SET map_revision = map_revision + 1;
END;

-- The ids that robots give to their views.
CREATE TABLE views (
    view_key INTEGER PRIMARY KEY,
    view     TEXT NOT NULL UNIQUE
) STRICT;

-- Every detection, as it came: metres, and milliseconds of local time since 1970. `recorded` marks what stands for a thing
-- of a recording, which nobody detected.
CREATE TABLE sightings (
    object_key INTEGER NOT NULL REFERENCES objects (object_key),
    sighting   INTEGER NOT NULL,
    class      TEXT NOT NULL,
    x          REAL NOT NULL,
    y          REAL NOT NULL,
    z          REAL NOT NULL,
    radius     REAL NOT NULL,
    at         INTEGER NOT NULL,
    view_key   INTEGER REFERENCES views (view_key),
    recorded   INTEGER NOT NULL CHECK (recorded IN (0, 1)),
    PRIMARY KEY (object_key, sighting)
) WITHOUT ROWID, STRICT;

-- The features of detections that had one: 512 numbers of 32 bits, little endian, as they were handed in.
CREATE TABLE sighting_features (
    sighting INTEGER PRIMARY KEY,
    vector   BLOB NOT NULL CHECK (length(vector) = 2048)
) STRICT;

-- What the map knows of a thing that was detected: the sum of 1/radius over the sightings at its present place and their
-- number, the sum of its features (512 numbers of 64 bits, little endian), and how many views missed it. A recorded thing
-- has a row once something was seen of it or of its place.
CREATE TABLE map_entries (
    object_key INTEGER PRIMARY KEY REFERENCES objects (object_key),
    weight     REAL NOT NULL,
    sightings  INTEGER NOT NULL,
    look       BLOB CHECK (look IS NULL OR length(look) = 4096),
    first_seen INTEGER NOT NULL,
    last_seen  INTEGER NOT NULL,
    absences   INTEGER NOT NULL,
    undecided  INTEGER NOT NULL CHECK (undecided IN (0, 1))
) STRICT;

-- Where a thing was before it was moved, and since when it has been seen elsewhere.
CREATE TABLE map_moves (
    object_key INTEGER NOT NULL REFERENCES objects (object_key),
    number     INTEGER NOT NULL,
    at         INTEGER NOT NULL,
    x          REAL NOT NULL,
    y          REAL NOT NULL,
    z          REAL NOT NULL,
    PRIMARY KEY (object_key, number)
) WITHOUT ROWID, STRICT;

-- Things that a person said are two. The other one may have become a part of a third since.
CREATE TABLE told_apart (
    object_key INTEGER NOT NULL REFERENCES objects (object_key),
    other_key  INTEGER NOT NULL,
    PRIMARY KEY (object_key, other_key)
) WITHOUT ROWID, STRICT;

-- Ids that a thing had before it was found to be another thing that was known already. They still name it.
CREATE TABLE former_ids (
    id         TEXT PRIMARY KEY,
    object_key INTEGER NOT NULL REFERENCES objects (object_key)
) WITHOUT ROWID, STRICT;
CREATE INDEX former_ids_of_objects ON former_ids (object_key);

-- What was found out about a thing, in the order in which it was: that it had moved, that another id was a part of it, or
-- that another thing was taken out of it.
CREATE TABLE map_changes (
    sequence   INTEGER PRIMARY KEY,
    object_key INTEGER NOT NULL REFERENCES objects (object_key),
    kind       TEXT NOT NULL CHECK (kind IN ('moved', 'merged', 'split')),
    other      TEXT NOT NULL,
    at         INTEGER NOT NULL
) STRICT;
CREATE INDEX map_changes_of_objects ON map_changes (object_key);
