-- Checksums of what is stored: XXH3 64-bit of canonical bytes (sweep/store/checksum.hpp). What was stored before
-- this gets its checksums when the file is brought up to date: it is protected from then on.
ALTER TABLE sim_case ADD COLUMN checksum INTEGER;  -- of key, id, outcome, wall_seconds and all it measured; NULL: no outcome
ALTER TABLE sim_case ADD COLUMN checksum_by_observable INTEGER;  -- what it measured, weighted by the observable's name
ALTER TABLE attempt ADD COLUMN checksum INTEGER;   -- of the row without it; NULL: running

-- Of whole tables, and of the rows of one campaign. The ids of cases are checksums of their inputs already.
CREATE TABLE table_checksum (
    name     TEXT NOT NULL,     -- of the table
    part     INTEGER NOT NULL,  -- campaign_id, or 0: all of it
    rows     INTEGER NOT NULL,
    checksum INTEGER NOT NULL,  -- sum of the rows' checksums, modulo 2^64
    PRIMARY KEY (name, part)
) STRICT, WITHOUT ROWID;
