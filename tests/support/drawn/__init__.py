"""Models drawn at random: a seed is a case."""
