"""Equations that jump, on given sides of their jumps, and motions that slide along these."""
