"""Pictures of branches and orbits with matplotlib: each takes axes or makes its own, and returns them."""
