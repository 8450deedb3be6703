"""Condensed orbits seen with all states of the structure."""
