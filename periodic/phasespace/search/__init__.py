"""The search for all motions: starts that settle, unstable orbits, manifolds, branches, images, chaos."""
