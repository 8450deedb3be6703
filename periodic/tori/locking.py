"""Where a motion on a torus locks: its rotation number comes to p/q, and it to orbits of q periods."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.orbits.completion import Completion
from periodic.phasespace.orbits.recurrence import same
from periodic.phasespace.search.fixedpoints import FixedPoints
from periodic.results.point import Point
from periodic.system.ensembles import FOLLOWED
from periodic.tori.family import Family
from periodic.tori.section import Section

LARGEST = 20
"""Largest denominator of a rotation number at which a torus is said to lock."""

LOCKS = 0.05
"""Distance of a rotation number from p/q, over 1/q^2, at which a family that ends locks."""

BEYOND = (1e-5, 1e-4, 1e-3, 1e-2)
"""How far beyond the last torus orbits are looked for, in ranges of the parameter."""

STARTS = 41
"""States of the last torus from which they are."""

ORBITS, ALIKE = 1e-6, 1e-4
"""Tolerance of these orbits, and distance in sizes of the torus at which two of them are one."""


def resonance(torus: Section) -> Fraction | None:
    """Return the ratio p/q of few periods that the rotation number is about to reach, if any."""
    near = Fraction(torus.rotation_number).limit_denominator(LARGEST)
    return near if abs(torus.rotation_number - near) < LOCKS / near.denominator**2 else None


def passed(before: Section, after: Section, near: Fraction) -> bool:
    """Return whether the rotation number of the second is beyond a ratio that the first is about to reach."""
    both = [(torus.rotation_number - near + 0.5) % 1.0 - 0.5 for torus in (before, after)]
    return float(both[0] * both[1]) < 0


def orbits_beyond(family: Family, torus: Section, periods: int, way: float) -> tuple[Point, ...]:
    """Return the orbits of some periods of the excitation on which a torus has locked, beyond its last value.

    way: the sign of the parameter's change.
    """
    equations, last = family.equations, family.value(torus)
    unit = np.maximum(np.ptp(torus.states, axis=0), np.finfo(float).tiny)
    middle, starts = torus.states.mean(axis=0), torus.states[:: max(1, len(torus.states) // STARTS)]
    for part in BEYOND:
        parameter = torus.parameter.copy()
        parameter[equations.free] = last + np.sign(way) * part * equations.scale
        crowd = Crowd(equations.system, parameter, equations.tolerance)
        roots = FixedPoints(crowd, periods, unit, middle).found(starts, np.zeros((0, starts.shape[1])))
        found = _completed(crowd, roots, periods, unit)
        if found:
            return found
    return ()


def _completed(crowd: Crowd, roots: Array, periods: int, unit: Array) -> tuple[Point, ...]:
    """The orbits of so many periods through states that the map leaves where they are, each once."""
    found: list[Point] = []
    known: list[Array] = []
    for root in roots:
        y = crowd.begin(root[None])
        path = crowd.run(y, periods, FORCED, keep=True)
        assert path.sections is not None
        states = path.sections[0, :-1, : len(root)]
        if path.outcome[0] != FOLLOWED or any(same(states, other, unit, ALIKE) for other in known):
            continue
        known.append(states)
        point = Completion(crowd, ORBITS).forced(y[0], list(crowd.run(y, 0, FORCED).modes[0]), periods)
        if point is not None and round(float(point.orbit.mesh.period) / FORCED) == periods:
            found.append(point)
    return tuple(found)


def kinds(orbits: tuple[Point, ...]) -> str:
    """Return whether orbits are stable, unstable or both, in words."""
    each = {True: "stable", False: "unstable"}
    return " and ".join(name for kind, name in each.items() if any(p.stable == kind for p in orbits))
