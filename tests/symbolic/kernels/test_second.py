"""Gradients of outputs and contracted second derivatives against differences of exact first derivatives."""

from collections.abc import Callable

import numpy as np
import pytest
from support.kernels import forms
from support.models import PARTS, Array, draw, scene

import symbolic as sym


def contracted(system: sym.CompiledSystem, given: tuple[Array, ...], *at: Array) -> Array:
    """w . (R_x' v_x' + R_x v_x + R_z v_z + R_p v_p) at each point, from the first derivatives."""
    weights, v_rate, v_state, v_algebraic, v_parameter = given
    line = system.linearise(*at, tuple(range(len(system.parameters))))  # type: ignore[call-arg, arg-type]
    moved = np.einsum("prn,pn->pr", line.d_rate, v_rate) + np.einsum("prn,pn->pr", line.d_state, v_state)
    moved += np.einsum("prm,pm->pr", line.d_algebraic, v_algebraic) + line.d_parameter @ v_parameter
    return np.asarray((weights * moved).sum(axis=1))


def difference(function: Callable[[float], Array], step: float) -> Array:
    """Fourth-order central difference at 0."""
    near, far = function(step) - function(-step), function(2 * step) - function(-2 * step)
    return (8 * near - far) / (12 * step)


@pytest.mark.parametrize("name", PARTS)
def test_curvature_is_the_derivative_of_the_contraction(name: str) -> None:
    """Assert the gradient in rates, states, unknowns, phase and parameters to 1e-7 of its largest part."""
    system = scene(name)
    at, given = draw(system).arguments, forms(system)
    found = system.curvature(*at, *given)
    columns = [found.rate, found.state, found.algebraic, found.phase[:, None], found.parameter]
    for k, gradient in enumerate(columns):
        units = np.abs(at[k]) if k == 4 else np.ones(gradient.shape[1])
        for j in range(gradient.shape[1]):

            def moved(h: float, k: int = k, j: int = j, unit: float = float(units[j])) -> Array:
                changed = [a.copy() for a in at]
                changed[k][..., j if k != 3 else slice(None)] += h * unit
                return contracted(system, given, *changed)

            expected = difference(moved, 1e-3)
            size = max(1.0, np.abs(expected).max())
            assert gradient[:, j] * units[j] == pytest.approx(expected, abs=1e-7 * size, rel=1e-7)


@pytest.mark.parametrize("name", PARTS)
def test_gradient_of_outputs(name: str) -> None:
    """Assert values and derivatives of the outputs in states and in two parameters against differences."""
    system = scene(name)
    rate, state, algebraic, phase, parameter = draw(system).arguments
    free = tuple(sorted({0, len(parameter) - 1}, reverse=True))
    found = system.output_gradient(rate, state, algebraic, phase, parameter, free)
    np.testing.assert_allclose(found.residual, system.output(rate, state, algebraic, phase, parameter))
    size = np.maximum(np.abs(found.residual).max(axis=0), 1e-12)
    for j in range(state.shape[1]):

        def by_state(h: float, j: int = j) -> Array:
            return system.output(rate, state + h * np.eye(state.shape[1])[j], algebraic, phase, parameter)

        assert np.abs((found.d_state[:, :, j] - difference(by_state, 1e-3)) / size).max() < 1e-11
    for column, k in enumerate(free):

        def by_value(h: float, k: int = k) -> Array:
            changed = parameter * (1 + h * np.eye(len(parameter))[k])
            return system.output(rate, state, algebraic, phase, changed)

        change = found.d_parameter[:, :, column] * parameter[k]
        assert np.abs((change - difference(by_value, 1e-3)) / size).max() < 1e-11
