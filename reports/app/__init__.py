"""The command line: scenes traced, linearised and drawn."""
