"""The command `orbitrace modes`: nonlinear modes of a scene, its frequency and damping over the amplitude."""
