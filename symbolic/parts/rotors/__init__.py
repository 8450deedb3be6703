"""Rotors: what turns with a shaft, what the shaft touches, and the oil films that carry and damp it.

The shaft turns from x to y, at the speed Omega.
"""
