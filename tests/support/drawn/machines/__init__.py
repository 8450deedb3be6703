"""Machines drawn at random from what catalogues and books hold, in real units; a seed is a machine."""
