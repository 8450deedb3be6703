"""Exact derivatives of compiled systems against fourth-order central differences."""

from collections.abc import Callable

import numpy as np
import pytest
from support.models import PARTS, REGIMES, Array, Disc, Points, draw, scene

import symbolic as sym

SCENES = [*PARTS]
CONTACTS = [n for n in PARTS if n not in ("duffing", "relaxation")]
CASES = [*((n, r) for n in CONTACTS for r in REGIMES), ("duffing", "touching"), ("relaxation", "touching")]


def differences(function: Callable[[Array], Array], at: Array, step: Array | float) -> Array:
    """Derivative in each column of `at` (last axis), stacked as the last axis of the result."""
    columns = []
    for k in range(at.shape[-1]):
        h = np.zeros(at.shape[-1])
        h[k] = np.broadcast_to(step, h.shape)[k]
        near = function(at + h) - function(at - h)
        far = function(at + 2 * h) - function(at - 2 * h)
        columns.append((8 * near - far) / (12 * h[k]))
    return np.stack(columns, axis=-1)


def assert_derivative(found: Array, expected: Array, unit: float = 1.0) -> None:
    """Compare to what differences can give: 1e-8 of each entry, and 1e-9 of the largest of its row."""
    size = np.abs(expected).max(axis=(0, -1), keepdims=True, initial=unit)
    assert found.shape == expected.shape
    assert (np.abs(found - expected) <= 1e-8 * np.abs(expected) + 1e-9 * size).all()


def numbered(system: sym.CompiledSystem) -> tuple[int, ...]:
    """All parameters of a system."""
    return tuple(range(len(system.parameters)))


def relative(parameter: Array) -> Array:
    """Steps in the parameters."""
    return 3e-4 * np.abs(parameter)


@pytest.mark.parametrize(("name", "regime"), CASES)
def test_derivatives_in_rates_states_and_unknowns(name: str, regime: str) -> None:
    """Assert that d_rate, d_state and d_algebraic are the derivatives of the residual."""
    system = scene(name)
    rate, state, xi, phase, p = draw(system, regime).arguments
    lines = system.linearise(rate, state, xi, phase, p)
    count = lines.residual.shape[1]
    assert_derivative(
        lines.d_rate, differences(lambda r: system.residual(r, state, xi, phase, p), rate, 3e-4)
    )
    assert_derivative(
        lines.d_state, differences(lambda x: system.residual(rate, x, xi, phase, p), state, 3e-4)
    )
    assert lines.d_algebraic.shape == (len(phase), count, len(system.algebraics))
    if system.algebraics:
        by_xi = differences(lambda z: system.residual(rate, state, z, phase, p), xi, 1e-3)
        assert_derivative(lines.d_algebraic, by_xi)


@pytest.mark.parametrize(("name", "regime"), CASES)
def test_derivative_in_phase(name: str, regime: str) -> None:
    """Assert that d_phase is the derivative of the residual."""
    system = scene(name)
    rate, state, xi, phase, p = draw(system, regime).arguments
    expected = differences(lambda t: system.residual(rate, state, xi, t[:, 0], p), phase[:, None], 1e-3)
    assert_derivative(system.linearise(rate, state, xi, phase, p).d_phase[:, :, None], expected)


@pytest.mark.parametrize(("name", "regime"), CASES)
def test_derivative_in_every_parameter(name: str, regime: str) -> None:
    """Assert that d_parameter is the derivative of the residual in each of the parameters."""
    system = scene(name)
    rate, state, xi, phase, p = draw(system, regime).arguments
    found = system.linearise(rate, state, xi, phase, p, numbered(system)).d_parameter
    expected = differences(lambda q: system.residual(rate, state, xi, phase, q), p, relative(p))
    for k in numbered(system):
        assert_derivative(found[:, :, [k]] * p[k], expected[:, :, [k]] * p[k])


@pytest.mark.parametrize("name", SCENES)
def test_residual_of_the_linearisation_is_the_residual(name: str) -> None:
    """Assert that linearise gives the residual that residual gives."""
    system = scene(name)
    arguments = draw(system).arguments
    found = system.linearise(*arguments).residual
    np.testing.assert_allclose(found, system.residual(*arguments), rtol=1e-13, atol=1e-13)


def test_free_parameters_are_chosen_by_index_and_in_order() -> None:
    """Assert that d_parameter holds the columns asked for, in the order asked for, and no other."""
    system = scene("squeeze")
    arguments = draw(system).arguments
    everything = system.linearise(*arguments, numbered(system)).d_parameter
    for free in ((), (5,), (7, 2), (2, 7)):
        found = system.linearise(*arguments, free).d_parameter
        np.testing.assert_allclose(found, everything[:, :, list(free)], rtol=1e-12)


@pytest.mark.parametrize(("name", "regime"), [c for c in CASES if c[0] != "duffing"])
def test_switch_gradient(name: str, regime: str) -> None:
    """Assert that switch_gradient holds the derivatives of the switches in state, phase and parameters."""
    system = scene(name)
    _, state, _, phase, p = draw(system, regime).arguments
    d_state, d_phase, d_parameter = system.switch_gradient(state, phase, p)
    assert_derivative(d_state, differences(lambda x: system.switch(x, phase, p), state, 3e-4))
    by_phase = differences(lambda t: system.switch(state, t[:, 0], p), phase[:, None], 1e-3)
    assert_derivative(d_phase[:, :, None], by_phase)
    by_parameter = differences(lambda q: system.switch(state, phase, q), p, relative(p))
    for k in numbered(system):
        assert_derivative(d_parameter[:, :, [k]] * p[k], by_parameter[:, :, [k]] * p[k])


def test_system_without_switch_has_empty_gradients() -> None:
    """Assert that the arrays of no switch have the shapes of no switch."""
    system = scene("duffing")
    points = draw(system, count=4)
    shapes = [a.shape for a in system.switch_gradient(points.state, points.phase, points.parameter)]
    assert shapes == [(4, 0, 2), (4, 0), (4, 0, len(system.parameters))]


@pytest.mark.parametrize("name", SCENES)
def test_batch_is_its_points_one_by_one(name: str) -> None:
    """Assert that a point's arrays do not depend on the batch it comes in, a batch of one included."""
    system = scene(name)
    rate, state, xi, phase, p = draw(system, count=5).arguments
    free = numbered(system)
    together = system.linearise(rate, state, xi, phase, p, free)
    for i in range(5):
        one = slice(i, i + 1)
        alone = system.linearise(rate[one], state[one], xi[one], phase[one], p, free)
        for array in ("residual", "d_rate", "d_state", "d_algebraic", "d_phase", "d_parameter"):
            expected = getattr(together, array)[one]
            np.testing.assert_allclose(getattr(alone, array), expected, rtol=1e-12, atol=1e-13)


def test_film_law_never_loses_its_derivative() -> None:
    """Assert that d(film law)/d xi stays of order one from deep contact to far out of it."""
    system = scene("squeeze")
    points = draw(system, count=9)
    xi = np.array([[-1e4], [-700.0], [-60.0], [-30.0], [0.0], [3.0], [40.0], [60.0], [100.0]])
    slope = system.linearise(points.rate, points.state, xi, points.phase, points.parameter).d_algebraic[
        :, 3, 0
    ]
    assert (slope * np.maximum(xi[:, 0], 1) > 0.5).all()


def bad(points: Points, which: int, column: int, value: float) -> Points:
    """The points with one column of one argument replaced."""
    arguments = [a.copy() for a in points.arguments]
    arguments[which][..., column] = value
    return Points(*arguments)


@pytest.mark.parametrize("name", SCENES)
def test_nan_in_an_argument_reaches_every_row_that_depends_on_it(name: str) -> None:
    """Assert that NaN is not swallowed: each row with a derivative in the entry becomes NaN, silently."""
    system = scene(name)
    points = draw(system)
    lines = system.linearise(*points.arguments)
    for which, derivative in enumerate((lines.d_rate, lines.d_state, lines.d_algebraic)):
        for k in range(derivative.shape[2]):
            spoilt = bad(points, which, k, np.nan)
            depends = (derivative[:, :, k] != 0).all(axis=0)
            for residual in (
                system.residual(*spoilt.arguments),
                system.linearise(*spoilt.arguments).residual,
            ):
                assert np.isnan(residual[:, depends]).all(), (("rate", "state", "algebraic")[which], k)


@pytest.mark.parametrize("value", [np.inf, -np.inf])
@pytest.mark.parametrize("name", ["quasistatic", "squeeze", "two discs, squeeze", "duffing"])
def test_infinite_argument_gives_no_finite_residual(name: str, value: float) -> None:
    """Assert that an infinite rate, state or unknown leaves no residual finite, and without a warning."""
    system = scene(name)
    points = draw(system)
    for which in range(3):
        for k in range(points.arguments[which].shape[1]):
            spoilt = bad(points, which, k, value)
            for residual in (
                system.residual(*spoilt.arguments),
                system.linearise(*spoilt.arguments).residual,
            ):
                assert not np.isfinite(residual).all(axis=1).any(), (which, k)


@pytest.mark.parametrize("film", ["quasistatic", "squeeze", None])
def test_absurd_numbers_warn_nowhere(film: str | None) -> None:
    """Assert that negative films, overflow and NaN phases pass through every evaluation without a warning.

    Warnings are errors in tests. Both ways to the residual give the same numbers, NaN included.
    """
    system = Disc(film=film).compile()
    for value in (-1e300, -1.0, 0.0, 1e300, np.nan, np.inf):
        rate, state, xi, phase, p = (np.full_like(a, value) for a in draw(system).arguments)
        for parameter in (system.nominal, p):
            lines = system.linearise(rate, state, xi, phase, parameter, numbered(system))
            residual = system.residual(rate, state, xi, phase, parameter)
            np.testing.assert_array_equal(lines.residual, residual)
            count = len(phase)
            assert system.output(rate, state, xi, phase, parameter).shape == (count, len(system.outputs))
            assert system.switch(state, phase, parameter).shape == (count, len(system.switches))
            assert system.switch_gradient(state, phase, parameter)[1].shape == (count, len(system.switches))
            assert system.move(xi, xi).shape == xi.shape
