"""Equivalent linear damping: of orbits, from their multipliers, and of a time step, from its growth factor.

Both multiply a small free motion by a factor mu in a time T: mu = exp(lambda T), and the damping ratio is
zeta = -Re(lambda)/|lambda|.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

import periodic
from reports.studies.paper.common.scenes import PAPER_SPEED, at_paper_speed, system
from reports.studies.paper.common.tracing import traced
from reports.studies.paper.marching.rungekutta import factor
from symbolic.motion.linear import Modes

WAVINESS = 1.27e-6
"""The paper's corrugation amplitude, m."""

SMALL, ONE, LARGE = 0.01, 1.0, 2.0
"""Waviness, in parts of the paper's, at which transients and orbits are compared."""

RANGE = (1e-3 * WAVINESS, 6e-6)
"""Waviness over which orbits are traced at the paper's speed, m."""


def exponent(factor: complex, time: float, frequency: float) -> complex:
    """Return lambda with exp(lambda time) = factor and Im(lambda) nearest `frequency` (all in rad/s, s).

    The logarithm leaves Im(lambda) open up to a whole number of turns in `time`, the conjugate its sign.
    """
    turn = 2 * math.pi / time
    ways = []
    for angle in (cmath.phase(factor), -cmath.phase(factor)):
        turns = round((frequency - angle / time) / turn)
        ways.append(complex(math.log(abs(factor)) / time, angle / time + turns * turn))
    return min(ways, key=lambda way: abs(way.imag - frequency))


def ratio(value: complex) -> float:
    """Return zeta = -Re(lambda)/|lambda|."""
    return -value.real / abs(value)


@cache
def waviness_branch(name: str) -> periodic.Branch:
    """Return the orbits of a scene at 360 rev/min against the waviness, with the compared ones asked for."""
    at = [part * WAVINESS for part in (SMALL, ONE, LARGE)]
    close = periodic.ArclengthControl(ds_max=0.04)
    return traced(system(name, PAPER_SPEED), "amplitude", RANGE, at=at, step=close)


def orbit_at(name: str, part: float) -> periodic.Point:
    """Return the orbit of a scene at 360 rev/min and one of the compared parts of the paper's waviness."""
    points = waviness_branch(name).labelled(periodic.Label.USER)
    return next(point for point in points if point.parameter == part * WAVINESS)


def orbit_exponents(name: str) -> list[tuple[periodic.Point, complex]]:
    """Return the exponents of the orbits at 360 rev/min, from the smallest waviness on; see `exponents`."""
    rest = at_paper_speed(name)
    return exponents(waviness_branch(name), rest, lambda point: 2 * math.pi / rest.omega)


def exponents(
    branch: periodic.Branch, rest: Modes, period: Callable[[periodic.Point], float]
) -> list[tuple[periodic.Point, complex]]:
    """Return the orbits of a branch with their exponents (1/s), as long as stable with an oscillating pair.

    The imaginary part is continued from orbit to orbit, beginning with the linear frequency of `rest`.
    period: that of the excitation at a point, in s.
    """
    frequency = float(rest.damped_frequencies[0])
    found: list[tuple[periodic.Point, complex]] = []
    for point in branch:
        if not point.stable or point.multipliers[0].imag == 0:
            break
        found.append((point, exponent(complex(point.multipliers[0]), period(point), frequency)))
        frequency = found[-1][1].imag
    return found


def orbit_ratio(name: str, part: float) -> float:
    """Return the damping ratio of small free motion about an orbit; see `orbit_at`."""
    chosen = orbit_at(name, part)
    return next(ratio(value) for point, value in orbit_exponents(name) if point is chosen)


def _step(order: int, z: complex) -> complex:
    return complex(factor(np.array([z]), order)[0])


def stepped_ratio(name: str, order: int, step: float) -> float:
    """Return the damping ratio that the linear motion of a scene has in Runge-Kutta steps (s)."""
    slow = complex(at_paper_speed(name).oscillating[0])
    return ratio(exponent(_step(order, slow * step), step, slow.imag))


def film_growth(name: str, order: int, step: float) -> float:
    """Return the growth per Runge-Kutta step of the film's own, fastest motion; above 1 it is unstable."""
    fastest = at_paper_speed(name).eigenvalues[-1]
    return abs(_step(order, complex(fastest) * step))


def linear_acceleration(eigenvalues: NDArray[np.complex128], step: float, weight: float) -> np.ndarray:
    """Return the growth factors (3,) of a step in which d2h/dt2 varies linearly, h''' = j constant.

    The third-order equation of the film has these eigenvalues, h''' = f(h, h', h''), and
    j = (1 - weight) f(begin) + weight f(end): 0 explicit, 1/2 the mean, 1 the end (iterated).
    """
    _, c2, c1, c0 = np.poly(eigenvalues).real
    f = -np.array([c0, c1, c2])
    drift = np.array([[1, step, step**2 / 2], [0, 1, step], [0, 0, 1]])
    jerk = np.array([step**3 / 6, step**2 / 2, step])
    left = np.eye(3) - weight * np.outer(jerk, f)
    return np.linalg.eigvals(np.linalg.solve(left, drift + (1 - weight) * np.outer(jerk, f))).astype(complex)


def accelerated_ratio(name: str, step: float, weight: float) -> float:
    """Return the damping ratio that the linear motion has in steps of linear acceleration."""
    rest = at_paper_speed(name)
    slow = complex(rest.oscillating[0])
    factors = linear_acceleration(rest.eigenvalues, step, weight)
    ways = [exponent(complex(factor), step, slow.imag) for factor in factors]
    return ratio(min(ways, key=lambda way: abs(way - slow)))
