"""How functionals of an orbit change with every parameter, exactly, for the cost of one linear solve."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from periodic.collocation.condensation import condensed
from periodic.collocation.event import event_rows
from periodic.conditions.adjoint import polynomial
from periodic.conditions.functionals import Functional
from periodic.conditions.levels import smooth
from periodic.correction.condition import Condition, side_conditions
from periodic.linear.bordering import chain, onto_start
from periodic.orbit.construction import as_read_by
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
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
    free = (*own, *others)
    local = condensed(system, orbit, free)
    maps = chain(local)
    n, inner = orbit.nodes.shape[1], orbit.nodes.shape[1] + len(orbit.phases) + len(own)
    closing = side_conditions(list((determined or {}).values()), own, orbit)
    rows = event_rows(system, orbit, free)
    rows += [condition.linearise(system, orbit, free) for condition in closing]
    top = maps[-1][:, 1:].copy()
    top[:, :n] -= np.eye(n)

    def flat(row: Row) -> Array:
        return onto_start(local.reduced(row), maps)[1:]

    matrix = np.concatenate([top, *(flat(row)[None] for row in rows)])
    moved = -np.linalg.solve(matrix[:, :inner], matrix[:, inner:])
    found = {}
    for label, functional in functionals.items():
        slope = flat(smooth(functional).linearise(system, orbit, free))
        total = slope[inner:] + slope[:inner] @ moved
        found[label] = {names[k]: float(value) for k, value in zip(others, total, strict=True)}
    return found
