"""What tolerances of parameters do to responses."""
