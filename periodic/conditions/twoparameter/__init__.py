"""Conditions that hold an orbit at a special point while two parameters vary: the curves of such points."""
