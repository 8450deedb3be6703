"""Quasi-periodic motions: tori, as invariant curves of the map over a period, and their families."""

from periodic.tori.averages import average, in_time, surface
from periodic.tori.spectrum import Lines, spectrum
from periodic.tori.stability import torus_multipliers
from periodic.tori.torusbranch import TorusBranch, TorusPoint

__all__ = [
    "Lines",
    "TorusBranch",
    "TorusPoint",
    "average",
    "in_time",
    "spectrum",
    "surface",
    "torus_multipliers",
]
