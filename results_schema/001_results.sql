-- The archive of grainsweep: every question asked, every attempt at an answer, every answer.
--
-- A case is a question to a scene, known by the hash of what is asked; campaigns place cases in their designs,
-- and two campaigns that ask the same question share the case and its answer. Whole numbers stand for the
-- 32-digit case ids and for names inside the tables; the views at the end of the road (one per campaign,
-- `series`, `inputs`, `convergence_history`) speak in ids and names.
--
-- Numbers are SI doubles as computed. NULL: undefined, or not there yet.

-- One row per run of the program over this file: which program computed, on what machine, asked by which text.
CREATE TABLE provenance (
    provenance_id    INTEGER PRIMARY KEY,
    campaign_id      INTEGER NOT NULL REFERENCES campaign,
    version          TEXT NOT NULL,   -- of grainsweep
    "commit"         TEXT NOT NULL,   -- of its sources
    compiler         TEXT NOT NULL,
    flags            TEXT NOT NULL,   -- compiler flags
    instruction_path TEXT NOT NULL,   -- instruction set of the inner loops: x86-64-v2, avx2, avx512
    processor        TEXT NOT NULL,
    host             TEXT NOT NULL,
    start            TEXT NOT NULL,   -- UTC, ISO 8601
    campaign_text    TEXT NOT NULL,   -- the campaign file as read
    campaign_hash    TEXT NOT NULL,   -- XXH3 128-bit of it, hexadecimal
    settled          INTEGER NOT NULL DEFAULT 0,  -- attempts finished in this run
    last_result      TEXT             -- when the last of them was written, UTC
) STRICT;

-- What a campaign is. Everything up to `design_options` is its identity: the same name with another of these
-- is another question and refused. What follows may change or grow.
CREATE TABLE campaign (
    campaign_id   INTEGER PRIMARY KEY,
    name          TEXT NOT NULL UNIQUE COLLATE NOCASE,  -- also the name of its view
    scene         TEXT NOT NULL,
    revision      INTEGER NOT NULL,  -- of the scene
    seed          INTEGER NOT NULL,  -- bits of the unsigned 64-bit campaign seed
    factors       TEXT NOT NULL,     -- one line each, in order: "name between low high scale" or "name levels a | b | ..."
    fixed         TEXT NOT NULL,     -- one line each: name = value, the accuracy setting resolved
    condition     TEXT NOT NULL,     -- the `where` expression, empty: every point
    design        TEXT NOT NULL,     -- kind
    design_options TEXT NOT NULL,    -- one line each: options that are not mere counts of points
    design_extent TEXT NOT NULL,     -- one line each: options that may grow (points, levels)
    sequences     INTEGER NOT NULL,  -- point p belongs to sequence p mod sequences
    replicates    INTEGER NOT NULL,  -- repeats of each point with other seeds
    convergence_observable TEXT,     -- NULL: no rule was given
    convergence_rule       TEXT,     -- replicates | assisted | any_change | all_change
    convergence_gates      TEXT,     -- statistics judged, separated by spaces
    convergence_tolerance  REAL,
    convergence_block      INTEGER,  -- points between two checks
    convergence_stop       INTEGER,  -- 1: the campaign ends once converged
    stopped_at    INTEGER            -- converged and stopped: points numbered below this count, no others
) STRICT;

-- A scene's inputs, as of one revision. A case stores only what differs from these defaults.
CREATE TABLE parameter (
    parameter_id  INTEGER PRIMARY KEY,
    scene         TEXT NOT NULL,
    revision      INTEGER NOT NULL,
    name          TEXT NOT NULL,
    unit          TEXT NOT NULL,   -- "1": a pure number, "": a word
    meaning       TEXT NOT NULL,
    default_value ANY NOT NULL,    -- REAL, INTEGER or TEXT: the parameter's type
    UNIQUE (scene, revision, name)
) STRICT;

-- What a scene measures.
CREATE TABLE observable (
    observable_id INTEGER PRIMARY KEY,
    scene         TEXT NOT NULL,
    revision      INTEGER NOT NULL,
    name          TEXT NOT NULL,
    unit          TEXT NOT NULL,
    meaning       TEXT NOT NULL,
    shape         TEXT NOT NULL CHECK (shape IN ('scalar', 'series', 'profile')),
    UNIQUE (scene, revision, name)
) STRICT;

-- A question, and what became of it (`attempts` to `wall_seconds` repeat the attempt table for speed).
CREATE TABLE sim_case (
    case_key     INTEGER PRIMARY KEY,
    case_id      TEXT NOT NULL UNIQUE,  -- XXH3 128-bit of the canonical text of the question, hexadecimal
    scene        TEXT NOT NULL,
    revision     INTEGER NOT NULL,      -- of the scene; grows whenever its answers change on purpose
    seed         INTEGER NOT NULL,      -- of the case's random numbers, below 2^63
    attempts     INTEGER NOT NULL DEFAULT 0,  -- highest attempt number begun
    failures     INTEGER NOT NULL DEFAULT 0,  -- attempts that crashed or timed out
    outcome      TEXT CHECK (outcome IN ('completed', 'skipped', 'unstable', 'rejected', 'crashed', 'timed_out',
                                         'abandoned')),  -- of the last finished attempt; NULL: none yet
    wall_seconds REAL                   -- of the last finished attempt
) STRICT;

-- The inputs of a case that differ from the defaults of its scene.
CREATE TABLE case_input (
    case_key     INTEGER NOT NULL REFERENCES sim_case,
    parameter_id INTEGER NOT NULL REFERENCES parameter,
    value        ANY NOT NULL,
    PRIMARY KEY (case_key, parameter_id)
) STRICT, WITHOUT ROWID;

-- Where a case stands in the design of a campaign. The same case may stand at several places.
CREATE TABLE campaign_case (
    campaign_id INTEGER NOT NULL REFERENCES campaign,
    point       INTEGER NOT NULL,  -- number of the design point, from 0; numbers filtered out by `where` are missing
    replicate   INTEGER NOT NULL,  -- from 0
    sequence    INTEGER NOT NULL,  -- of the point, from 0
    case_key    INTEGER NOT NULL REFERENCES sim_case,
    PRIMARY KEY (campaign_id, point, replicate)
) STRICT, WITHOUT ROWID;

-- One try at a case. Numbers start at 1 and only grow, also across runs.
CREATE TABLE attempt (
    case_key       INTEGER NOT NULL REFERENCES sim_case,
    number         INTEGER NOT NULL,
    provenance_id  INTEGER NOT NULL REFERENCES provenance,  -- the run it belongs to
    started        TEXT NOT NULL,      -- UTC, ISO 8601
    outcome        TEXT CHECK (outcome IN ('completed', 'skipped', 'unstable', 'rejected', 'crashed', 'timed_out',
                                           'abandoned')),  -- NULL: running, or its main program died
    message        TEXT,               -- why, where it is not completed
    wall_seconds   REAL,
    cpu_seconds    REAL,
    particle_steps REAL,               -- work done: particles times time steps
    phases         TEXT,               -- seconds by phase, a JSON object
    PRIMARY KEY (case_key, number)
) STRICT, WITHOUT ROWID;

-- What the last finished attempt measured. A scalar is one row with sample 0.
CREATE TABLE observation (
    case_key      INTEGER NOT NULL REFERENCES sim_case,
    observable_id INTEGER NOT NULL REFERENCES observable,
    sample        INTEGER NOT NULL,  -- place in the series or profile, from 0
    time          REAL,              -- NULL where it does not apply
    bin           REAL,              -- coordinate of a profile or histogram, NULL where it does not apply
    value         REAL,
    PRIMARY KEY (case_key, observable_id, sample)
) STRICT, WITHOUT ROWID;

-- Moments of an observable over the first points of a design, and their errors: one row per check.
CREATE TABLE convergence (
    campaign_id    INTEGER NOT NULL REFERENCES campaign,
    observable     TEXT NOT NULL,
    points         INTEGER NOT NULL,   -- the prefix: points numbered below this
    mean           REAL,
    sd             REAL,               -- divides by N
    skewness       REAL,               -- Pearson's second, 3 (mean - median) / sd
    g1             REAL,               -- moment skewness
    kurtosis       REAL,               -- not excess: 3 for a normal distribution
    mean_error     REAL,
    sd_error       REAL,
    skewness_error REAL,
    g1_error       REAL,
    kurtosis_error REAL,
    zero_share     REAL,               -- share of values that are exactly zero
    excluded       INTEGER NOT NULL,   -- cases of the prefix without a value
    converged      INTEGER NOT NULL,   -- 1: every gate within the tolerance
    PRIMARY KEY (campaign_id, observable, points)
) STRICT, WITHOUT ROWID;
