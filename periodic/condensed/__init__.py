"""Orbits of large linear structures with a few nonlinear places: unknowns at the places alone."""
