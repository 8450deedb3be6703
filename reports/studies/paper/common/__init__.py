"""What all sections share: the paper's discs, their scenes, traced branches, how figures look."""
