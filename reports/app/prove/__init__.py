"""The command `orbitrace prove`."""
