"""Pseudo-arclength continuation: step control, start, the loop, and the ways in."""
