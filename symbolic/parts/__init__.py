"""The parts a model is built from, a folder for each family."""
