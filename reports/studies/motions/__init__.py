"""The report on motions: all of them at given parameters, basins, chaos and tori, beside what is known."""
