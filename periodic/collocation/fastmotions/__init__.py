"""Motions too fast for the mesh: followed in substeps, or reported as unresolved."""
