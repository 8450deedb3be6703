"""Motions followed from where they are, many at once: in C, one by one, by others, or as they were kept."""
