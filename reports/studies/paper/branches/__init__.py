"""What branches and curves in two parameters tell: resonance, damping, films, doublings."""
