-- Machines as scenes. What a campaign's machine file says, so that a case can be explained and repeated from the archive
-- alone. The contents of its files are in program_content.
CREATE TABLE machine (
    scene      TEXT PRIMARY KEY,  -- "machine:" and the hash of what changes an answer
    name       TEXT NOT NULL,     -- the machine's own name
    definition TEXT NOT NULL      -- the machine file, and its files by the hash of their contents: a JSON object
) STRICT, WITHOUT ROWID;
