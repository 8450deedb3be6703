"""How a branch is followed from within the search for an orbit of another."""

from __future__ import annotations

from collections.abc import Callable

from periodic.correction.solver import Solver
from periodic.orbit.orbit import Orbit
from periodic.results.stop import Stop

Follow = Callable[[Solver, Orbit, int, int | None], tuple[Orbit | None, Stop]]
"""Follows a branch from an orbit one way, in at most so many steps: its last orbit, and why it ends."""
