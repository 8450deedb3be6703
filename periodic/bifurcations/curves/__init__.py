"""Special points of curves in two parameters."""
