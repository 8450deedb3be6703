"""The command `orbitrace motions`: every motion of a scene at one value."""
