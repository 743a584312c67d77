-- What store version 3 adds: a digest of each document, with its key, so that a
-- document that is not what was written is not answered from.
ALTER TABLE results ADD COLUMN sha256 TEXT;
ALTER TABLE documents ADD COLUMN sha256 TEXT;
