"""The command `orbitrace map`."""
