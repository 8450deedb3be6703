"""Beams and rotors of any size with a few nonlinear places: cost, accuracy, what their motion looks like."""
