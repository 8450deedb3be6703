"""Many motions of one system followed at once, in compiled code."""
