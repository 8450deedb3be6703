"""Steps along a branch: how one is taken, how long it is, and what passes within it."""
