"""Changes of the pattern of events: rows of one table, read both ways."""
