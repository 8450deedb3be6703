"""How functionals of an orbit change with every parameter, exactly, for the cost of one linear solve.

The orbit's equations K(u, p) = 0, u its states and what else is determined (an angular frequency, the place
of a fold), give

    df/dp = f_p - f_u K_u^-1 K_p.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from periodic import bordered, collocation
from periodic.adjoint import polynomial
from periodic.closure import Condition, Event, Row, closures
from periodic.conditions import smooth
from periodic.functionals import Functional
from periodic.orbit import Orbit
from periodic.scheme import Array
from periodic.system import System, index_of


def sensitivities(
    system: System,
    orbit: Orbit,
    functionals: Mapping[str, Functional],
    *,
    determined: Mapping[str, Condition] | None = None,
) -> dict[str, dict[str, float]]:
    """Return the derivatives of functionals in every parameter that is not determined, by both names.

    SI units; the orbit must be one of Collocation or Shooting. `determined` as in `trace`: with
    {"speed": FoldCondition()} the functional Value("speed") gives the derivatives of a fold's speed. Those of
    a fold whose place is not determined are without bound. Raises ValueError for a functional without
    derivative and an orbit that is a Fourier series.
    """
    polynomial(orbit)
    names = [p.name for p in system.parameters]
    own = tuple(index_of(system, name) for name in determined or {})
    others = tuple(k for k in range(len(names)) if k not in own)
    free = (*own, *others)
    condensed = collocation.condense(system, orbit, free)
    maps = bordered.chain(condensed)
    n, inner = orbit.nodes.shape[1], orbit.nodes.shape[1] + len(orbit.phases) + len(own)
    rows = [Event(i).linearise(system, orbit, free) for i in range(len(orbit.phases))]
    closing = closures(list((determined or {}).values()), own, orbit)
    rows += [closure.linearise(system, orbit, free) for closure in closing]
    top = maps[-1][:, 1:].copy()
    top[:, :n] -= np.eye(n)

    def flat(row: Row) -> Array:
        return bordered.reduced(condensed.reduced(row), maps)[1:]

    matrix = np.concatenate([top, *(flat(row)[None] for row in rows)])
    moved = -np.linalg.solve(matrix[:, :inner], matrix[:, inner:])
    found = {}
    for label, functional in functionals.items():
        slope = flat(smooth(functional).linearise(system, orbit, free))
        total = slope[inner:] + slope[:inner] @ moved
        found[label] = {names[k]: float(value) for k, value in zip(others, total, strict=True)}
    return found
