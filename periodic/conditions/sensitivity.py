"""How functionals of an orbit change with every parameter, exactly, for the cost of one linear solve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from periodic.checks import named
from periodic.conditions.adjoint import polynomial
from periodic.conditions.functionals import Functional
from periodic.conditions.levels import smooth
from periodic.conditions.variations import equations
from periodic.correction.condition import Condition, side_conditions
from periodic.linear.unknowns import Increment
from periodic.orbit.construction import as_read_by
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.orbit.row import Row
from periodic.system import System, index_of
from periodic.system.precision import SMALLEST

FARTHEST_MOVE = 1e-3
"""How far Newton's step may lead from an orbit, in parts of its peak to peak and of what is determined."""


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
        For a functional without derivative, an orbit that is a Fourier series, and one that does not fulfil
        its equations or what is determined.
    """
    named("functionals", functionals, "functionals")
    named("determined", determined or {}, "conditions")
    orbit = as_read_by(system, orbit)
    polynomial(orbit)
    names = [p.name for p in system.parameters]
    own = tuple(index_of(system, name) for name in determined or {})
    others = tuple(k for k in range(len(names)) if k not in own)
    free, first = (*own, *others), len(orbit.phases) + len(own)
    closing = side_conditions(list((determined or {}).values()), own, orbit)
    rows = [condition.linearise(system, orbit, free) for condition in closing]
    rows += [_held(orbit, first + i, len(free)) for i in range(len(others))]
    right = np.zeros((1 + len(rows), 1 + len(others)))
    right[0, 0] = 1.0
    right[1 + len(own) :, 1:] = np.eye(len(others))
    step, *ways = equations(system, orbit, free).solve(rows, right)
    _check_met(orbit, step, [names[k] for k in own])
    found = {}
    for label, functional in functionals.items():
        slope = smooth(functional).linearise(system, orbit, free)
        found[label] = {names[k]: way.rate_of(slope) for k, way in zip(others, ways, strict=True)}
    return found


def _check_met(orbit: Orbit, step: Increment, determined: Sequence[str]) -> None:
    """Refuse an orbit that Newton's step still moves: it fulfils its equations or conditions elsewhere."""
    for name, change in zip(determined, step.parameters, strict=False):
        value = orbit.parameters[name]
        if not abs(change) <= FARTHEST_MOVE * max(abs(value), SMALLEST):
            raise ValueError(
                f"{name} of the orbit is {value:.6g}, where its condition is not met; the orbit must be one "
                f"that trace found with it (a labelled point, or determined={{{name!r}: ...}})"
            )
    apart = float(np.abs(step.profile).max()) / max(orbit.span(), LEAST_SPAN)
    if not apart <= FARTHEST_MOVE:
        raise ValueError(
            f"orbit is {apart:.1e} peaks to peak from the one at its parameters; it must be one that trace "
            f"found there"
        )


def _held(orbit: Orbit, index: int, free: int) -> Row:
    """The row of one of the free numbers."""
    outer = np.zeros(len(orbit.phases) + free)
    outer[index] = 1.0
    return Row(0.0, np.zeros_like(orbit.nodes), outer)
