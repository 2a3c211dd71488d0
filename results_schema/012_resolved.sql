-- The campaign as it was read: a campaign file (JSON) with the values of every factor, fixed value and option of its design
-- in SI units. `factors` to `design_extent` say the same as text. Its checksum is `campaign.resolved` in table_checksum.
ALTER TABLE campaign ADD COLUMN resolved TEXT;  -- NULL: the texts cannot be written so
