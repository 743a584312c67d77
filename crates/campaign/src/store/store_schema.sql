-- Results of windfall, store version 1. All numbers are SI.

-- One fit of windfall; a later run never changes an earlier one.
CREATE TABLE runs (
    id       INTEGER PRIMARY KEY,
    time     TEXT NOT NULL,     -- UTC
    windfall TEXT NOT NULL,     -- version
    options  TEXT NOT NULL,     -- JSON: rig, channels, contact, fit
    seed     INTEGER            -- where chance played a part
);

-- Files that a run read.
CREATE TABLE inputs (
    run    INTEGER NOT NULL REFERENCES runs (id),
    path   TEXT NOT NULL,
    sha256 TEXT NOT NULL,
    PRIMARY KEY (run, path)
) WITHOUT ROWID;

-- One law fitted to one impact. The key is the SHA-256 of everything that the
-- result depends on, so equal keys mean equal results.
CREATE TABLE results (
    key       TEXT PRIMARY KEY,
    impact    TEXT NOT NULL,
    specimen  TEXT NOT NULL,
    file      TEXT NOT NULL,
    law       TEXT NOT NULL,
    cost      REAL NOT NULL,
    samples   INTEGER NOT NULL,
    converged INTEGER NOT NULL,
    document  TEXT NOT NULL     -- JSON: the whole result, with all digits
) WITHOUT ROWID;

-- Which results a run consists of, in order.
CREATE TABLE run_results (
    run      INTEGER NOT NULL REFERENCES runs (id),
    position INTEGER NOT NULL,
    key      TEXT NOT NULL REFERENCES results (key),
    PRIMARY KEY (run, position)
) WITHOUT ROWID;

-- What a run could not fit.
CREATE TABLE failures (
    run      INTEGER NOT NULL REFERENCES runs (id),
    position INTEGER NOT NULL,
    impact   TEXT NOT NULL,
    specimen TEXT NOT NULL,
    file     TEXT NOT NULL,
    law      TEXT,
    message  TEXT NOT NULL,
    PRIMARY KEY (run, position)
) WITHOUT ROWID;

CREATE TABLE parameters (
    key      TEXT NOT NULL REFERENCES results (key),
    position INTEGER NOT NULL,
    name     TEXT NOT NULL,
    value    REAL NOT NULL,
    sd       REAL,              -- NULL for a value that was held
    low      REAL,              -- 95 % interval
    high     REAL,
    unit     TEXT NOT NULL,
    PRIMARY KEY (key, position)
) WITHOUT ROWID;

CREATE TABLE derived (
    key         TEXT NOT NULL REFERENCES results (key),
    name        TEXT NOT NULL,
    value       REAL,
    value_from TEXT NOT NULL,   -- "signal" or "fit"
    PRIMARY KEY (key, name)
) WITHOUT ROWID;

CREATE TABLE findings (
    key      TEXT NOT NULL REFERENCES results (key),
    position INTEGER NOT NULL,
    code     TEXT NOT NULL,
    message  TEXT NOT NULL,
    PRIMARY KEY (key, position)
) WITHOUT ROWID;

-- Parameters of the newest run, for people with a database browser.
CREATE VIEW latest_parameters AS
SELECT r.impact, r.specimen, r.law, p.name, p.value, p.sd, p.low, p.high, p.unit
FROM run_results AS rr
JOIN results AS r ON r.key = rr.key
JOIN parameters AS p ON p.key = r.key
WHERE rr.run = (SELECT MAX(id) FROM runs)
ORDER BY rr.position, p.position;
