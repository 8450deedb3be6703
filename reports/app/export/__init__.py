"""The command `orbitrace export`: a branch for another program."""
