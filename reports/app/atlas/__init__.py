"""The command `orbitrace atlas`: everything that a scene can do over its range."""
