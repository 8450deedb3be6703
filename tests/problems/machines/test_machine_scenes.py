"""Scenes of machines, each at five places, against DOP853 on equations written out by hand."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from reference.returning import Rates, shot
from support.kept import kept

import periodic as per
import symbolic as sym

RPM = 2 * math.pi / 60
PSI, WEIGHT = (part * math.pi / 2 for part in np.polynomial.legendre.leggauss(120))
BALLS = 2 * np.pi * np.arange(8) / 8


@dataclass(frozen=True)
class Case:
    """A scene: its rates at a value of its parameter, where it is compared, and the size of its states."""

    rates: Callable[[float], Rates]
    parameter: str
    places: tuple[float, ...]
    size: tuple[float, ...]
    accuracy: float = 3e-7


def rub(w: float) -> Rates:
    """m = k = 1, c = 0.2, e = 0.3, weight 0.1, stator of stiffness 2 and friction 0.1 at r = 1."""

    def found(tau: float, s: np.ndarray) -> list[float]:
        x, vx, y, vy = s
        r = math.hypot(x, y)
        p = 2 * max(r - 1, 0) / r
        fx = 0.3 * w**2 * math.cos(tau) - 0.2 * w * vx - x - p * (x - 0.1 * y)
        fy = 0.3 * w**2 * math.sin(tau) - 0.2 * w * vy - y - p * (y + 0.1 * x) - 0.1
        return [vx, fx / w**2, vy, fy / w**2]

    return found


def internal(n: float) -> Rates:
    """The rotor of machines' table: D = 0.2, d = 1/3, d3 = e = 0.25, weight 0.3924; x = z2 and y = z1."""

    def found(tau: float, s: np.ndarray) -> list[float]:
        x, vx, y, vy = s[0], n * s[1], s[2], n * s[3]
        ax = -0.4 * (4 / 3) * vx - 0.25 * vx**3 - x - 0.4 * n * y + 0.25 * n**2 * math.cos(tau) - 0.3924
        ay = -0.4 * (4 / 3) * vy - 0.25 * vy**3 - y + 0.4 * n * x + 0.25 * n**2 * math.sin(tau)
        return [s[1], ax / n**2, s[3], ay / n**2]

    return found


def pressure(x: float, y: float, vx: float, vy: float, turn: float) -> np.ndarray:
    """Force of a short cavitated film over mu R L^3/(2 c^2), by quadrature of its positive pressure."""
    a, b = turn * y + 2 * vx, 2 * vy - turn * x
    angle = PSI + math.atan2(b, a)
    load = WEIGHT * math.hypot(a, b) * np.cos(PSI) / (1 - x * np.cos(angle) - y * np.sin(angle)) ** 3
    return -np.array([load @ np.cos(angle), load @ np.sin(angle)])


def film(c: float, size: float, k: float, e: float, turning: bool, weight: float) -> Callable[[float], Rates]:
    """A rotor of 20 kg on a film of clearance c, in units of 1e-4 m."""

    def at(w: float) -> Rates:
        def found(tau: float, s: np.ndarray) -> list[float]:
            q = s * 1e-4
            force = size * pressure(*(v / c for v in (q[0], q[2], w * q[1], w * q[3])), w * turning)
            wave = e * w**2 * np.array([math.cos(tau), math.sin(tau)])
            a = wave + (force - k * q[[0, 2]] + np.array([0, -weight])) / 20
            return [s[1], a[0] / w**2 * 1e4, s[3], a[1] / w**2 * 1e4]

        return found

    return at


def rubbed(limit: Callable[[float, float], float]) -> Callable[[float], Rates]:
    """m = k = 1, c = 0.02, F = 0.1 and a friction of speed."""

    def at(w: float) -> Rates:
        def found(tau: float, s: np.ndarray) -> list[float]:
            force = 0.1 * math.cos(tau) - 0.02 * w * s[1] - s[0] - limit(s[0], w * s[1])
            return [s[1], force / w**2]

        return found

    return at


def slider(w: float) -> Rates:
    """The same with a spring of 0.5 and a slider that gives way at 0.1."""

    def found(tau: float, s: np.ndarray) -> list[float]:
        f = 0.5 * (s[0] - s[2])
        over = (max(f - 0.1, 0) + min(f + 0.1, 0)) / 0.5
        force = 0.1 * math.cos(tau) - 0.02 * w * s[1] - s[0] - f
        return [s[1], force / w**2, over / 1e-2 + 1e-4 * f / 0.5]

    return found


def stop(w: float) -> Rates:
    """m = k = 1, c = 0.1, F = 0.3, a stop of stiffness 20 at 1."""

    def found(tau: float, s: np.ndarray) -> list[float]:
        force = 0.3 * math.cos(tau) - 0.1 * w * s[1] - s[0] - 20 * max(s[0] - 1, 0)
        return [s[1], force / w**2]

    return found


def oiled(speed: float) -> Rates:
    """The ball bearing in um, each ball's load under its films by bisection of ln W."""
    omega = 8 * speed * 40.1 / 104.0

    def loads(d: np.ndarray) -> np.ndarray:
        low, high = np.full(8, -120.0), np.full(8, 25.0)
        for _ in range(70):
            y = (low + high) / 2
            excess = np.exp((y - math.log(13.34e9)) / 1.5) - 0.6e-6 * np.exp((math.log(100) - y) / 13.7) - d
            low, high = np.where(excess < 0, y, low), np.where(excess < 0, high, y)
        return np.exp((low + high) / 2)

    def found(tau: float, s: np.ndarray) -> list[float]:
        theta = tau / 8 + BALLS
        load = loads((s[0] * np.cos(theta) + s[2] * np.sin(theta) - 6) * 1e-6)
        ax = (196 - load @ np.cos(theta)) / 20 * 1e6 / omega**2 - 10 / omega * s[1]
        ay = -(load @ np.sin(theta)) / 20 * 1e6 / omega**2 - 10 / omega * s[3]
        return [s[1], ax, s[3], ay]

    return found


def rpm(*values: float) -> tuple[float, ...]:
    """Speeds in rad/s."""
    return tuple(value * RPM for value in values)


JOURNAL = film(1e-4, 0.02 * 25e-3 * 25e-3**3 / (2 * 1e-4**2), 0.0, 1e-6, True, 196.2)
SQUEEZE = film(150e-6, 0.01 * 60e-3 * 25e-3**3 / (2 * 150e-6**2), 5e6, 50e-6, False, 0.0)
ONES = (1.0,) * 4
CASES = {
    "jeffcott-rub": Case(rub, "speed", (0.5, 0.9, 1.1, 1.25, 1.8), ONES),
    "jeffcott-internal-damping": Case(internal, "n", (1.25, 1.5, 1.7, 1.9, 2.1), ONES),
    "journal-bearing": Case(JOURNAL, "speed", rpm(4000, 5500, 7000, 9000, 11000), (1e-2,) * 4),
    "squeeze-film-damper": Case(SQUEEZE, "speed", rpm(3000, 4500, 6000, 8000, 11000), ONES),
    "friction-damper": Case(
        rubbed(lambda x, v: 0.05 * math.tanh(v / 0.01)), "Omega", (0.6, 0.9, 1.0, 1.1, 1.4), ONES[:2]
    ),
    "jenkins-damper": Case(slider, "Omega", (0.7, 1.05, 1.1, 1.15, 1.5), ONES[:3], 1e-6),
    "stop": Case(stop, "Omega", (0.8, 0.87, 1.0, 1.25, 1.6), ONES[:2]),
    "ball-bearing-lubricated": Case(oiled, "speed", rpm(9000, 8000, 7000, 6600, 6000), ONES, 1e-6),
}
QUICK = ("jeffcott-internal-damping", "stop", "friction-damper")


@kept
def branch(name: str) -> per.Branch:
    """The branch of a scene through the places."""
    case, (begin, end) = CASES[name], _range(name)
    low, high = min(begin, end), max(begin, end)
    return per.trace(sym.scene(name), case.parameter, (low, high), start=begin, at=case.places)


def _range(name: str) -> tuple[float, float]:
    from symbolic.scenes.reading import load

    begin, end = load(name).trace.ends
    return (begin * RPM, end * RPM) if max(begin, end) > 100 else (begin, end)


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[] if n in QUICK else [pytest.mark.long]) for n in CASES]
)
def test_orbits(name: str) -> None:
    """Assert orbits and multipliers of every sheet at five places by shooting; the branch gets to its end."""
    case, found = CASES[name], branch(name)
    assert found.stop.reason is per.Reason.BOUND
    assert {p.parameter for p in found.labelled(per.Label.USER)} == set(case.places)
    for point in found.labelled(per.Label.USER):
        begin = point.orbit.state(np.zeros(1))[0]
        own = shot(case.rates(point.parameter), begin, case.size)
        assert begin == pytest.approx(own.start, abs=case.accuracy)
        largest = abs(own.multipliers[0])
        assert abs(point.multipliers[0]) == pytest.approx(largest, rel=1e-4, abs=1e-6)


def test_known_torus_bifurcation() -> None:
    """Assert the known NS of the rotor with internal damping, and the angle of its multipliers."""
    (torus,) = branch("jeffcott-internal-damping").labelled(per.Label.TORUS)
    assert torus.parameter == pytest.approx(1.7147671116, abs=2e-9)
    assert abs(np.angle(torus.multipliers[0])) == pytest.approx(2.6163770287, abs=1e-6)
