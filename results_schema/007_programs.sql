-- Programs as scenes. What a campaign's program is, and the contents of its files and templates, so that a case can be
-- explained and repeated from the archive alone.
CREATE TABLE program (
    scene      TEXT PRIMARY KEY,  -- "program:" and the hash of what changes an answer
    definition TEXT NOT NULL      -- command, files by the hash of their contents, observables, settings: a JSON object
) STRICT, WITHOUT ROWID;

CREATE TABLE program_content (
    hash     TEXT PRIMARY KEY,  -- XXH3 128-bit of the contents, hexadecimal
    contents BLOB NOT NULL
) STRICT;

-- Of an attempt that a program answered.
CREATE TABLE attempt_program (
    case_key    INTEGER NOT NULL REFERENCES sim_case,
    number      INTEGER NOT NULL,
    version     TEXT,              -- of the program, as its command says; NULL: the campaign gives none
    peak_memory REAL,              -- bytes resident at once, of the program or one of its children
    exit_status INTEGER,           -- negative: the signal that ended it; NULL: it went on living
    checksum    INTEGER NOT NULL,  -- of the row without it
    PRIMARY KEY (case_key, number)
) STRICT, WITHOUT ROWID;
