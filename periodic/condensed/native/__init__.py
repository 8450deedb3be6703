"""What C does for the modes of split systems, where it can be compiled; NumPy does the same elsewhere."""
