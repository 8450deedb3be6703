"""Studies that regenerate their pages: run from a checkout."""
