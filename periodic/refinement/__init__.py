"""Mesh refinement: how many intervals an orbit needs, where they lie, and the orbit solved on them anew."""
