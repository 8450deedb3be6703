"""What compiled systems have C do with orbits; NumPy does the same elsewhere."""
