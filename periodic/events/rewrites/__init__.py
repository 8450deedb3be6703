"""How words of orbits change along a branch: the rows of one table, each read both ways."""
