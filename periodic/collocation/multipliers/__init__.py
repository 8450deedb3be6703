"""What coarse intervals do to the multipliers, and how these are right all the same."""
