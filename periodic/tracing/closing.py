"""Newton's method on the return map of a motion in time, with derivatives from the equations along it.

A motion that nearly comes back is a guess of an orbit, with its own word. One step of Newton's method on the
equations of that orbit leads to the beginning of another motion, whose word is read anew. So events may
appear, go, and change places on the way, and no derivative costs a motion.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from periodic.correction.discretisation import Discretisation
from periodic.correction.newton import Equations, moved
from periodic.correction.outcome import FAILURES
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System

STEPS = 15
"""How many steps at the most."""

MOST_HALVINGS = 5
"""How often a step is halved that does not lead nearer."""

NEARER = 0.1
"""Least part by which a step shortens the distance, of that by which it would if all were linear."""


@dataclass(frozen=True)
class Closing:
    """The ends of motions of a system, to be brought to their beginnings.

    Parameters
    ----------
    method : Discretisation
        Sets up the equations of orbits.
    system : System
        The equations.
    motion : callable
        A state at the beginning of a period to that period as a guess of an orbit, if it has a word.
    apart : callable
        The same to the distance of the end from the beginning. Both raise FAILURES.
    """

    method: Discretisation
    system: System
    motion: Callable[[Array], Orbit | None]
    apart: Callable[[Array], float]

    def nearest(self, state: Array, enough: float) -> tuple[Array, float]:
        """Return a state whose motion comes back nearer than that of the given one, and how near that is.

        enough: a distance beyond which no step is taken.
        """
        here = self._distance(state)
        for _ in range(STEPS):
            if here < enough or (way := self._way(state)) is None:
                break
            parts = (0.5**k for k in range(MOST_HALVINGS + 1))
            tried = ((part, state + part * way) for part in parts)
            each = ((part, there, self._distance(there)) for part, there in tried)
            nearer = next(((b, c) for part, b, c in each if c < (1 - NEARER * part) * here), None)
            if nearer is None:
                break
            state, here = nearer
        return state, here

    def _way(self, state: Array) -> Array | None:
        """Newton's step from a state, if there is one."""
        try:
            if (motion := self.motion(state)) is None:
                return None
            guess = self.method.guess(self.system, motion.parameter, motion)
            step = Equations(self.method.linearise, self.system).step(guess)
            closed = moved(self.system, (), step.orbit, step.increment)
        except FAILURES:
            return None
        return np.asarray(closed.state(np.zeros(1))[0] - state)

    def _distance(self, state: Array) -> float:
        """The distance of a motion's end from its beginning, infinite where it cannot be followed."""
        try:
            found = self.apart(state)
        except FAILURES:
            return np.inf
        return found if np.isfinite(found) else np.inf
