"""Equilibria: orbits that are constant."""
