BEGIN TRANSACTION;
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
    phases         TEXT, computer_id INTEGER REFERENCES attempt_computer, checksum INTEGER, threads REAL,               -- seconds by phase, a JSON object
    PRIMARY KEY (case_key, number)
) STRICT, WITHOUT ROWID;
INSERT INTO "attempt" VALUES(1,1,1,'2026-11-29T05:09:41.523Z','unstable','asked to be unstable, everywhere, at once',0.000336048,3.32891000000000089609e-04,0.0,NULL,1,5766512105200306863,NULL);
INSERT INTO "attempt" VALUES(2,1,1,'2026-11-29T05:09:41.524Z','crashed','worker ended by signal 9 (Killed)',1.42006020000000066083e-02,NULL,NULL,NULL,1,-6385677057866650858,NULL);
INSERT INTO "attempt" VALUES(3,1,1,'2026-11-29T05:09:41.586Z','completed',NULL,1.2683e-05,1.25430000000002761506e-05,0.0,NULL,1,-6919126893458629014,1.0);
INSERT INTO "attempt" VALUES(4,1,1,'2026-11-29T05:09:41.586Z','unstable','asked to be unstable, everywhere, at once',5.941e-06,5.930999999998951e-06,0.0,NULL,1,5027920618425521378,NULL);
INSERT INTO "attempt" VALUES(5,1,1,'2026-11-29T05:09:41.524Z','crashed','worker ended by signal 9 (Killed)',4.47752199999999073165e-03,NULL,NULL,NULL,1,-36667334757337376,NULL);
INSERT INTO "attempt" VALUES(6,1,1,'2026-11-29T05:09:41.586Z','completed',NULL,5.831e-06,5.86099999999936671635e-06,0.0,NULL,1,-6465672319338034957,1.0);
INSERT INTO "attempt" VALUES(7,1,1,'2026-11-29T05:09:41.586Z','unstable','asked to be unstable, everywhere, at once',0.00033744,3.3468500000000036415e-04,0.0,NULL,1,-380741475499126416,NULL);
INSERT INTO "attempt" VALUES(8,1,1,'2026-11-29T05:09:41.565Z','crashed','worker ended by signal 9 (Killed)',1.13702860000000072204e-02,NULL,NULL,NULL,1,-8056992586064697596,NULL);
INSERT INTO "attempt" VALUES(9,1,1,'2026-11-29T05:09:41.602Z','completed',NULL,2.3544e-05,2.16100000000000319611e-05,0.0,NULL,1,2769543311737565628,1.0);
INSERT INTO "attempt" VALUES(10,1,1,'2026-11-29T05:09:41.602Z','unstable','asked to be unstable, everywhere, at once',6.522e-06,6.43200000000065941208e-06,0.0,NULL,1,7846684615895428788,NULL);
INSERT INTO "attempt" VALUES(11,1,1,'2026-11-29T05:09:41.602Z','crashed','worker ended by signal 9 (Killed)',1.27742789999999856176e-02,NULL,NULL,NULL,1,-2389618108039474473,NULL);
INSERT INTO "attempt" VALUES(12,1,1,'2026-11-29T05:09:41.631Z','completed',NULL,0.000301794,3.00400999999999619716e-04,0.0,NULL,1,-1094746093971538982,1.0);
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
INSERT INTO "attempt_computer" VALUES(1,'0.2.0','920fa19ec793-modified','ef04b92e79367e403587cc77f9a5c1f480747733','avx2','AMD EPYC','another host');
CREATE TABLE attempt_program (
    case_key    INTEGER NOT NULL REFERENCES sim_case,
    number      INTEGER NOT NULL,
    version     TEXT,              -- of the program, as its command says; NULL: the campaign gives none
    peak_memory REAL,              -- bytes resident at once, of the program or one of its children
    exit_status INTEGER,           -- negative: the signal that ended it; NULL: it went on living
    checksum    INTEGER NOT NULL,  -- of the row without it
    PRIMARY KEY (case_key, number)
) STRICT, WITHOUT ROWID;
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
, candidates INTEGER, asked_candidates INTEGER, asked_replicates INTEGER) STRICT;
INSERT INTO "campaign" VALUES(1,'old','rehearsal',1,1,'x1 between 0 1 linear
behaviour levels normal | unstable | crash
','noise = 0.1
','','halton','first = 1
scramble = none
sequences = 1
','points = 12
',1,1,NULL,NULL,NULL,NULL,NULL,NULL,NULL,12,12,1);
CREATE TABLE campaign_case (
    campaign_id INTEGER NOT NULL REFERENCES campaign,
    point       INTEGER NOT NULL,  -- number of the design point, from 0; numbers filtered out by `where` are missing
    replicate   INTEGER NOT NULL,  -- from 0
    sequence    INTEGER NOT NULL,  -- of the point, from 0
    case_key    INTEGER NOT NULL REFERENCES sim_case,
    PRIMARY KEY (campaign_id, point, replicate)
) STRICT, WITHOUT ROWID;
INSERT INTO "campaign_case" VALUES(1,0,0,0,1);
INSERT INTO "campaign_case" VALUES(1,1,0,0,2);
INSERT INTO "campaign_case" VALUES(1,2,0,0,3);
INSERT INTO "campaign_case" VALUES(1,3,0,0,4);
INSERT INTO "campaign_case" VALUES(1,4,0,0,5);
INSERT INTO "campaign_case" VALUES(1,5,0,0,6);
INSERT INTO "campaign_case" VALUES(1,6,0,0,7);
INSERT INTO "campaign_case" VALUES(1,7,0,0,8);
INSERT INTO "campaign_case" VALUES(1,8,0,0,9);
INSERT INTO "campaign_case" VALUES(1,9,0,0,10);
INSERT INTO "campaign_case" VALUES(1,10,0,0,11);
INSERT INTO "campaign_case" VALUES(1,11,0,0,12);
CREATE TABLE case_input (
    case_key     INTEGER NOT NULL REFERENCES sim_case,
    parameter_id INTEGER NOT NULL REFERENCES parameter,
    value        ANY NOT NULL,
    PRIMARY KEY (case_key, parameter_id)
) STRICT, WITHOUT ROWID;
INSERT INTO "case_input" VALUES(1,18,0.1);
INSERT INTO "case_input" VALUES(1,20,'unstable');
INSERT INTO "case_input" VALUES(2,1,0.25);
INSERT INTO "case_input" VALUES(2,18,0.1);
INSERT INTO "case_input" VALUES(2,20,'crash');
INSERT INTO "case_input" VALUES(3,1,0.75);
INSERT INTO "case_input" VALUES(3,18,0.1);
INSERT INTO "case_input" VALUES(4,1,0.125);
INSERT INTO "case_input" VALUES(4,18,0.1);
INSERT INTO "case_input" VALUES(4,20,'unstable');
INSERT INTO "case_input" VALUES(5,1,0.625);
INSERT INTO "case_input" VALUES(5,18,0.1);
INSERT INTO "case_input" VALUES(5,20,'crash');
INSERT INTO "case_input" VALUES(6,1,0.375);
INSERT INTO "case_input" VALUES(6,18,0.1);
INSERT INTO "case_input" VALUES(7,1,0.875);
INSERT INTO "case_input" VALUES(7,18,0.1);
INSERT INTO "case_input" VALUES(7,20,'unstable');
INSERT INTO "case_input" VALUES(8,1,0.0625);
INSERT INTO "case_input" VALUES(8,18,0.1);
INSERT INTO "case_input" VALUES(8,20,'crash');
INSERT INTO "case_input" VALUES(9,1,0.5625);
INSERT INTO "case_input" VALUES(9,18,0.1);
INSERT INTO "case_input" VALUES(10,1,0.3125);
INSERT INTO "case_input" VALUES(10,18,0.1);
INSERT INTO "case_input" VALUES(10,20,'unstable');
INSERT INTO "case_input" VALUES(11,1,0.8125);
INSERT INTO "case_input" VALUES(11,18,0.1);
INSERT INTO "case_input" VALUES(11,20,'crash');
INSERT INTO "case_input" VALUES(12,1,0.1875);
INSERT INTO "case_input" VALUES(12,18,0.1);
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
CREATE TABLE file_checksum (
    only     INTEGER PRIMARY KEY CHECK (only = 1),
    pages    INTEGER NOT NULL,  -- of the file
    checksum INTEGER NOT NULL   -- sum of the pages' XXH3 64-bit, seeded with their numbers, modulo 2^64 (sweep/store/file_checksum.hpp)
) STRICT;
INSERT INTO "file_checksum" VALUES(1,30,5653540371997037693);
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
INSERT INTO "observable" VALUES(1,'rehearsal',1,'y','1','the response','scalar');
INSERT INTO "observable" VALUES(2,'rehearsal',1,'y_series','1','y growing linearly in time (''huge'' only)','series');
CREATE TABLE observation (
    case_key      INTEGER NOT NULL REFERENCES sim_case,
    observable_id INTEGER NOT NULL REFERENCES observable,
    sample        INTEGER NOT NULL,  -- place in the series or profile, from 0
    time          REAL,              -- NULL where it does not apply
    bin           REAL,              -- coordinate of a profile or histogram, NULL where it does not apply
    value         REAL,
    PRIMARY KEY (case_key, observable_id, sample)
) STRICT, WITHOUT ROWID;
INSERT INTO "observation" VALUES(3,1,0,NULL,NULL,8.19056413514323544688e+00);
INSERT INTO "observation" VALUES(6,1,0,NULL,NULL,8.21455866573678150643e+00);
INSERT INTO "observation" VALUES(9,1,0,NULL,NULL,8.84046932780331395917e+00);
INSERT INTO "observation" VALUES(12,1,0,NULL,NULL,8.38567239961097676825e+00);
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
INSERT INTO "parameter" VALUES(1,'rehearsal',1,'x1','1','coordinate 1 of the response',0.5);
INSERT INTO "parameter" VALUES(2,'rehearsal',1,'x2','1','coordinate 2 of the response',0.5);
INSERT INTO "parameter" VALUES(3,'rehearsal',1,'x3','1','coordinate 3 of the response',0.5);
INSERT INTO "parameter" VALUES(4,'rehearsal',1,'x4','1','coordinate 4 of the response',0.5);
INSERT INTO "parameter" VALUES(5,'rehearsal',1,'x5','1','coordinate 5 of the response',0.5);
INSERT INTO "parameter" VALUES(6,'rehearsal',1,'x6','1','coordinate 6 of the response',0.5);
INSERT INTO "parameter" VALUES(7,'rehearsal',1,'x7','1','coordinate 7 of the response',0.5);
INSERT INTO "parameter" VALUES(8,'rehearsal',1,'x8','1','coordinate 8 of the response',0.5);
INSERT INTO "parameter" VALUES(9,'rehearsal',1,'x9','1','coordinate 9 of the response',0.5);
INSERT INTO "parameter" VALUES(10,'rehearsal',1,'x10','1','coordinate 10 of the response',0.5);
INSERT INTO "parameter" VALUES(11,'rehearsal',1,'x11','1','coordinate 11 of the response',0.5);
INSERT INTO "parameter" VALUES(12,'rehearsal',1,'x12','1','coordinate 12 of the response',0.5);
INSERT INTO "parameter" VALUES(13,'rehearsal',1,'x13','1','coordinate 13 of the response',0.5);
INSERT INTO "parameter" VALUES(14,'rehearsal',1,'x14','1','coordinate 14 of the response',0.5);
INSERT INTO "parameter" VALUES(15,'rehearsal',1,'x15','1','coordinate 15 of the response',0.5);
INSERT INTO "parameter" VALUES(16,'rehearsal',1,'x16','1','coordinate 16 of the response',0.5);
INSERT INTO "parameter" VALUES(17,'rehearsal',1,'response','','which known function answers','sum');
INSERT INTO "parameter" VALUES(18,'rehearsal',1,'noise','1','relative amplitude of a seeded disturbance',0.0);
INSERT INTO "parameter" VALUES(19,'rehearsal',1,'wait_seconds','s','time the case takes',0.0);
INSERT INTO "parameter" VALUES(20,'rehearsal',1,'behaviour','','what the case does instead of answering','normal');
INSERT INTO "parameter" VALUES(21,'rehearsal',1,'behave_attempts','1','only the first so many attempts misbehave (0: all of them)',0);
CREATE TABLE program (
    scene      TEXT PRIMARY KEY,  -- "program:" and the hash of what changes an answer
    definition TEXT NOT NULL      -- command, files by the hash of their contents, observables, settings: a JSON object
) STRICT, WITHOUT ROWID;
CREATE TABLE program_content (
    hash     TEXT PRIMARY KEY,  -- XXH3 128-bit of the contents, hexadecimal
    contents BLOB NOT NULL
) STRICT;
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
, process INTEGER) STRICT;
INSERT INTO "provenance" VALUES(1,1,'0.2.0','920fa19ec793-modified','GNU 12.2.0','-O3 -ffp-contract=off -march=x86-64-v2 -mtune=generic','avx2','AMD EPYC','another host','2026-11-29T05:09:41.438Z','{"campaign": "old", "scene": "rehearsal",
 "factors": [{"name": "x1", "between": [0, 1]}, {"name": "behaviour", "levels": ["normal", "unstable", "crash"]}],
 "fixed": {"noise": 0.1}, "design": {"kind": "halton", "scramble": "none", "points": 12}, "limits": {"attempts": 1}}
','8f0224d258497d0a787e5b22b8d52414',12,'2026-11-29T05:09:41.631Z',15174);
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
, checksum INTEGER, checksum_by_observable INTEGER) STRICT;
INSERT INTO "sim_case" VALUES(1,'26e481c5ceae247e05a493a94c0850fc','rehearsal',1,4027780897083882857,1,0,'unstable',0.000336048,-7802070473902666023,0);
INSERT INTO "sim_case" VALUES(2,'09921d2cb52836a4b56caab137cef478','rehearsal',1,8477647173853189248,1,1,'crashed',1.42006020000000066083e-02,-2203018525603159887,0);
INSERT INTO "sim_case" VALUES(3,'43c30ad45461b41566edee34df1cb320','rehearsal',1,7923041218659237822,1,0,'completed',1.2683e-05,-8881175857061462927,-2462090578144348121);
INSERT INTO "sim_case" VALUES(4,'db0e83908e999ddb6c27d48025d9099c','rehearsal',1,6712696820518210754,1,0,'unstable',5.941e-06,-3654693234618783704,0);
INSERT INTO "sim_case" VALUES(5,'a58d37f4488b86f990b75c32c66bdf69','rehearsal',1,2505957751542506453,1,1,'crashed',4.47752199999999073165e-03,7068786786572422925,0);
INSERT INTO "sim_case" VALUES(6,'72df882f52c475b1154516da028f607e','rehearsal',1,8221813873126021578,1,0,'completed',5.831e-06,9030985539115696750,6925454374190011762);
INSERT INTO "sim_case" VALUES(7,'614e7fb560b0189d443e2265ccfac4d4','rehearsal',1,6710606062648171534,1,0,'unstable',0.00033744,-2983197982344237971,0);
INSERT INTO "sim_case" VALUES(8,'a8ce813a239e6538a12693aa1ebe9b9d','rehearsal',1,7531093411465402821,1,1,'crashed',1.13702860000000072204e-02,6075094848565930126,0);
INSERT INTO "sim_case" VALUES(9,'c0ebcf946250cdecce587579456b35ed','rehearsal',1,3557864542977692829,1,0,'completed',2.3544e-05,-8234975424363095635,-5533606041763775311);
INSERT INTO "sim_case" VALUES(10,'5dff8c70397bbcbafa1bbc6b4c03e7f0','rehearsal',1,4306432995721382507,1,0,'unstable',6.522e-06,-5664163696222040198,0);
INSERT INTO "sim_case" VALUES(11,'3ba8380093c29ff4197b8835334e5dd2','rehearsal',1,7463758144734985363,1,1,'crashed',1.27742789999999856176e-02,-2352365461507978951,0);
INSERT INTO "sim_case" VALUES(12,'2ae941633aa99a127c439b614eed6137','rehearsal',1,5631990156663044590,1,0,'completed',0.000301794,150789390510296447,8510785597218274662);
CREATE TABLE table_checksum (
    name     TEXT NOT NULL,     -- of the table
    part     INTEGER NOT NULL,  -- campaign_id, or 0: all of it
    rows     INTEGER NOT NULL,
    checksum INTEGER NOT NULL,  -- sum of the rows' checksums, modulo 2^64
    PRIMARY KEY (name, part)
) STRICT, WITHOUT ROWID;
INSERT INTO "table_checksum" VALUES('attempt_computer',0,1,1784168011848067761);
INSERT INTO "table_checksum" VALUES('campaign',0,1,2235294346754152197);
INSERT INTO "table_checksum" VALUES('campaign_case',1,12,5342871777818818095);
INSERT INTO "table_checksum" VALUES('observable',0,2,8918183063755238609);
INSERT INTO "table_checksum" VALUES('parameter',0,21,1984711976638100739);
INSERT INTO "table_checksum" VALUES('provenance',0,1,-7583312136442615871);
INSERT INTO "table_checksum" VALUES('sqlite_schema',0,4,-7923407145364532836);
CREATE INDEX campaign_case_by_case ON campaign_case (case_key);
CREATE VIEW series AS
SELECT g.name AS campaign, p.point AS point, p.replicate AS replicate, c.case_id AS case_id, b.name AS observable,
       o.time AS time, o.bin AS bin, o.value AS value
FROM campaign AS g
JOIN campaign_case AS p ON p.campaign_id = g.campaign_id
JOIN sim_case AS c ON c.case_key = p.case_key
JOIN observable AS b ON b.scene = c.scene AND b.revision = c.revision AND b.shape <> 'scalar'
JOIN observation AS o ON o.case_key = c.case_key AND o.observable_id = b.observable_id;
CREATE VIEW inputs AS
SELECT c.case_id AS case_id, q.name AS name, coalesce(i.value, q.default_value) AS value, q.unit AS unit,
       i.value IS NULL AS is_default
FROM sim_case AS c
JOIN parameter AS q ON q.scene = c.scene AND q.revision = c.revision
LEFT JOIN case_input AS i ON i.case_key = c.case_key AND i.parameter_id = q.parameter_id;
CREATE VIEW convergence_history AS
SELECT g.name AS campaign, h.observable AS observable, h.points AS points, h.mean AS mean, h.sd AS sd,
       h.skewness AS skewness, h.g1 AS g1, h.kurtosis AS kurtosis, h.mean_error AS mean_error, h.sd_error AS sd_error,
       h.skewness_error AS skewness_error, h.g1_error AS g1_error, h.kurtosis_error AS kurtosis_error,
       h.zero_share AS zero_share, h.excluded AS excluded, h.converged AS converged
FROM convergence AS h
JOIN campaign AS g ON g.campaign_id = h.campaign_id;
CREATE VIEW "old" AS
SELECT p.point AS "point",
       p.sequence AS "sequence",
       p.replicate AS "replicate",
       c.case_id AS "case_id",
       c.seed AS "seed",
       c.outcome AS "outcome",
       c.attempts AS "attempts",
       c.wall_seconds AS "wall_seconds",
       coalesce((SELECT i.value FROM case_input AS i WHERE i.case_key = p.case_key AND i.parameter_id = 1), 0.5) AS "x1",
       coalesce((SELECT i.value FROM case_input AS i WHERE i.case_key = p.case_key AND i.parameter_id = 20), 'normal') AS "behaviour",
       (SELECT o.value FROM observation AS o WHERE o.case_key = p.case_key AND o.observable_id = 1 AND o.sample = 0) AS "y"
FROM campaign_case AS p
JOIN sim_case AS c ON c.case_key = p.case_key
WHERE p.campaign_id = 1;
COMMIT;
PRAGMA user_version = 8;
PRAGMA application_id = 1735620464;
