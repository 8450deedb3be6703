"""How the search for an orbit ends."""

from __future__ import annotations

from enum import Enum

import numpy as np


class Outcome(Enum):
    """How a Newton iteration ended; the value says it in words."""

    CONVERGED = "converged"
    TOO_MANY = "Newton did not converge within its iterations"
    NOT_FINITE = "the equations were not finite near the iterate"
    SINGULAR = "the linear system was singular"
    NOT_INTEGRATED = "time integration failed near the iterate"
    EVENTS_CROSSED = "two event nodes of the mesh met"
    GRAZING = "an impact or a relay is reached with no speed left, the orbit grazes"
    THROUGH_STOP = "the orbit passes where an impact would be, start from a simulated one that has it"
    SLIDES = "the motion would slide along a jump of the equations, which is not followed here"
    COLLAPSED = "the orbit shrank to an equilibrium"
    MOVED = "the orbit became another one on a new mesh"
    HELD = "a jump of the equations holds all along, at a place that is not determined"
    UNDETERMINED = "the phases of some events are not determined, the orbit is the same wherever they are"


class EventsCrossedError(ArithmeticError):
    """Two event nodes of a mesh have met or passed each other."""


FAILURES = (ArithmeticError, np.linalg.LinAlgError)
"""Exceptions that linearising an orbit's equations, or solving them, raises where it fails."""


def outcome_of(failure: Exception) -> Outcome:
    """Return the outcome that one of the FAILURES stands for."""
    if isinstance(failure, np.linalg.LinAlgError):
        return Outcome.SINGULAR
    if isinstance(failure, EventsCrossedError):
        return Outcome.EVENTS_CROSSED
    if isinstance(failure, FloatingPointError):
        return Outcome.NOT_FINITE
    return Outcome.NOT_INTEGRATED
