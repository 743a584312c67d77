-- What store version 2 adds: results of campaigns that fit no impacts
-- (compression, acoustic, repeats).

-- One result on one recording. The key is the SHA-256 of everything that it
-- depends on, so equal keys mean equal results.
CREATE TABLE documents (
    key      TEXT PRIMARY KEY,
    kind     TEXT NOT NULL,     -- kind of the campaign
    item     TEXT NOT NULL,     -- id in impacts.csv
    specimen TEXT NOT NULL,
    file     TEXT NOT NULL,
    document TEXT NOT NULL      -- JSON: the whole result, with all digits
) WITHOUT ROWID;

-- Which documents a run consists of, in order.
CREATE TABLE run_documents (
    run      INTEGER NOT NULL REFERENCES runs (id),
    position INTEGER NOT NULL,
    key      TEXT NOT NULL REFERENCES documents (key),
    PRIMARY KEY (run, position)
) WITHOUT ROWID;

-- Numbers of a document, for people with a database browser.
CREATE TABLE document_values (
    key      TEXT NOT NULL REFERENCES documents (key),
    position INTEGER NOT NULL,
    name     TEXT NOT NULL,
    value    REAL NOT NULL,
    sd       REAL,
    unit     TEXT NOT NULL,     -- SI
    PRIMARY KEY (key, position)
) WITHOUT ROWID;
