-- What computed an attempt, and where. On a cluster of mixed machines two attempts of one run differ.
CREATE TABLE attempt_computer (
    computer_id      INTEGER PRIMARY KEY,
    version          TEXT NOT NULL,   -- of grainsweep
    "commit"         TEXT NOT NULL,   -- of its sources
    build            TEXT NOT NULL,   -- id of the executable, hexadecimal; empty: from before this table
    instruction_path TEXT NOT NULL,   -- instruction set of the inner loops: x86-64-v2, avx2, avx512
    processor        TEXT NOT NULL,
    host             TEXT NOT NULL,
    UNIQUE (version, "commit", build, instruction_path, processor, host)
) STRICT;

-- Of older attempts it is known which program on which machine ran the campaign.
INSERT INTO attempt_computer (version, "commit", build, instruction_path, processor, host)
SELECT DISTINCT version, "commit", '', instruction_path, processor, host FROM provenance;

ALTER TABLE attempt ADD COLUMN computer_id INTEGER REFERENCES attempt_computer;  -- never NULL

UPDATE attempt SET computer_id = (
    SELECT m.computer_id FROM provenance AS v JOIN attempt_computer AS m
    ON m.build = '' AND (m.version, m."commit", m.instruction_path, m.processor, m.host)
       = (v.version, v."commit", v.instruction_path, v.processor, v.host)
    WHERE v.provenance_id = attempt.provenance_id);
