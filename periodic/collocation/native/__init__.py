"""What small systems have C do, where they can compile it; NumPy does the same elsewhere."""
