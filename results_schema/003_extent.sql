-- How much of its design a campaign has been asked for. The counts of the campaign never shrink: a run that asks for
-- less computes a part, and what is stored stays in the view. NULL: stored before this was kept.
ALTER TABLE campaign ADD COLUMN candidates INTEGER;        -- points the design numbers, those the condition leaves out included
ALTER TABLE campaign ADD COLUMN asked_candidates INTEGER;  -- the same, as the last run asked
ALTER TABLE campaign ADD COLUMN asked_replicates INTEGER;  -- replicates, as the last run asked
