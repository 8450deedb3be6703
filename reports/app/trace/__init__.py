"""The command `orbitrace trace`."""
