"""Points of branches of systems with several joints, judged."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import periodic as per
from reference.joints.model import Array, Jointed
from reference.joints.period import TRIVIAL, Follower, Period, periodic
from reference.judging import BESIDE, CIRCLE, FOLD, Verdict

PHASES = 80
"""At which it is seen how far the joints are from a change, at the most."""

LEADING = 0.1
"""Multipliers of that modulus are compared where a point has not all of them."""


def judged(exact: Jointed, point: per.Point, states: Callable[[per.Orbit, Array], Array]) -> Verdict:
    """Follow a point's orbit over a period from where its joints are farthest from a change.

    Where joints hold all along the orbit nearest to it is sought: what they hold is not determined.
    `states` gives (q, q', s) in SI.
    """
    orbit, follower = point.orbit, Follower(exact, point.parameter)
    tau, begin = quiet(follower, orbit, states)
    found = follower.period(begin, tau)
    size = max(float(np.ptp(states(orbit, orbit.grid.left), axis=0).max()), 1e-3)
    singular = np.linalg.svd(found.monodromy - np.eye(len(begin)), compute_uv=False)
    open_ways = int((singular <= TRIVIAL * singular[0]).sum())
    least = singular[-1 - open_ways]
    if least > FOLD:
        again = periodic(follower, begin, tau)
        off = float(np.abs(again.start - begin).max())
        found = again if least > BESIDE else found
    else:
        off = float(np.abs(found.end - found.start).max()) / found.growth
    apart = _apart(found, point, open_ways)
    moduli = np.abs(found.multipliers)
    near = np.abs(np.concatenate([moduli, np.abs(point.multipliers)]) - 1).min() < CIRCLE + apart
    near = near or point.label in (per.Label.FOLD, per.Label.DOUBLING, per.Label.TORUS)
    stable = bool(near or point.stable == (moduli < 1).all())
    return Verdict(off / size, apart, stable, found.growth, found)


def _apart(found: Period, point: per.Point, open_ways: int) -> float:
    """How far the multipliers' polynomials are apart, or each leading one from the next of the other.

    open_ways: how many multipliers 1 say that joints hold all along, wherever; the engine leaves them out.
    """
    theirs, own = found.multipliers, np.asarray(point.multipliers)
    if point.orbit.mesh.modes:
        theirs = theirs[np.argsort(np.abs(theirs - 1))[open_ways:]]
    if len(theirs) == len(own):
        polynomials = np.poly(theirs), np.poly(own)
        return float(np.abs(polynomials[0] - polynomials[1]).max() / np.abs(polynomials[0]).max())
    pairs = [(theirs, own), (own, theirs)]
    each = [np.abs(a[np.abs(a) > LEADING][:, None] - b).min(axis=1).max(initial=0.0) for a, b in pairs]
    return float(max(each))


def quiet(
    follower: Follower, orbit: per.Orbit, states: Callable[[per.Orbit, Array], Array]
) -> tuple[float, Array]:
    """The phase between nodes at which the joints' guards are largest, and the state there."""
    left, ends = orbit.grid.left, np.append(orbit.grid.left[1:], orbit.grid.left[0] + orbit.mesh.period)
    taus = ((left + ends) / 2)[:: max(1, len(left) // PHASES)]
    known = states(orbit, taus)
    best = int(np.argmax([_margin(follower, y, tau) for tau, y in zip(taus, known, strict=True)]))
    return float(taus[best]), known[best]


def _margin(follower: Follower, y: Array, tau: float) -> float:
    try:
        z, mode = follower.begin(y, tau)
    except ArithmeticError:
        return -np.inf
    equations = follower.system.equations(follower.Omega, mode)
    return min((equations.guard(k, z)[0] for k in range(len(equations.guards))), default=np.inf)
