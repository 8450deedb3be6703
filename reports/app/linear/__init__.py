"""The command `orbitrace linear`."""
