"""Numbers of a whole branch; a new one is one file, or a function of one's own."""
