"""Orthogonal collocation on meshes tied to the kinks of the motion."""
