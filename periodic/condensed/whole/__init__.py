"""Condensed orbits expanded to all states of the structure."""
