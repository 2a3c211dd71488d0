-- Files that a campaign used: STL and size files of its scene, powder, list and measured curves, so that the archive alone
-- explains and repeats a case. Their contents are in program_content, with those of programs and machines.
CREATE TABLE campaign_file (
    campaign_id INTEGER NOT NULL REFERENCES campaign,
    place       TEXT NOT NULL,     -- where the campaign file names it: $.fixed.size_file
    name        TEXT NOT NULL,     -- as it is named there, or what the program calls contents that it made
    hash        TEXT NOT NULL,     -- of its contents, in program_content
    checksum    INTEGER NOT NULL,  -- of the row without it
    PRIMARY KEY (campaign_id, place, hash)
) STRICT, WITHOUT ROWID;
