-- The places of a case in its campaigns are found by the case: a join of a campaign's view with `series` by case_id
-- visits each case once instead of every place for every case.
CREATE INDEX campaign_case_by_case ON campaign_case (case_key);

-- The process that wrote, on its host: a second run names the first. NULL: written before this was kept.
ALTER TABLE provenance ADD COLUMN process INTEGER;
