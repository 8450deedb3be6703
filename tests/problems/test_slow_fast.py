"""Slow and fast: canards, AUTO's forced FitzHugh-Nagumo, a homoclinic end; no label that is not true there.

Along a canard perturbations grow by hundreds of decades and are lost again, so an initial-value problem once
round says nothing. Orbits are confirmed by two: from the jump on, and backwards from the jump, each of which
is attracted; they are to meet at the fold after the period.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym

ORBIT = {"omega": per.PhaseCondition()}


def van_der_pol(eps: float) -> sym.CompiledSystem:
    """eps x' = y - x^3/3 + x, y' = a - x."""
    return sym.compile(
        sym.Equations(
            lambda x, p: {"x": (x.y - x.x**3 / 3 + x.x) / p.eps, "y": p.a - x.x},
            states={"x": 1.0, "y": -2 / 3},
            parameters={"a": 1.05, "eps": eps},
        )
    )


def explosion(eps: float, lowest: float, tol: float = 1e-6) -> per.Branch:
    """The orbits born at a = 1, through their explosion, to relaxation oscillations at the lowest a."""
    system = van_der_pol(eps)
    (hopf,) = per.trace(system, "a", (lowest, 1.05), start=1.05, method=per.Equilibrium()).labelled("HB")
    guess = per.hopf(system, hopf.orbit, "a")
    branch = per.trace(system, "a", (lowest, 1.05), start=None, guess=guess, determined=ORBIT, tol=tol)
    assert branch.special_points[0].parameter == lowest
    assert [p.label for p in branch.special_points] == ["EP", "EP", "HB"]
    return branch


def span(point: per.Point) -> float:
    """Peak to peak of x."""
    return point.maximum["x"] - point.minimum["x"]


def nontrivial(point: per.Point) -> complex:
    """The multiplier that is not 1."""
    rest: complex = np.delete(point.multipliers, np.abs(point.multipliers - 1).argmin())[0]
    return rest


def run(eps: float, a: float, begin: list[float], until: float, stop: Any) -> Any:
    """x, y and the integral of the divergence, until an event or a time."""

    def rates(t: float, s: np.ndarray) -> list[float]:
        return [(s[1] - s[0] ** 3 / 3 + s[0]) / eps, a - s[0], (1 - s[0] ** 2) / eps]

    def jacobian(t: float, s: np.ndarray) -> list[list[float]]:
        return [[(1 - s[0] ** 2) / eps, 1 / eps, 0], [-1, 0, 0], [-2 * s[0] / eps, 0, 0]]

    found = solve_ivp(
        rates, (0, until), [*begin, 0.0], method="Radau", jac=jacobian, events=stop, rtol=1e-10, atol=1e-12
    )
    assert found.status == 1
    return found.t[-1], found.y[:, -1]


def fold(direction: int) -> Any:
    """An event at x = 1, passed in the direction of integration upwards (1) or downwards (-1)."""

    def event(t: float, s: np.ndarray) -> float:
        return float(s[0] - 1)

    event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
    return event


def to_the_fold(eps: float, a: float, begin: list[float]) -> tuple[float, np.ndarray]:
    """From a place forwards and backwards to x = 1: the time, and how far the ends are apart."""
    forth, last = run(eps, a, begin, 10.0, fold(-1))
    back, first = run(eps, a, begin, -10.0, fold(1))
    return forth - back, last - first


def confirmed(point: per.Point, eps: float) -> None:
    """Assert an orbit from where it leaves the repelling branch on, to the right, or with a head left."""
    x, y = point.orbit.state(np.linspace(0, 2 * np.pi, 20001)).T
    rate = np.where(np.abs(x) < 1, y - x**3 / 3 + x, 0.0)
    k = int(rate.argmin() if span(point) > 3.2 else rate.argmax())
    period, apart = to_the_fold(eps, point.parameter, [float(x[k]), float(y[k])])
    assert apart[1] == pytest.approx(0, abs=1e-7)
    assert period == pytest.approx(2 * np.pi / point.orbit.parameter[2], rel=1e-5)
    assert np.log(abs(nontrivial(point))) == pytest.approx(apart[2], rel=1e-4)


def maximal(eps: float) -> float:
    """The a where the attracting and the repelling slow manifold meet at the fold, between two values."""

    def gap(a: float) -> float:
        forth = run(eps, a, [1.8, 1.8**3 / 3 - 1.8], 10.0, fold(-1))[1]
        back = run(eps, a, [0.2, 0.2**3 / 3 - 0.2], -10.0, fold(1))[1]
        return float(forth[1] - back[1])

    guess = 1 - eps / 8 - 3 * eps**2 / 32
    low, high = guess - eps**2 / 50, guess + eps**2 / 50
    ends = gap(low), gap(high)
    for _ in range(6):
        middle = high - ends[1] * (high - low) / (ends[1] - ends[0])
        low, high, ends = high, middle, (ends[1], gap(middle))
        if abs(high - low) < 1e-14:
            break
    return high


def test_canard_explosion() -> None:
    """Assert van der Pol's canards at eps = .01: where they are, each orbit and its multiplier, no label."""
    branch = explosion(0.01, 0.9)
    place = maximal(0.01)
    assert place == pytest.approx(0.9987404561, abs=1e-8)  # the expansion in eps
    inside = [p for p in branch if 1.0 < span(p) < 3.9]
    assert np.array([p.parameter for p in inside]) == pytest.approx(place, abs=1e-6)
    assert min(abs(p.parameter - place) for p in inside) < 1e-11
    grown = np.array([span(p) for p in branch])
    assert (np.diff(grown) < 0).all()
    for point in branch:
        assert -1e-6 < nontrivial(point).real < 1 + 1e-6
    for wanted in (1.2, 2.2, 2.9, 3.4, 3.8):
        confirmed(min(branch, key=lambda p, at=wanted: abs(span(p) - at)), 0.01)


@pytest.mark.long
def test_canard_explosion_of_hundreds_of_decades() -> None:
    """Assert the same at eps = .001, where perturbations grow by up to 1e579 along the canards."""
    branch = explosion(0.001, 0.99)
    place = maximal(0.001)
    assert place == pytest.approx(0.9998749061, abs=1e-10)
    inside = [p for p in branch if 1.0 < span(p) < 3.9]
    assert np.array([p.parameter for p in inside]) == pytest.approx(place, abs=1e-6)
    for point in branch:
        assert -1e-6 < nontrivial(point).real < 1 + 1e-6
    confirmed(min(inside, key=lambda p: abs(span(p) - 1.2)), 0.001)


AUTO_FRC = {10.0: 0.50342723354, 2.0: 0.52550727494, 1.0: 0.52911879662, 0.5: 0.53020758299}
"""Root mean square of v over beta by AUTO-07p, demo frc with 400 intervals and tolerances of 1e-10."""


def forced() -> sym.CompiledSystem:
    """AUTO's demo frc: FitzHugh-Nagumo, forced about the middle branch of its cubic."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        cubic = x.v * (x.v - p.a) * (1 - x.v)
        return {"v": (cubic - x.w) / p.eps, "w": x.v - p.d * x.w - (p.a + p.r * wave.sin)}

    parameters = {"a": 0.5, "eps": 0.005, "d": 1.0, "r": 0.0, "beta": 100.0}
    return sym.compile(sym.Equations(rates, {"v": 0.5, "w": 0.0}, parameters, frequency="beta"))


def exponents(point: per.Point) -> np.ndarray:
    """log |mu| of frc's orbit: perturbations carried along it twice, orthogonalised at 400 places a turn."""
    beta, eps, frame = point.parameter, 0.005, np.eye(2)
    for _ in range(2):
        grown = np.zeros(2)
        for k in range(400):

            def rates(tau: float, m: np.ndarray) -> np.ndarray:
                v = point.orbit.state(np.array([tau]))[0, 0]
                slope = (-3 * v**2 + 3 * v - 0.5) / eps
                return (np.array([[slope, -1 / eps], [1, -1]]) / beta @ m.reshape(2, 2)).ravel()

            ends = np.array([k, k + 1]) * 2 * np.pi / 400
            found = solve_ivp(rates, ends, frame.ravel(), method="DOP853", rtol=1e-9, atol=1e-12)
            frame, triangle = np.linalg.qr(found.y[:, -1].reshape(2, 2))
            grown += np.log(np.abs(np.diag(triangle)))
    return grown


def test_forced_fitzhugh_nagumo() -> None:
    """Assert AUTO's frc beyond its end, beside AUTO, and multipliers of 1e67 by the variational equations."""
    grown = per.trace(forced(), "r", (0.1, 0.2), start=0.1)
    branch = per.trace(forced(), "beta", (0.5, 100), start=100, at=sorted(AUTO_FRC), guess=grown[-1].orbit)
    assert branch.stop.reason is per.Reason.BOUND
    assert {p.label.value for p in branch.special_points} == {"EP", "UZ"}
    for beta, wanted in AUTO_FRC.items():
        point = min(branch, key=lambda p, at=beta: abs(p.parameter - at))
        v = point.orbit.state(np.linspace(0, 2 * np.pi, 40000, endpoint=False))[:, 0]
        assert np.sqrt((v**2).mean()) == pytest.approx(wanted, rel=1e-7)
        if beta == 1.0:
            sizes = np.sort(np.log(np.abs(point.multipliers)))[::-1]
            assert sizes == pytest.approx(exponents(point), rel=1e-6)
            assert sizes[0] > 67 * np.log(10)


def test_homoclinic_end() -> None:
    """Assert that orbits of x'' = x - x^2 + lam x' + x x'/2 about 1 end at the saddle's loop, and say so."""
    system = sym.compile(
        sym.Equations(
            lambda x, p: {"x": x.y, "y": x.x - x.x**2 + p.lam * x.y + x.x * x.y / 2},
            states={"x": 1.0, "y": 0.0},
            parameters={"lam": -0.55},
        )
    )
    (hopf,) = per.trace(system, "lam", (-0.6, -0.3), guess={"x": 1.0}, method=per.Equilibrium()).labelled(
        "HB"
    )
    guess = per.hopf(system, hopf.orbit, "lam")
    branch = per.trace(system, "lam", (-0.6, -0.3), start=None, guess=guess, determined=ORBIT)
    assert [s.reason for s in branch.stops] == [per.Reason.EQUILIBRIUM, per.Reason.HOMOCLINIC]
    assert [p.label for p in branch.special_points] == ["HB", "EP", "EP"]
    assert branch[-1].parameter == pytest.approx(saddle_loop(), abs=1e-9)


def saddle_loop() -> float:
    """The lam at which the saddle's unstable manifold comes back as its stable one, by their distance."""

    def gap(lam: float) -> float:
        found = []
        for way in (1, -1):  # out along the unstable direction, and backwards along the stable one
            rate = (lam + way * np.sqrt(lam**2 + 4)) / 2
            begin = np.array([1.0, rate]) * 1e-6
            event: Any = lambda t, s: s[1]  # noqa: E731
            event.terminal, event.direction = True, -way
            end = solve_ivp(
                lambda t, s, lam=lam: [s[1], s[0] - s[0] ** 2 + lam * s[1] + s[0] * s[1] / 2],
                (0, way * 100),
                begin,
                method="DOP853",
                events=event,
                rtol=1e-12,
                atol=1e-14,
            )
            found.append(float(end.y[0, -1]))
        return found[0] - found[1]

    low, high = -0.44, -0.42
    for _ in range(8):
        ends = gap(low), gap(high)
        low, high = high, high - ends[1] * (high - low) / (ends[1] - ends[0])
        if abs(high - low) < 1e-13:
            break
    return high
