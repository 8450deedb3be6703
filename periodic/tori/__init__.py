"""Quasi-periodic motions: tori, as invariant curves of the map over a period, and their families."""

from periodic.tori.averages import average, in_time, surface
from periodic.tori.combinations import Combinations, combinations
from periodic.tori.stability import torus_multipliers
from periodic.tori.torusbranch import TorusBranch
from periodic.tori.toruspoint import TorusPoint

__all__ = [
    "Combinations",
    "TorusBranch",
    "TorusPoint",
    "average",
    "in_time",
    "combinations",
    "surface",
    "torus_multipliers",
]
