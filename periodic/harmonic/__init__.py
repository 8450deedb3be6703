"""Harmonic balance and Hill's method."""
