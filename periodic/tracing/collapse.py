"""Autonomous orbits that turn out to be an equilibrium: orbits of all sizes exist, or none."""

from __future__ import annotations

from periodic.correction.solution import Solution
from periodic.orbit.orbit import Orbit

COLLAPSED = 0.1
"""Part of its guess's span below which an orbit is not the one guessed."""


def collapsed(guess: Orbit, found: Solution) -> bool:
    """Whether an autonomous orbit shrank to an equilibrium: there are orbits of all sizes, or none."""
    return found.problem.autonomous and found.orbit.span() < COLLAPSED * guess.span()
