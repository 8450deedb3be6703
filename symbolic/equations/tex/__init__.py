"""Equations of motion in LaTeX, written from the expressions themselves."""
