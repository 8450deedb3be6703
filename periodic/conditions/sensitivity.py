"""How functionals of an orbit change with every parameter, exactly, for the cost of one linear solve."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from periodic.conditions.adjoint import polynomial
from periodic.conditions.functionals import Functional
from periodic.conditions.levels import smooth
from periodic.conditions.variations import equations
from periodic.correction.condition import Condition, side_conditions
from periodic.linear.unknowns import Increment
from periodic.orbit.construction import as_read_by
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.system import System, index_of


def sensitivities(
    system: System,
    orbit: Orbit,
    functionals: Mapping[str, Functional],
    *,
    determined: Mapping[str, Condition] | None = None,
) -> dict[str, dict[str, float]]:
    """Return the derivatives of functionals in every parameter that is not determined.

    The orbit's equations K(u, p) = 0, u its states and what else is determined (an angular frequency, the
    place of a fold), give

        df/dp = f_p - f_u K_u^-1 K_p.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        An orbit of Collocation or Shooting.
    functionals : mapping of str to Functional
        Functionals with a derivative, by name.
    determined : mapping of str to Condition, optional
        As in `trace`: with {"speed": FoldCondition()} the functional Value("speed") gives the derivatives of
        a fold's speed. Those of a fold whose place is not determined are without bound.

    Returns
    -------
    dict of str to dict of str to float
        df/dp in SI units, by the names of functional and parameter.

    Raises
    ------
    ValueError
        For a functional without derivative, and an orbit that is a Fourier series.
    """
    orbit = as_read_by(system, orbit)
    polynomial(orbit)
    names = [p.name for p in system.parameters]
    own = tuple(index_of(system, name) for name in determined or {})
    others = tuple(k for k in range(len(names)) if k not in own)
    free, first = (*own, *others), len(orbit.phases) + len(own)
    closing = side_conditions(list((determined or {}).values()), own, orbit)
    rows = [condition.linearise(system, orbit, free) for condition in closing]
    rows += [_held(orbit, first + i, len(free)) for i in range(len(others))]
    right = np.zeros((1 + len(rows), len(others)))
    right[1 + len(own) :] = np.eye(len(others))
    ways = equations(system, orbit, free).solve(rows, right)
    found = {}
    for label, functional in functionals.items():
        slope = smooth(functional).linearise(system, orbit, free)
        found[label] = {names[k]: _along(slope, way) for k, way in zip(others, ways, strict=True)}
    return found


def _held(orbit: Orbit, index: int, free: int) -> Row:
    """The row of one of the free numbers."""
    outer = np.zeros(len(orbit.phases) + free)
    outer[index] = 1.0
    return Row(0.0, np.zeros_like(orbit.nodes), outer)


def _along(slope: Row, way: Increment) -> float:
    """How a functional changes along an increment."""
    found = np.vdot(slope.nodes, way.nodes) + slope.outer @ np.append(way.phases, way.parameters)
    return float(found if slope.stages is None else found + np.vdot(slope.stages, way.stages))
