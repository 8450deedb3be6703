"""Modes that are left out: which, what stands for them, and how that changes, by differences."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.condensed.modal.quasistatic import SHARE, Modes, reduced, reduced_slope, retained_modes


def along(step: float) -> Modes:
    """Modes of 5 exponents, 2 forces and 3 states that all depend on a parameter, in a straight line."""
    source = np.random.default_rng(4)

    def changing(*shape: int) -> np.ndarray:
        a, b = source.standard_normal((2, *shape, 2)) @ [1.0, 1.0j]
        return np.asarray(a + step * b)

    exponents = changing(5) + 30 * np.arange(1, 6)
    outputs, inputs = changing(3, 5), changing(5, 2)
    direct, rate = changing(3, 2).real, changing(3, 2).real
    return Modes(exponents, inputs, outputs, direct, rate)


def test_derivative_of_what_is_kept_and_left_out() -> None:
    """Assert the derivative of the reduced modes by central differences, to 7 digits."""
    step, kept = 1e-5, np.array([True, False, True, False, False])
    names = ("exponents", "inputs", "outputs", "direct", "direct_rate")
    before, after = along(-step), along(step)
    slope = Modes(*((getattr(after, n) - getattr(before, n)) / (2 * step) for n in names))
    found = reduced_slope(along(0.0), slope, kept)
    ends = reduced(before, kept), reduced(after, kept)
    for name in names:
        exact = (getattr(ends[1], name) - getattr(ends[0], name)) / (2 * step)
        assert getattr(found, name) == pytest.approx(exact, rel=1e-7, abs=1e-9)


def test_slow_forces_are_followed() -> None:
    """Assert the answer of all modes to a force exp(s tau) to the second order in s over the exponents."""
    modes, kept = along(0.0), np.array([True, True, False, False, False])
    part, errors = reduced(modes, kept), []

    def answer(of: Modes, s: float) -> np.ndarray:
        free = of.outputs @ (of.inputs / (s - of.exponents[:, None]))
        return np.asarray(free.real + of.direct + s * of.direct_rate)

    for s in (0.4, 0.2, 0.1):
        errors.append(np.abs(answer(modes, s) - answer(part, s)).max())  # type: ignore[arg-type]
    assert errors[0] / errors[1] == pytest.approx(4, abs=0.1)
    assert errors[1] / errors[2] == pytest.approx(4, abs=0.1)


def test_which_are_left_out() -> None:
    """Assert that fast modes go whose static share, the weakest first, is a tenth of the tolerance."""
    exponents = np.array([-1.0, -100.0, -200.0, -400.0]) + 5j
    outputs = np.abs(exponents) * np.array([[1e-9, 1.0, 2e-4, 1e-4]])
    modes = Modes(exponents, np.ones((4, 1), complex), outputs + 0j, np.zeros((1, 1)), np.zeros((1, 1)))
    for least, expected in ((3.1e-4, [1, 1, 0, 0]), (2.9e-4, [1, 1, 1, 0]), (0.9e-4, [1, 1, 1, 1])):
        found = retained_modes(modes, [0], 2 * np.pi, least / SHARE)
        assert found.tolist() == [bool(kept) for kept in expected]
