-- The checksum of the whole file as a run left it: where the file is still the same, nothing in it needs to be checked
-- row by row. At most one row; none: a run has not ended since, or left damage behind.
CREATE TABLE file_checksum (
    only     INTEGER PRIMARY KEY CHECK (only = 1),
    pages    INTEGER NOT NULL,  -- of the file
    checksum INTEGER NOT NULL   -- sum of the pages' XXH3 64-bit, seeded with their numbers, modulo 2^64 (sweep/store/file_checksum.hpp)
) STRICT;
