"""GPD on curves of period doublings: the cubic coefficient against closed forms and integration."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym
from periodic.conditions.flip import flip_coefficient

COUPLED = 0.7


@cache
def turning() -> sym.CompiledSystem:
    """y' = a y + b y^3 - y^5 + y s, r' = -r, s' = -s + COUPLED y^2 in axes that turn half a turn a period.

    The orbits at rest double at a = 0; there s = COUPLED y^2 on the centre manifold, to leading order, so
    that the cubic coefficient is b + COUPLED times 2 pi.
    """

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        c, s = wave.cos, wave.sin
        square = ((1 + c) * x.u**2 + 2 * s * x.u * x.v + (1 - c) * x.v**2) / 2  # of y = C u + S v
        g = p.a + p.b * square - square**2 + x.s
        along = [((1 + c) * x.u + s * x.v) / 2, (s * x.u + (1 - c) * x.v) / 2]  # C y, S y
        return {
            "u": -x.v / 2 + g * along[0] - (x.u - along[0]),
            "v": x.u / 2 + g * along[1] - (x.v - along[1]),
            "s": -x.s + COUPLED * square,
        }

    states = dict.fromkeys("uvs", 0.0)
    return sym.compile(sym.Equations(rates, states, {"a": -0.2, "b": -1.0, "Omega": 1.0}, frequency="Omega"))


def special(branch: per.Branch) -> list[str]:
    """Labels but for the ends."""
    return [p.label.value for p in branch.special_points if p.label is not per.Label.END]


def test_where_the_coefficient_vanishes() -> None:
    """Assert GPD at b = -COUPLED along the doublings a = 0, and the coefficient throughout."""
    system = turning()
    (doubling,) = per.trace(system, "a", (-0.2, 0.2), tol=1e-9).labelled("PD")
    held = {"a": per.DoublingCondition()}
    curve = per.trace(system, "b", (-1.0, 0.0), guess=doubling.orbit, determined=held, tol=1e-9)
    assert special(curve) == ["GPD"]
    assert curve.labelled("GPD")[0].parameter == pytest.approx(-COUPLED, abs=1e-8)
    for point in curve:
        exact = -2 * np.pi * (point.parameter + COUPLED)
        assert flip_coefficient(system, point.orbit) == pytest.approx(exact, abs=1e-6)


@cache
def escape() -> sym.CompiledSystem:
    """x'' + .1 x' + x - x^2 = F cos(Omega t)."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": p.F * wave.cos - 0.1 * x.v - x.x + x.x**2}

    return sym.compile(
        sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"F": 0.02, "Omega": 0.8}, frequency="Omega")
    )


def integrated(state: Any, force: float, Omega: float, times: Any) -> Any:
    """The derivatives of the motion from a state, at times (N,), shape (N, 2, 2), by DOP853."""

    def rates(t: float, u: Any) -> Any:
        way = u[2:].reshape(2, 2)
        moving = np.array([way[1], -0.1 * way[1] - (1 - 2 * u[0]) * way[0]])
        force_on = force * np.cos(Omega * t) - 0.1 * u[1] - u[0] + u[0] ** 2
        return np.concatenate([[u[1], force_on], moving.ravel()])

    begin = np.concatenate([state, np.eye(2).ravel()])
    found = solve_ivp(rates, times[[0, -1]], begin, "DOP853", times, rtol=1e-12, atol=1e-13)
    return found.y[2:].T.reshape(-1, 2, 2)


def test_coefficient_by_integration() -> None:
    """Assert the coefficient of an orbit at its doubling against differences of integrated maps, to 1e-6."""
    system = escape()
    point = per.trace(system, "F", (0.02, 0.2), watch=per.Watch(stop={"PD": 1}), tol=1e-9)[-1]
    Omega, grid = point.orbit.parameters["Omega"], point.orbit.grid
    forced = point.parameter, Omega, point.orbit.mesh.nodes(point.orbit.phases) / Omega
    x = point.orbit.state(np.zeros(1))[0]
    motions = integrated(x, *forced)
    A = motions[-1]
    (values, right), (others, left) = np.linalg.eig(A), np.linalg.eig(A.T)
    q, p = right[:, np.abs(values + 1).argmin()].real, left[:, np.abs(others + 1).argmin()].real
    assert np.abs(values + 1).min() < 1e-6
    q = q * point.orbit.span() / np.sqrt(grid.mean_weights @ ((motions @ q) ** 2).sum(axis=1))
    h = 3e-3
    maps = {k: integrated(x + k * h * q, *forced)[-1] for k in (-2, -1, 1, 2)}
    first = (maps[-2] - 8 * maps[-1] + 8 * maps[1] - maps[2]) / (12 * h)
    second = (-maps[-2] + 16 * maps[-1] - 30 * A + 16 * maps[1] - maps[2]) / (12 * h**2)
    expected = p @ (second @ q + 3 * first @ np.linalg.solve(np.eye(2) - A, first @ q)) / 6 / (p @ q)
    assert flip_coefficient(system, point.orbit) == pytest.approx(expected, rel=1e-6)


def test_linear_systems_have_none() -> None:
    """Assert no GPD along the doublings of a damped Mathieu equation, whose coefficient is rounding."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": -0.05 * x.v - (1 - 2 * p.depth * wave.cos) * x.x}

    names, values = {"x": 0.0, "v": 0.0}, {"depth": 0.2, "Omega": 1.9}
    system = sym.compile(sym.Equations(rates, names, values, frequency="Omega"))
    (doubling,) = per.trace(system, "Omega", (1.5, 1.9)).labelled("PD")
    held = {"Omega": per.DoublingCondition()}
    curve = per.trace(system, "depth", (0.1, 0.5), guess=doubling.orbit, determined=held)
    assert len(curve) > 5 and special(curve) == []
