-- Views over the archive, made anew whenever the schema's version grows: to change one, add a migration.
-- Beside them every campaign has a view of its own name, one row per case of its design:
--   point, sequence, replicate, case_id, seed, outcome, attempts, wall_seconds, <factors>, <scalar observables>

-- Every series and profile, one row per sample, ordered as measured.
DROP VIEW IF EXISTS series;
CREATE VIEW series AS
SELECT g.name AS campaign, p.point AS point, p.replicate AS replicate, c.case_id AS case_id, b.name AS observable,
       o.time AS time, o.bin AS bin, o.value AS value
FROM campaign AS g
JOIN campaign_case AS p ON p.campaign_id = g.campaign_id
JOIN sim_case AS c ON c.case_key = p.case_key
JOIN observable AS b ON b.scene = c.scene AND b.revision = c.revision AND b.shape <> 'scalar'
JOIN observation AS o ON o.case_key = c.case_key AND o.observable_id = b.observable_id;

-- The complete inputs of every case, defaults included.
DROP VIEW IF EXISTS inputs;
CREATE VIEW inputs AS
SELECT c.case_id AS case_id, q.name AS name, coalesce(i.value, q.default_value) AS value, q.unit AS unit,
       i.value IS NULL AS is_default
FROM sim_case AS c
JOIN parameter AS q ON q.scene = c.scene AND q.revision = c.revision
LEFT JOIN case_input AS i ON i.case_key = c.case_key AND i.parameter_id = q.parameter_id;

-- How the moments and their errors went, check by check.
DROP VIEW IF EXISTS convergence_history;
CREATE VIEW convergence_history AS
SELECT g.name AS campaign, h.observable AS observable, h.points AS points, h.mean AS mean, h.sd AS sd,
       h.skewness AS skewness, h.g1 AS g1, h.kurtosis AS kurtosis, h.mean_error AS mean_error, h.sd_error AS sd_error,
       h.skewness_error AS skewness_error, h.g1_error AS g1_error, h.kurtosis_error AS kurtosis_error,
       h.zero_share AS zero_share, h.excluded AS excluded, h.converged AS converged
FROM convergence AS h
JOIN campaign AS g ON g.campaign_id = h.campaign_id;
