"""The result of an optimisation: the design, what decides it, what it would gain from other parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from scipy.optimize import lsq_linear

from periodic.decisions.responses.box import AT_END, Box
from periodic.decisions.responses.feature import Count, Feature, LostError
from periodic.decisions.responses.readquantities import Reading
from periodic.orbit.scheme import Array
from periodic.results.branch import Branch

ACTIVE = 1e-6
"""How near to its bound, relative to its size, a feature decides the optimum."""

STATIONARY = 1e-4
"""What may be left of the gradients at an optimum, in parts of the objective over the whole ranges."""

TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class Share:
    """A feature's part of an optimisation: side f <= t of an aim, side f <= limit of a constraint."""

    feature: Feature
    side: float
    limit: float
    aim: bool

    @property
    def signed(self) -> float:
        """side f."""
        return self.side * self.feature.value

    @property
    def size(self) -> float:
        """The unit in which a constraint is measured."""
        return abs(self.limit) or max(abs(self.feature.value), TINY)

    def slack(self, t: float) -> float:
        """How far it is from its bound."""
        return (t if self.aim else self.limit) - self.signed


class SearchLike(Protocol):
    """What is used of the search."""

    @property
    def box(self) -> Box: ...
    @property
    def sense(self) -> float: ...
    @property
    def count(self) -> Count: ...
    @property
    def traces(self) -> int: ...
    def shares(self, reading: Reading) -> list[Share]: ...


@dataclass(frozen=True, repr=False)
class Optimum:
    """The best design found, or the best so far with the reason why it is not known to be one.

    Parameters
    ----------
    reason : str
        Why it is not known to be an optimum; empty where it is.
    values : mapping of str to float
        The free parameters (SI).
    objective : float
        The quantity that was minimised or maximised (SI).
    decisive : mapping of str to float
        Weights of the features that decide it (peaks of one height, constraints that are met just so), by
        their names: how fast the objective would fall if each were allowed a unit more.
    at_bounds : tuple of str
        Parameters that lie at an end of their range.
    derivatives : mapping of str to float
        How the optimal value changes with each parameter that is not free (SI), the free ones chosen anew.
    constraints : tuple of float
        The values of the constrained quantities (SI), in their order.
    branches : tuple of Branch
        The responses there.
    orbits, traces : int
        How many orbits were solved for, those of branches included, and how often branches were traced.
    """

    reason: str
    values: Mapping[str, float]
    objective: float
    decisive: Mapping[str, float] = field(default_factory=dict)
    at_bounds: tuple[str, ...] = ()
    derivatives: Mapping[str, float] = field(default_factory=dict)
    constraints: tuple[float, ...] = ()
    branches: tuple[Branch, ...] = ()
    orbits: int = 0
    traces: int = 0

    @property
    def ok(self) -> bool:
        """Whether it is an optimum: nothing near is better, to first order."""
        return not self.reason

    def __str__(self) -> str:
        values = ", ".join(f"{name} = {value:.9g}" for name, value in self.values.items())
        ends = f"; at the end of its range: {', '.join(self.at_bounds)}" if self.at_bounds else ""
        why = f"; not known to be an optimum: {self.reason}" if self.reason else ""
        decided = "".join(f"\n  decided by {name} (weight {w:.3g})" for name, w in self.decisive.items())
        return f"{self.objective:.9g} at {values}{ends}{why}{decided}"

    def __repr__(self) -> str:
        kind = "optimum" if self.ok else "no optimum"
        return f"Optimum({self.objective:.9g}, {kind}, {self.orbits} orbits)"


def optimum(search: SearchLike, reading: Reading, why: str) -> Optimum:
    """Return the result of a search that ended at a reading."""
    box, shares = search.box, search.shares(reading)
    top = max(share.signed for share in shares if share.aim)
    missed = [s for s in shares if not s.aim and s.slack(0.0) < -ACTIVE * s.size]
    active = [s for s in shares if abs(s.slack(top)) <= ACTIVE * max(s.size, abs(top) if s.aim else 0.0)]
    scaled = box.scaled(reading.values)
    try:
        weights, left = _weights(box, active, scaled)
    except LostError as error:
        active, weights, left, why = [], np.zeros(0), np.inf, why or f"it has no gradients there ({error})"
    if missed and not why:
        first = missed[0]
        why = (
            f"no design was found with {first.feature.name} within its bound: it misses by "
            f"{-first.slack(0.0):.3g}"
        )
    if not why and left > STATIONARY:
        why = f"gradients do not cancel there ({left:.1e} of them is left)"
    return Optimum(
        reason=why,
        values=reading.values,
        objective=search.sense * top,
        decisive={s.feature.name: float(w) for s, w in zip(active, weights, strict=True) if w > ACTIVE},
        at_bounds=box.at_ends(reading.values),
        derivatives=_derivatives(search.sense, box, active, weights),
        constraints=reading.numbers[1:],
        branches=tuple(reading.branches),
        orbits=search.count.orbits,
        traces=search.traces,
    )


def _weights(box: Box, active: Sequence[Share], scaled: Array) -> tuple[Array, float]:
    """Lagrange multipliers of what is active, those of aims with the sum 1, and what gradients leave.

    Sum of w_i g_i is 0 but for parameters at an end of their range, where it may push outwards.
    """
    sizes = np.array([max(abs(s.signed) if s.aim else s.size, TINY) for s in active])
    slopes = [[s.side * s.feature.gradient[name] for name in box.names] for s in active]
    gradients = np.array(slopes) * box.widths / sizes[:, None]
    ends = [(k, 1.0) for k in np.flatnonzero(scaled >= 1 - AT_END)] + [
        (k, -1.0) for k in np.flatnonzero(scaled <= AT_END)
    ]
    outward = np.zeros((len(box.names), len(ends)))
    for column, (k, sign) in enumerate(ends):
        outward[k, column] = sign
    aims = np.array([float(s.aim) for s in active])
    top = np.concatenate([gradients.T, outward], axis=1)
    matrix = np.concatenate([top, np.append(aims, np.zeros(len(ends)))[None]])
    right = np.append(np.zeros(len(box.names)), 1.0)
    found = lsq_linear(matrix, right, bounds=(0.0, np.inf), method="bvls")
    unit = max(sizes[aims > 0])
    return found.x[: len(active)] * unit / sizes, float(np.linalg.norm(matrix @ found.x - right))


def _derivatives(sense: float, box: Box, active: Sequence[Share], weights: Array) -> dict[str, float]:
    found: dict[str, float] = {}
    for share, weight in zip(active, weights, strict=True):
        for name, slope in share.feature.gradient.items():
            if name not in box.names:
                found[name] = found.get(name, 0.0) + float(sense * weight * share.side * slope)
    return found
