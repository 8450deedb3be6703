"""Parameters from measured responses."""
