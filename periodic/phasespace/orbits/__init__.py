"""Orbits that a search knows: when a motion comes back, and how it is completed."""
