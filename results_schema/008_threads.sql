-- How many threads computed an attempt: a mean over the time it was advanced. NULL: by one or more that nothing was noted of
-- (stored before this was kept, a program's, an attempt without an answer), or nothing had to be computed.
ALTER TABLE attempt ADD COLUMN threads REAL;
