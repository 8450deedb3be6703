"""Contacts between bodies: the pair, its law of load, and what excites and damps it."""
