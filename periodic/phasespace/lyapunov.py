"""Lyapunov exponents: how fast motions beside one another part, in each direction.

Tangents are carried along the motion, mapped at kinks, impacts and where sliding begins by their saltation
matrices, and made orthonormal after each period (Benettin, Galgani, Giorgilli & Strelcyn, Meccanica 15 (1980)
9-20 and 21-30; Mueller, Chaos, Solitons & Fractals 5 (1995) 1671 for systems that jump).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from periodic.checks import named, number, one_of, whole
from periodic.orbit.layout import layout_of
from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.following.values import parameters
from periodic.system import System, check_system
from periodic.system.ensembles import FOLLOWED

BATCHES = 20
"""How many averages over stretches of a motion tell how well that over all is known."""

PARTS = 32
"""How many times in a period tangents are made orthonormal: in a whole one they may become one."""

SIGMAS = 4.0
"""Standard errors by which a chaotic motion's largest exponent is above 0."""

LEAST_TURNING = 20
"""Fewest periods, else a tenth of all, in which tangents turn to their directions before they count."""

WHY = (
    "",
    "its work was used up",
    "it diverges",
    "events pile up in a point",
    "its steps became too small",
)
"""By outcome, why a motion was not followed to its end."""


class LyapunovError(ArithmeticError):
    """The motion could not be followed; the sentence says why, and what to try."""


@dataclass(frozen=True, eq=False)
class Exponents:
    """Lyapunov exponents of a motion.

    Parameters
    ----------
    values : ndarray, shape (k,)
        The exponents in 1/s, the largest first; minus infinity where neighbouring motions become one at once,
        as where friction comes to stick.
    errors : ndarray, shape (k,)
        Standard errors of the values, from averages over parts of the motion.
    growth : ndarray, shape (K, k)
        By how much the logarithm of each tangent grew in each period.
    state : dict
        States (SI) at the end, by name.
    """

    values: Array
    errors: Array
    growth: Array = field(repr=False)
    state: dict[str, float] = field(repr=False)

    @property
    def chaotic(self) -> bool:
        """Whether the largest exponent is positive by more than four of its standard errors."""
        return bool(self.values[0] > SIGMAS * self.errors[0])

    @property
    def dimension(self) -> float:
        """Kaplan and Yorke's dimension of the attractor; NaN where too few exponents are known."""
        sums = np.cumsum(self.values)
        if not len(sums) or sums[0] < 0:
            return 0.0
        below = np.flatnonzero(sums < 0)
        if not len(below):
            return float("nan")
        j = int(below[0])
        return float(j + sums[j - 1] / abs(self.values[j]))


def lyapunov(
    system: System,
    values: Mapping[str, float] | None = None,
    *,
    start: Mapping[str, float] | None = None,
    exponents: int | None = None,
    periods: int = 2000,
    settle: int = 500,
    tol: float = 1e-9,
) -> Exponents:
    """Return the Lyapunov exponents of the motion to which a system settles.

    Parameters
    ----------
    system : System
        The equations; one that integrates itself in time, as those of `symbolic.compile` do.
    values : mapping of str to float, optional
        Parameters (SI) that differ from their nominal values.
    start : mapping of str to float, optional
        States (SI) where it begins, x' being the velocity; the others, and by default all, at rest.
    exponents : int, optional
        How many exponents, the largest ones; default all.
    periods : int
        Periods of the excitation, or times 2 pi / omega, over which they are averaged.
    settle : int
        Periods before these.
    tol : float
        Relative and absolute tolerance of the integration in scaled variables.

    Returns
    -------
    Exponents
        The exponents in 1/s with their standard errors.

    Raises
    ------
    ValueError
        For names, numbers and systems that are not allowed.
    LyapunovError
        Where the motion diverges or cannot be followed.
    """
    check_system(system)
    parameter = parameters(system, values)
    crowd, n = Crowd(system, parameter, tol), len(system.states)
    count = n if exponents is None else whole("exponents", exponents)
    if count > n:
        raise ValueError(f"exponents is {count}; the system has {n} states, and so many at the most")
    begin = beginning(system, parameter, start)
    whole("periods", periods, BATCHES)
    settled = crowd.run(crowd.begin(begin[None]), whole("settle", settle, 0), FORCED)
    _check(int(settled.outcome[0]))
    found = exponents_of(crowd, settled.ends, settled.modes, count, periods)
    rate = rate_of(crowd)
    units = layout_of(system).units(parameter)
    state = {name: unit * float(x) for (name, unit), x in zip(units.items(), found.end[:n], strict=True)}
    return Exponents(rate * found.mean, rate * found.error, found.growth, state)


@dataclass(frozen=True, eq=False)
class Growth:
    """By how much tangents grew in each period, (K, k), the fastest first, and y (w,) at the end."""

    growth: Array
    end: Array

    @property
    def mean(self) -> Array:
        """Of all periods, (k,)."""
        return np.asarray(self.growth.mean(axis=0))

    @property
    def error(self) -> Array:
        """Standard error of the mean, (k,), by batches."""
        parts = np.array([part.mean(axis=0) for part in np.array_split(self.growth, BATCHES)])
        with np.errstate(invalid="ignore"):
            return np.asarray(parts.std(axis=0, ddof=1) / np.sqrt(BATCHES))


def exponents_of(crowd: Crowd, y: Array, modes: Any, count: int, periods: int) -> Growth:
    """Return the growth of `count` tangents along a motion from y (1, w). Raises LyapunovError."""
    tangents = crowd.tangents(y)[:, :count]
    basis = np.swapaxes(np.linalg.qr(np.swapaxes(tangents, 1, 2))[0], 1, 2)
    turning = max(LEAST_TURNING, periods // 10)
    found = crowd.run(y, PARTS * (periods + turning), FORCED / PARTS, modes=modes, tangents=basis)
    _check(int(found.outcome[0]))
    growth = found.growth[0].reshape(-1, PARTS, count).sum(axis=1)[turning:]
    order = np.argsort(-growth.mean(axis=0), kind="stable")
    return Growth(growth[:, order], found.ends[0])


def rate_of(crowd: Crowd) -> float:
    """Return by what growth in a period is multiplied to be one in a second."""
    layout = layout_of(crowd.system)
    omega = layout.omega(crowd.parameter) if layout.frequency else 1.0
    return omega / FORCED


def beginning(system: System, parameter: Array, start: Mapping[str, float] | None) -> Array:
    """Return the states (n,), scaled, where a motion begins. Raises ValueError."""
    rest = np.asarray(system.rest(parameter)[0], dtype=float).copy()
    if not start:
        return rest
    units = layout_of(system).units(parameter)
    for name, value in named("start", start, "states").items():
        k = list(units).index(one_of("a state in start", name, units))
        rest[k] = number(f"start of {name}", value) / units[name]
    if not np.isfinite(rest).all():
        raise ValueError(f"start is {dict(start)}; its values must be finite")
    return rest


def _check(outcome: int) -> None:
    if outcome != FOLLOWED:
        raise LyapunovError(
            f"the motion could not be followed: {WHY[outcome]}; another start=, or other values, may settle"
        )
