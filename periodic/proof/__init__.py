"""Proofs that periodic orbits exist, by ball arithmetic, with certificates that a stranger can check."""
