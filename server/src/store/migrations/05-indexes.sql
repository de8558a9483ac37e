-- Where things are, for a search that does not read all of them. The boxes hold numbers of 32 bits, rounded outwards, so
-- that the exact position lies in its box; beyond their range a box stands at its edge.
CREATE VIRTUAL TABLE places USING rtree (
    object_key, least_x, greatest_x, least_y, greatest_y, least_z, greatest_z
);

-- Triggers keep it in step, so that no statement can forget to.
CREATE TRIGGER new_objects_have_places AFTER INSERT ON objects BEGIN
    INSERT INTO places
    SELECT NEW.object_key, x, x, y, y, z, z
    FROM (SELECT max(min(NEW.x, 3e38), -3e38) AS x, max(min(NEW.y, 3e38), -3e38) AS y,
                 max(min(NEW.z, 3e38), -3e38) AS z);
END;
CREATE TRIGGER moved_objects_have_new_places AFTER UPDATE OF object_key, x, y, z ON objects BEGIN
    DELETE FROM places WHERE object_key = OLD.object_key;
    INSERT INTO places
    SELECT NEW.object_key, x, x, y, y, z, z
    FROM (SELECT max(min(NEW.x, 3e38), -3e38) AS x, max(min(NEW.y, 3e38), -3e38) AS y,
                 max(min(NEW.z, 3e38), -3e38) AS z);
END;
CREATE TRIGGER deleted_objects_have_no_places AFTER DELETE ON objects BEGIN
    DELETE FROM places WHERE object_key = OLD.object_key;
END;

INSERT INTO places
SELECT object_key, x, x, y, y, z, z
FROM (SELECT object_key, max(min(x, 3e38), -3e38) AS x, max(min(y, 3e38), -3e38) AS y,
             max(min(z, 3e38), -3e38) AS z FROM objects);

-- Which features have changed, in the order in which they last did: what is kept of them outside of their table has a
-- revision, and is brought up to date by what changed since. A thing whose feature was deleted stays listed.
CREATE TABLE feature_changes (
    revision   INTEGER PRIMARY KEY AUTOINCREMENT,
    object_key INTEGER NOT NULL UNIQUE
) STRICT;

CREATE TRIGGER new_features_are_changes AFTER INSERT ON features BEGIN
    DELETE FROM feature_changes WHERE object_key = NEW.object_key;
    INSERT INTO feature_changes (object_key) VALUES (NEW.object_key);
END;
CREATE TRIGGER other_features_are_changes AFTER UPDATE ON features BEGIN
    DELETE FROM feature_changes WHERE object_key IN (OLD.object_key, NEW.object_key);
    INSERT INTO feature_changes (object_key) VALUES (NEW.object_key);
    INSERT INTO feature_changes (object_key) SELECT OLD.object_key WHERE OLD.object_key <> NEW.object_key;
END;
CREATE TRIGGER deleted_features_are_changes AFTER DELETE ON features BEGIN
    DELETE FROM feature_changes WHERE object_key = OLD.object_key;
    INSERT INTO feature_changes (object_key) VALUES (OLD.object_key);
END;

INSERT INTO feature_changes (object_key) SELECT object_key FROM features;

-- The approximate index of features, where there are many. It tells what was so at its revision; what has changed since
-- is looked at beside it. `generation` is drawn at random, so that nobody takes one index for another.
CREATE TABLE look_index (
    id         INTEGER PRIMARY KEY CHECK (id = 1),
    generation INTEGER NOT NULL,
    revision   INTEGER NOT NULL,
    trained_on INTEGER NOT NULL
) STRICT;

-- The middle of each list of features: numbers of 32 bits, little endian.
CREATE TABLE look_lists (
    list   INTEGER PRIMARY KEY,
    middle BLOB NOT NULL
) STRICT;

-- What is in the lists. `codes` holds many features, one after the other: the key of the thing (64 bits, little endian),
-- the size of a step (32 bits) and a number of 8 bits for each component. A code may be out of date; what comes of it is
-- measured by the feature itself.
CREATE TABLE look_codes (
    list  INTEGER NOT NULL REFERENCES look_lists (list),
    pack  INTEGER NOT NULL,
    codes BLOB NOT NULL,
    PRIMARY KEY (list, pack)
) WITHOUT ROWID, STRICT;
