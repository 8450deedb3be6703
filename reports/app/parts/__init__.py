"""The commands `orbitrace parts` and `orbitrace new`: what scenes can be composed of, and a start."""
