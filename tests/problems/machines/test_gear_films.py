"""The gear pair with lubricated flanks, steady and squeezed, against DOP853 on equations written by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from reference.returning import Rates, shot

import periodic as per
import symbolic as sym

H0, W0, BETA, SQUEEZE = 0.05, 0.1, 8.0, 2.0
PLACES = (1.15, 1.1, 1.05, 1.0, 0.95)


def system(squeeze: float | None) -> sym.CompiledSystem:
    """The gear pair of Kahraman & Singh, without dimension, with a film on either flank."""
    x = sym.coordinate("x", unit="")
    m, frequency = sym.parameter("m", 1.0), sym.parameter("Omega", 1.2, "rad/s")
    film = sym.films.SeriesFilm(sym.films.PowerFilm(H0, W0, BETA), typical=W0, squeeze=squeeze)
    mesh = sym.GearMesh(x, 1.0, 1.0, (0.2, 0.1, 0.05), film=film)
    error = sym.TransmissionError(x, m, (0.01, 0.004, 0.002), frequency)
    return sym.compile(sym.Mass(x, m) + sym.Damper(x, 0.1) + sym.ConstantForce(x, 0.1) + mesh + error)


def load(approach: float, k: float) -> float:
    """W of W/k = d + H(W), by bisection of ln W."""
    low, high = -200.0, 10.0
    for _ in range(90):
        y = (low + high) / 2
        if math.exp(y) / k < approach + H0 * math.exp((math.log(W0) - y) / BETA):
            low = y
        else:
            high = y
    return math.exp((low + high) / 2)


def forced(w: float, tau: float, x: float, v: float, mesh: float) -> list[float]:
    """x' and x'' with the force of the mesh."""
    error = sum(e * (j * w) ** 2 * math.cos(j * tau) for j, e in enumerate((0.01, 0.004, 0.002), 1))
    return [v, (0.1 + error - 0.1 * w * v - mesh) / w**2]


def stiffness(tau: float) -> float:
    """k(tau)."""
    return 1 - 0.2 * math.cos(tau) - 0.1 * math.cos(2 * tau) - 0.05 * math.cos(3 * tau)


def steady(w: float) -> Rates:
    """Both films steady."""

    def found(tau: float, s: np.ndarray) -> list[float]:
        k = stiffness(tau)
        return forced(w, tau, s[0], s[1], load(s[0] - 1, k) - load(-s[0] - 1, k))

    return found


@pytest.mark.parametrize("squeeze", [None, SQUEEZE])
def test_films_take_the_kinks(squeeze: float | None) -> None:
    """Assert that no switch is left, and that the film carries the load where dry flanks would part."""
    compiled = system(squeeze)
    assert compiled.switches == ()
    (point, *_) = per.trace(compiled, "Omega", (1.19, 1.2), start=1.2)
    assert len(point.orbit.phases) == 0
    assert 0.9 < point.minimum["x"] < 1.0


def test_orbits_with_steady_films() -> None:
    """Assert orbits and the product of multipliers at five places by shooting."""
    branch = per.trace(system(None), "Omega", (0.9, 1.2), start=1.2, at=PLACES)
    points = branch.labelled(per.Label.USER)
    assert {point.parameter for point in points} == set(PLACES)
    for point in points:
        own = shot(steady(point.parameter), point.orbit.state(np.zeros(1))[0], (1.0, 1.0))
        assert point.orbit.state(np.zeros(1))[0] == pytest.approx(own.start, abs=3e-7)
        assert abs(point.multipliers[0]) == pytest.approx(abs(own.multipliers[0]), rel=1e-4)


def test_orbit_with_squeezed_films() -> None:
    """Assert the driving flank's orbit with its film's own equation, dh/dt = ln(H(W)/h) u/s."""
    w = 1.1
    (point, *_) = per.trace(system(SQUEEZE), "Omega", (w, 1.2), start=w)

    def found(tau: float, s: np.ndarray) -> list[float]:
        k, h = stiffness(tau), s[2]
        w_driving = k * (s[0] - 1 + h)
        squeezed = math.log(H0 * (w_driving / W0) ** (-1 / BETA) / h) / SQUEEZE / w
        return [*forced(w, tau, s[0], s[1], w_driving - coasting(s[0])), squeezed]

    x, v, driving, _ = point.orbit.state(np.zeros(1))[0]
    k = stiffness(0.0)
    h = load(x - 1, k) * math.exp(driving) / k - (x - 1)
    own = shot(found, np.array([x, v, h]), (1.0, 1.0, 1.0))
    assert [x, v, h] == pytest.approx(own.start, abs=1e-6)
    assert abs(driving) > 1e-3


def coasting(x: float) -> float:
    """The coasting flank is far away, its film as thick as the gap: it carries less than 1e-12."""
    assert x > 0.5
    return 0.0
