"""Many branches: numbers of whole branches over a grid of parameters, on any executor."""
