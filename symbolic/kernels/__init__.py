"""Expressions become batch functions: NumPy source or compiled C, and contracted second derivatives."""
