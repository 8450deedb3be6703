"""Linear structures as matrices: their checks, files and programs they come from, builders, reduction."""
