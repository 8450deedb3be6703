"""How modes change with the speed: against the derivative of the dynamic flexibility."""

from __future__ import annotations

import numpy as np
import pytest

import symbolic as sym
from symbolic.arrays import Complex
from symbolic.structures.modalslope import modal_slope


def flexibility(parts: tuple[Complex, Complex, Complex], frequency: complex) -> Complex:
    """What modes with exponents, shapes and inputs make of forces exp(s t), both of each pair."""
    total = 0.0
    for exponents, shapes, inputs in (parts, tuple(part.conj() for part in parts)):
        total = total + shapes / 2 @ (inputs / (frequency - exponents)[:, None])
    return np.asarray(total)


@pytest.mark.parametrize("kind", ["gyroscopic", "damped", "loaded"])
def test_flexibility_changes_as_its_matrices_do(kind: str) -> None:
    """Assert dH = -H (s^2 M' + s C' + K') H to 8 digits, of gyroscopic terms alone, also beside Rayleigh
    damping, and of all matrices."""
    n, speed, step = 4, 3.0, 1e-4
    random = np.random.default_rng(3)
    one, two, three, four = random.standard_normal((4, n, n))
    mass, stiffness, gyroscopic = np.eye(n) + 0.1 * one @ one.T, 9 * np.eye(n) + two @ two.T, four - four.T
    damping = 0.2 * np.eye(n) + 0.05 * three @ three.T
    if kind == "loaded":
        structure = sym.Structure(
            lambda w: mass * (1 + 0.01 * w),
            lambda w: damping + 0.02 * w * three,
            lambda w: stiffness + w * one,
        )
        slopes = 0.01 * mass, 0.02 * three, one
    else:
        more = {"rayleigh": (0.05, 0.01)} if kind == "damped" else {}
        structure = sym.Structure(mass, damping, stiffness, gyroscopic, **more)  # type: ignore[arg-type]
        slopes = np.zeros((n, n)), gyroscopic, np.zeros((n, n))
    form, slope = structure.modal(speed), structure.modal_slope(speed)
    assert slope is not None
    names = ("exponents", "shapes", "inputs")
    ends = [
        flexibility(
            tuple(getattr(form, name) + sign * step * getattr(slope, name) for name in names), 0.1 + 2.3j
        )
        for sign in (1, -1)
    ]
    value = flexibility(tuple(getattr(form, name) for name in names), 0.1 + 2.3j)
    dynamic = (0.1 + 2.3j) ** 2 * slopes[0] + (0.1 + 2.3j) * slopes[1] + slopes[2]
    exact = -value @ dynamic @ value
    assert np.abs((ends[0] - ends[1]) / (2 * step) - exact).max() < 1e-7 * np.abs(exact).max()


def test_modes_damped_one_by_one_are_left_to_differences() -> None:
    """Assert that no closed form is given where a ratio of each mode's damping changes with the speed."""
    structure = sym.Structure(np.eye(2), None, lambda w: np.diag([4.0, 9.0]) + w, damping=0.01)
    assert structure.modal_slope(1.0) is None
    turned = np.array([[0.0, 1.0], [-1.0, 0.0]])
    coupled = sym.Structure(np.eye(2), None, lambda w: np.diag([4.0, 9.0]) + w, turned, damping=0.01)
    assert coupled.modal(1.0).own and coupled.modal_slope(1.0) is None


@pytest.mark.parametrize("damping", [{}, {"rayleigh": (0.0, 1e-3)}])
def test_rotor_whose_modes_meet_in_pairs(damping: dict[str, tuple[float, float]]) -> None:
    """Assert that modes of a rotor alike in both planes are followed, with Rayleigh damping or without.

    At rest each is double; discs that do not tilt leave some so at any speed.
    """
    turned = np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.diag([0.0, 0.3]))
    stiffness = np.kron(np.eye(2), np.array([[4.0, 0.0], [0.0, 9.0]]))
    rotor = sym.Structure(np.eye(4), 0.01 * np.eye(4), stiffness, turned, **damping)  # type: ignore[arg-type]
    slope = rotor.modal_slope(2.0)
    assert slope is not None
    step = 1e-5
    ends = [rotor.modal(2.0 + sign * step).exponents for sign in (1, -1)]
    found = [
        min(abs(e - value) for e in ends[0]) for value in rotor.modal(2.0).exponents + step * slope.exponents
    ]
    assert max(found) < 1e-8


@pytest.mark.parametrize("size", [1e-12, 1e-5, 1e4])
def test_slopes_are_proportional_to_the_change(size: float) -> None:
    """Assert that matrices that change so many times as fast change the modes as many times as fast."""
    random = np.random.default_rng(5)
    one, two = random.standard_normal((2, 3, 3))
    form = sym.Structure(np.eye(3), 0.1 * np.eye(3), 9 * np.eye(3) + one @ one.T).modal(1.0)
    nothing = np.zeros((3, 3))
    once, more = (modal_slope(form, nothing, nothing, factor * two) for factor in (1.0, size))
    for name in ("exponents", "shapes", "inputs"):
        expected = size * getattr(once, name)
        assert np.abs(getattr(more, name) - expected).max() < 1e-10 * np.abs(expected).max()


@pytest.mark.parametrize("coupled", [False, True])
def test_modes_that_meet(coupled: bool) -> None:
    """Assert that modes of one frequency are followed where they do not couple, and refused where they do."""
    form = sym.Structure(np.eye(2), 0.1 * np.eye(2), 4 * np.eye(2)).modal(1.0)
    change = np.array([[3.0, 2.0], [2.0, -1.0]]) if coupled else np.diag([3.0, -1.0])
    nothing = np.zeros((2, 2))
    if coupled:
        with pytest.raises(ArithmeticError, match="cannot be followed in the speed: two of them meet$"):
            modal_slope(form, nothing, nothing, change)
        return
    found = modal_slope(form, nothing, nothing, change)
    expected = 1j * np.array([3.0, -1.0]) / (2 * np.sqrt(4 - 0.05**2))
    assert np.sort_complex(found.exponents) == pytest.approx(np.sort_complex(expected), rel=1e-9)
