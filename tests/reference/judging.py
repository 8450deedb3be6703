"""Points of branches of piecewise linear models, judged in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import periodic as per
from reference.closer import closer
from reference.contact import Contact, Period, period, periodic
from reference.joints.period import Period as JointsPeriod

Array = NDArray[np.float64]

FOLD = 1e-4
"""Least singular value of M - 1 below which an orbit at a fixed parameter is not found anew: near a fold."""

BESIDE = 1e-2
"""Least singular value of M - 1 below which multipliers are those of the orbit as it is: beside a fold on a
touch the last digit of the parameter changes them by 1e-3."""

CIRCLE = 1e-4
"""Multipliers nearer to the unit circle decide nothing."""

TIMES = 10.0
"""An error is that many times what is claimed before it is wrong: an estimate tells its order."""


@dataclass(frozen=True)
class Verdict:
    """Errors of a point: of its state, of its multipliers' polynomial; and whether its stability is true."""

    orbit: float
    multipliers: float
    stability: bool
    growth: float
    found: Period | JointsPeriod

    def wrong(self, point: per.Point, tol: float) -> str:
        """Say what a point claims that is not so, or nothing."""
        if not self.orbit <= TIMES * max(tol, point.error.orbit):
            return f"orbit {self.orbit:.1e}, claimed {point.error.orbit:.1e}"
        if not self.multipliers <= TIMES * max(tol, point.error.multiplier):
            return f"multipliers {self.multipliers:.1e}, claimed {point.error.multiplier:.1e}"
        return "" if self.stability else f"stable is {point.stable}, {self.found.multipliers[:2]}"


def judged(exact: Contact, point: per.Point, names: list[str]) -> Verdict:
    """Follow a point's orbit over a period from where its contacts are farthest from a change."""
    orbit, omega = point.orbit, point.parameter
    tau, begin = quiet(exact, orbit, omega, names)
    found = period(exact, omega, begin, tau)
    size = max(float(np.ptp(orbit.nodes, axis=0).max()), 1e-3)
    gap = found.end - found.start
    singular = np.linalg.svd(found.monodromy - np.eye(len(begin)), compute_uv=False)
    if singular[-1] > FOLD:
        again = closer(exact, omega, periodic(exact, omega, begin, tau), tau)
        off = float(np.abs(again.start - begin).max())
        found = again if singular[-1] > BESIDE else found
    else:
        off = float(np.abs(gap).max()) / found.growth
    theirs, own = np.poly(found.monodromy), np.poly(point.multipliers)
    apart = float(np.abs(theirs - own).max() / np.abs(theirs).max())
    moduli = np.abs(found.multipliers)
    near = np.abs(np.concatenate([moduli, np.abs(point.multipliers)]) - 1).min() < CIRCLE + apart
    near = near or point.label in (per.Label.FOLD, per.Label.DOUBLING, per.Label.TORUS)
    stable = bool(near or point.stable == (moduli < 1).all())
    return Verdict(off / size, apart, stable, found.growth, found)


def quiet(exact: Contact, orbit: per.Orbit, omega: float, names: list[str]) -> tuple[float, Array]:
    """The phase of a mesh at which the contacts' rows are farthest from 0, each in its size; y there, SI."""
    taus = orbit.grid.left
    states = np.array([orbit[name](taus / omega) for name in (*names, *(f"{q}'" for q in names))]).T
    z = np.column_stack([states, np.ones(len(taus)), np.cos(taus), np.sin(taus)])
    rows = np.abs(z @ np.array([e.row for e in exact.elements]).T)
    best = int((rows / rows.max(axis=0)).min(axis=1).argmax())
    return float(taus[best]), states[best]
