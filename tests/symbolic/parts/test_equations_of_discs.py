"""Equations of the first order written as a function: their rows, their sums with parts, what is refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from support.traces import FINE, duffing, fold_speeds

import periodic as per
import symbolic as sym

F = sym.functions


def residual(system: sym.CompiledSystem, rate: list[float], state: list[float], tau: float = 0.0) -> Any:
    """The scaled residual at one point, unknowns at 0.5."""
    unknown = np.full((1, len(system.algebraics)), 0.5)
    rows = (np.array([rate]), np.array([state]), unknown, np.array([tau]))
    return system.residual(*rows, system.nominal)[0]


def lorenz() -> sym.Equations:
    """Lorenz's equations."""
    return sym.Equations(
        lambda x, p: {
            "x": p.sigma * (x.y - x.x),
            "y": x.x * (p.rho - x.z) - x.y,
            "z": x.x * x.y - p.beta * x.z,
        },
        states={"x": 0.0, "y": 1.0, "z": 0.0},
        parameters={"sigma": 10.0, "rho": 28.0, "beta": 8 / 3},
        scales={"z": 10.0},
    )


def test_rows_parameters_and_rest() -> None:
    """Assert the residual omega x' - f of autonomous equations, over the states' scales."""
    system = sym.compile(lorenz())
    assert [p.name for p in system.parameters] == ["sigma", "rho", "beta", "omega"]
    assert [s.name for s in system.states] == [o.name for o in system.outputs] == ["x", "y", "z"]
    # SI: x = 2, y = 3, z = 40, their rates 1, 1, 10
    expected = [1 - 10 * (3 - 2), 1 - (2 * (28 - 40) - 3), (10 - (2 * 3 - 8 / 3 * 40)) / 10]
    assert residual(system, [1.0, 1.0, 1.0], [2.0, 3.0, 4.0]) == pytest.approx(expected, rel=1e-14)
    assert system.rest(system.nominal)[0] == pytest.approx([0, 1, 0])


def test_forced_equations_are_the_mechanical_model() -> None:
    """Assert the folds of Duffing's oscillator written as equations of the first order."""
    system = sym.compile(
        sym.Equations(
            lambda x, p, wave: {"x": x.v, "v": -0.1 * x.v - x.x - x.x**3 + p.F * wave.cos},
            states={"x": 0.0, "v": 0.0},
            parameters={"F": 0.5, "Omega": 1.0},
            frequency="Omega",
        )
    )
    branch = per.trace(system, "Omega", (0.3, 3.0), tol=FINE)
    assert fold_speeds(branch) == pytest.approx(fold_speeds(duffing(accuracy=FINE)), rel=1e-12)


def test_sine_of_the_excitation() -> None:
    """Assert that wave.sin and wave.cos are those of tau."""
    system = sym.compile(
        sym.Equations(
            lambda x, p, wave: {"x": wave.sin + 10 * wave.cos},
            states={"x": 0.0},
            parameters={"W": 2.0},
            frequency="W",
        )
    )
    assert residual(system, [0.0], [0.0], 0.3) == pytest.approx([-np.sin(0.3) - 10 * np.cos(0.3)])


def test_unknowns() -> None:
    """Assert that what is returned under an unknown's name is an algebraic row, and that it may bend."""
    system = sym.compile(
        sym.Equations(
            lambda x, p: {"x": x.v, "v": -F.sinh(x.z), "z": F.sinh(x.z) - x.x},
            states={"x": 0.0, "v": 0.0},
            unknowns={"z": 0.0},
            outputs=lambda x, p: {"force": F.sinh(x.z)},
        )
    )
    assert residual(system, [0.0, 0.0], [0.2, 0.0]) == pytest.approx([0, np.sinh(0.5), np.sinh(0.5) - 0.2])
    assert [o.name for o in system.outputs] == ["x", "v", "force"]


@pytest.mark.parametrize("order", [1, -1])
def test_sum_with_mechanical_parts(order: int) -> None:
    """Assert that equations push a mass, see where it is and how fast, and share a parameter with a part."""
    q, k = sym.coordinate("q"), sym.parameter("k", 3.0)
    feedback = sym.Equations(
        lambda x, p: {"u": p.k * x.q - x.u, "q": -2 * x.u + 5 * x.q_dot},
        states={"u": 0.0},
        parameters={"k": k},
        coordinates=[q],
        outputs=lambda x, p: {"speed": x.q_dot},
    )
    parts = [sym.Mass(q, 1.0), sym.Spring(q, k), feedback][::order]
    system = sym.compile(sym.combine(parts))
    eigenvalues = np.linalg.eigvals([[0, 1, 0], [-3, 5, -2], [3, 0, -1]])
    orbit = per.trace(system, "k", (3, 4), method=per.Equilibrium())[0]
    assert np.sort_complex(orbit.multipliers) == pytest.approx(np.sort_complex(eigenvalues), rel=1e-12)
    names = [o.name for o in system.outputs]
    assert sorted(names) == ["q", "speed", "u"]


def one(**changes: Any) -> Callable[[], object]:
    """The compilation of x' = -a x with some arguments changed."""
    arguments = {"function": lambda x, p: {"x": -p.a * x.x}, "states": {"x": 1.0}, "parameters": {"a": 1.0}}
    return lambda: sym.compile(sym.Equations(**{**arguments, **changes}))


@pytest.mark.parametrize(
    "make, sentence",
    [
        (one(function=lambda x, p: {"x": x.y}), "the equations use x.y; x has x"),
        (one(function=lambda x, p: {"x": p.b}), "the equations use p.b; p has a"),
        (one(function=lambda x, p: {}), "the function's result has no x; it must have x"),
        (
            one(function=lambda x, p: {"x": 0, "y": 0}),
            "the function's result has 'y'; it must be one of x",
        ),
        (
            one(function=lambda x, p: [x.x]),
            "function returned a list; it must return a mapping of names to expressions",
        ),
        (
            one(function=lambda x, p: {"x": "x"}),
            "function returned 'x' for 'x'; it must be one number or one expression",
        ),
        (one(function=lambda x: {"x": -x.x}), "function takes (x); it must take (x, p)"),
        (
            one(frequency="a"),
            "function takes (x, p); it must take (x, p, wave), as the system is forced",
        ),
        (
            one(resets=lambda x, p, wave: {}),
            "resets takes (x, p, wave); it must take (x, p)",
        ),
        (one(states={"x": np.nan}), "rest value of x is nan; it must be a finite number"),
        (one(scales={"x": 0.0}), "scale of x is 0.0; it must be a positive number"),
        (one(scales={"y": 1.0}), "scales has 'y'; it must be one of x"),
        (one(unknowns={"x": 1.0}), "'x' is the name of two variables; every one needs its own"),
        (one(states={"2x": 1.0}), "name of a variable is '2x'; it must be one that Python allows"),
        (one(frequency="W"), "frequency is 'W'; it must be one of the parameters a"),
        (
            one(parameters={"a": 1.0, "omega": 1.0}),
            "parameter 'omega' is 2 pi / period of the orbits of equations without excitation; "
            "name yours otherwise",
        ),
        (
            one(function=lambda x, p, wave: {"x": p.a}, frequency="a", parameters={"a": 0.0}),
            "the frequency of the excitation is 0.0 rad/s; its nominal value must be greater than 0",
        ),
    ],
)
def test_refused(make: Callable[[], object], sentence: str) -> None:
    """Assert that what does not fit is refused in one sentence."""
    with pytest.raises(ValueError) as caught:
        make()
    assert str(caught.value) == sentence


def test_two_equations_share_nothing_by_accident() -> None:
    """Assert that a state of the same name in two parts is refused."""
    with pytest.raises(ValueError, match="state 'x' is defined twice"):
        sym.compile(lorenz() + lorenz())


@pytest.mark.parametrize("number", [np.float64(2.0), np.array(2.0), 2])
def test_numbers_of_numpy_are_taken(number: Any) -> None:
    """Assert that a function may return a number as NumPy has it, also as an array without axes."""
    system = sym.compile(
        sym.Equations(
            lambda x, p, wave: {"x": number}, states={"x": 0.0}, parameters={"W": 1.0}, frequency="W"
        )
    )
    assert residual(system, [0.0], [0.0]) == pytest.approx([-2.0])
