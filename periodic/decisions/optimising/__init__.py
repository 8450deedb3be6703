"""Designs whose worst is best."""
