-- Results of cases that were computed elsewhere (`grainsweep import`). Their attempt has no computer and no seconds: its
-- `started` is the date of the import. The contents of the file are in program_content.
CREATE TABLE attempt_import (
    case_key INTEGER NOT NULL REFERENCES sim_case,
    number   INTEGER NOT NULL,  -- of the attempt
    name     TEXT NOT NULL,     -- of the file, without its folder
    hash     TEXT NOT NULL,     -- of the file's contents
    line     INTEGER NOT NULL,  -- in the file; its header is line 1
    checksum INTEGER NOT NULL,  -- of the row without it
    PRIMARY KEY (case_key, number)
) STRICT, WITHOUT ROWID;

-- Campaigns of imported cases that no design placed. Models use their cases, statistics do not.
CREATE TABLE campaign_import (
    campaign_id INTEGER PRIMARY KEY REFERENCES campaign,
    of_campaign INTEGER NOT NULL REFERENCES campaign  -- the campaign into which they were imported
) STRICT;
