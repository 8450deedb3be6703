"""Quasi-periodic motions: tori, as invariant curves of the map over a period, and their families."""

from periodic.tori.averages import average, in_time, surface
from periodic.tori.stability import torus_multipliers
from periodic.tori.torusbranch import TorusBranch, TorusPoint

__all__ = ["TorusBranch", "TorusPoint", "average", "in_time", "surface", "torus_multipliers"]
