"""Squeezed films on the balls of a bearing, in multiblade coordinates, against each ball's own equation.

Over a passage every ball takes the place of the next: the motion returns after relabelling the balls.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from support.kept import kept

import periodic as per
import symbolic as sym

Array = NDArray[np.float64]

RPM = math.pi / 30
RATIO, OUTER, SQUEEZE = 40.1 / 104.0, 63.9e-3, 5e3
STIFFNESS, H0, W0, BETA = 13.34e9, 0.3e-6, 100.0, 13.7
PRELOAD = 3e-6


@kept
def traced(count: int) -> per.Point:
    """The bearing at 10 krpm."""
    x, y = (sym.coordinate(q, scale=1e-6) for q in "xy")
    film = sym.films.SeriesFilm(sym.films.PowerFilm(H0, W0, BETA), 2, squeeze=SQUEEZE)
    speed = sym.parameter("speed", 1e4 * RPM, "rad/s")
    law = sym.HertzLaw(STIFFNESS)
    bearing = sym.RollingBearing(x, y, count, law, -PRELOAD, speed, 40.1e-3, OUTER, film=film)
    shaft = [part for q in (x, y) for part in (sym.Mass(q, 20.0), sym.Damper(q, 200.0))]
    system = sym.compile(sym.combine([*shaft, sym.ConstantForce(x, 196.0), bearing]))
    return per.trace(system, "speed", (9900 * RPM, 1e4 * RPM), start=1e4 * RPM, tol=1e-8)[0]


def passage(count: int, start: Array) -> Array:
    """Integrate x, x', y, y' (um) and ln(h/um) of each ball over one passage, then relabel the balls."""
    speed = 1e4 * RPM * RATIO
    omega, u = count * speed, speed * OUTER / 2
    balls = 2 * np.pi * np.arange(count) / count

    def rates(tau: float, s: Array) -> Array:
        theta, h = tau / count + balls, np.exp(s[4:]) * 1e-6
        approach = (s[0] * np.cos(theta) + s[2] * np.sin(theta)) * 1e-6 + PRELOAD
        load = STIFFNESS * (approach + 2 * h) ** 1.5
        film = u / SQUEEZE * np.log(H0 * (load / W0) ** (-1 / BETA) / h) / h / omega
        ax = (196 - load @ np.cos(theta)) / 20 * 1e6 / omega**2 - 10 / omega * s[1]
        ay = -(load @ np.sin(theta)) / 20 * 1e6 / omega**2 - 10 / omega * s[3]
        return np.concatenate([[s[1], ax, s[3], ay], film])

    end = solve_ivp(rates, (0, 2 * np.pi), start, method="DOP853", rtol=1e-10, atol=1e-10).y[:, -1]
    return np.concatenate([end[:4], np.roll(end[4:], 1)])


def films(count: int, state: Array) -> Array:
    """ln(h/um) of each ball at tau = 0 from the states: mean, cosines and sines of ln(W/W_steady)."""
    angle = 2 * np.pi * np.arange(count) / count
    orders = range(1, count // 2 + 1)
    v = state[4] + sum(
        state[3 + 2 * k] * np.cos(k * angle) + state[4 + 2 * k] * np.sin(k * angle) for k in orders
    )
    approach = (state[0] * np.cos(angle) + state[2] * np.sin(angle)) * 1e-6 + PRELOAD
    low, high = np.full(count, -50.0), np.full(count, 25.0)
    for _ in range(70):
        y = (low + high) / 2
        film = 2 * H0 * np.exp((math.log(W0) - y) / BETA)
        excess = np.exp((y - math.log(STIFFNESS)) / 1.5) - film - approach
        low, high = np.where(excess < 0, y, low), np.where(excess < 0, high, y)
    deflection = np.exp(((low + high) / 2 + v - math.log(STIFFNESS)) / 1.5)
    return np.asarray(np.log((deflection - approach) / 2 * 1e6))


@pytest.mark.parametrize("count", [4, pytest.param(5, marks=pytest.mark.long)])
def test_motion_returns_after_relabelling(count: int) -> None:
    """Assert the orbit to 1e-9 and the multipliers of one passage, for even and odd numbers of balls."""
    point = traced(count)
    state = point.orbit.state(np.zeros(1))[0]
    start = np.concatenate([state[:4], films(count, state)])
    end = passage(count, start)
    np.testing.assert_allclose(end, start, atol=1e-9)
    steps = 1e-5 * np.eye(len(start))
    monodromy = np.array([(passage(count, start + e) - end) / 1e-5 for e in steps]).T
    own, found = (np.sort(np.abs(m))[::-1] for m in (np.linalg.eigvals(monodromy), point.multipliers))
    np.testing.assert_allclose(found[: count + 4], own[: count + 4], rtol=1e-4, atol=1e-5)


def test_film_is_squeezed() -> None:
    """Assert that the films are off their steady thickness by more than the accuracy above."""
    assert np.abs(traced(4).orbit.state(np.zeros(1))[0][4:]).max() > 5e-4
