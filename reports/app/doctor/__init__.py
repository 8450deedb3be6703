"""The command `orbitrace doctor`: what this machine has, and whether its numbers are right."""
