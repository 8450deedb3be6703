"""Points of branches of piecewise linear models, judged in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import null_space

import periodic as per
from reference.closer import closer
from reference.contact import Contact, Friction, Period, period, periodic
from reference.joints.period import Period as JointsPeriod
from reference.shooting import in_order

Array = NDArray[np.float64]

FOLD = 1e-4
"""Least singular value of M - 1 below which an orbit at a fixed parameter is not found anew: near a fold."""

BESIDE = 1e-2
"""Least singular value of M - 1 below which multipliers are those of the orbit as it is: beside a fold on a
grazing orbit the last digit of the parameter changes them by 1e-3."""

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
    true = at_places(exact, found)
    theirs, own = np.poly(true), np.poly(point.multipliers)
    apart = float(np.abs(theirs - own).max() / np.abs(theirs).max())
    moduli = np.abs(true)
    near = np.abs(np.concatenate([moduli, np.abs(point.multipliers)]) - 1).min() < CIRCLE + apart
    near = near or point.label in (per.Label.FOLD, per.Label.DOUBLING, per.Label.TORUS)
    stable = bool(near or point.stable == (moduli < 1).all())
    return Verdict(off / size, apart, stable, found.growth, found)


def at_places(exact: Contact, found: Period) -> NDArray[np.complex128]:
    """Multipliers of a period at the places where joints of friction are held all along.

    Such an orbit is one of a continuum: perturbations that move a place q neither grow nor decay, and those
    of the speed q' = 0 are gone at once. A joint's multipliers 1 and 0 are 0 and 0 at a given place; the
    others are those of perturbations with q = q' = 0, which the motion keeps.
    """
    joints = (e for i, e in enumerate(exact.elements) if held_all_along(exact, found, i))
    held = [joint.row[: len(found.start)] for joint in joints]
    if not held:
        return found.multipliers
    half = len(found.start) // 2
    places = [np.roll(row, -half) for row in held]
    kept = null_space(np.array([*held, *places]))
    others = np.linalg.eigvals(kept.T @ found.monodromy @ kept)
    return in_order(np.append(others, np.zeros(2 * len(held))))


def held_all_along(exact: Contact, found: Period, i: int) -> bool:
    """Whether an element is friction that never lets go: it begins in the mode of its rounding, and sticks.

    Friction that slips has an even number of events in a period, as each excursion of its mode ends.
    """
    own = [k for k, _ in found.events if k == i]
    return isinstance(exact.elements[i], Friction) and len(own) == 1


def quiet(exact: Contact, orbit: per.Orbit, omega: float, names: list[str]) -> tuple[float, Array]:
    """The phase of a mesh at which the contacts' rows are farthest from 0, each in its size; y there, SI."""
    taus = orbit.grid.left
    states = np.array([orbit[name](taus / omega) for name in (*names, *(f"{q}'" for q in names))]).T
    z = np.column_stack([states, np.ones(len(taus)), np.cos(taus), np.sin(taus)])
    rows = np.abs(z @ np.array([e.row for e in exact.elements]).T)
    best = int((rows / rows.max(axis=0)).min(axis=1).argmax())
    return float(taus[best]), states[best]
