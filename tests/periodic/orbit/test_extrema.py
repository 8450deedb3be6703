"""Extremes of outputs along orbits that are functions, and how far those of a better orbit are from them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.numpy_systems import Array, Quantity
from support.surfaces import along

from periodic.orbit.extrema import Extremes, apart, extrema
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit


class Outputs:
    """A system of one state x that tells x and some functions of it and of the phase."""

    states = (Quantity("x"),)
    algebraics: tuple[Quantity, ...] = ()
    parameters = (Quantity("Omega", value=1.0),)
    switches: tuple[Any, ...] = ()
    nominal = np.ones(1)

    def __init__(self, **functions: Any) -> None:
        self.functions = functions
        self.outputs = (Quantity("x"), *(Quantity(name) for name in functions))

    def rest(self, parameter: Array) -> tuple[Array, Array]:
        """The state is 0."""
        return np.zeros(1), np.zeros(0)

    def linearise(self, *given: Any) -> Any:
        """There are no equations."""
        raise NotImplementedError

    def output(self, rate: Array, state: Array, algebraic: Array, phase: Array, parameter: Array) -> Array:
        """The state, and what is asked for."""
        given = state[:, 0], rate[:, 0], phase
        return np.column_stack([state[:, 0], *(function(*given) for function in self.functions.values())])


def orbit(height: float = 1.0, nodes: Any = ()) -> Orbit:
    """x = height sin tau."""
    return along(lambda tau: height * np.sin(tau)[:, None], nodes)


def test_extremes_of_outputs() -> None:
    """Assert those of sin, of its square and of its rate, and where they are."""
    system: Any = Outputs(square=lambda x, v, tau: x**2, rate=lambda x, v, tau: 3 * v - 1)
    found = extrema(system, orbit())
    assert found.minimum == pytest.approx([-1.0, 0.0, -4.0], abs=1e-6)
    assert found.maximum == pytest.approx([1.0, 1.0, 2.0], abs=1e-6)
    assert found.maximum_phase[0] % (2 * np.pi) == pytest.approx(np.pi / 2, abs=1e-4)
    assert found.minimum_phase[0] % (2 * np.pi) == pytest.approx(3 * np.pi / 2, abs=1e-4)
    assert found.minimum_phase[2] % (2 * np.pi) == pytest.approx(np.pi, abs=1e-4)
    assert abs(np.sin(found.minimum_phase[1])) < 1e-3


def test_extremes_of_an_equilibrium() -> None:
    """Assert its values at phase 0."""
    rest = along(lambda tau: np.full((len(tau), 1), 0.25), intervals=4)
    system: Any = Outputs(square=lambda x, v, tau: x**2)
    found = extrema(system, rest)
    assert found.minimum == pytest.approx([0.25, 0.0625]) and found.maximum == pytest.approx([0.25, 0.0625])


@pytest.mark.parametrize(
    ("minimum", "maximum", "expected"),
    [
        (0.0, 1.0, 0.0),
        (0.2, 1.0, 0.2 / 0.8),
        (0.0, 0.9, 0.1 / 0.9),
        (0.2, 0.9, 0.2 / 0.7),
        (0.1, 0.7, 0.3 / 0.6),
    ],
)
def test_extremes_of_a_better_orbit(minimum: float, maximum: float, expected: float) -> None:
    """Assert how far its values are at both phases, the larger over the peak to peak; states do not count."""
    system: Any = Outputs(square=lambda x, v, tau: x**2)
    found = Extremes(
        np.array([9.0, minimum]), np.array([-9.0, maximum]), np.zeros(2), np.array([0.0, np.pi / 2])
    )
    assert apart(system, orbit(), found, orbit) == pytest.approx(expected, abs=1e-9)


def test_largest_of_several_outputs() -> None:
    """Assert that of the output whose extremes are farthest off."""
    system: Any = Outputs(a=lambda x, v, tau: x, b=lambda x, v, tau: 2 * x)
    found = Extremes(
        np.array([0.0, -1.0, -2.0]),
        np.array([0.0, 1.1, 2.8]),
        np.full(3, 3 * np.pi / 2),
        np.full(3, np.pi / 2),
    )
    assert apart(system, orbit(), found, orbit) == pytest.approx(max(0.1 / 2.1, 0.8 / 4.8), rel=1e-6)


def test_states_alone_are_not_compared() -> None:
    """Assert 0, without the better orbit."""
    system: Any = Outputs()
    found = Extremes(*(np.zeros(1) for _ in range(4)))
    assert apart(system, orbit(), found, lambda: pytest.fail("not needed")) == 0.0


def test_outputs_that_do_not_move() -> None:
    """Assert the difference over a millionth of their size, and over 1 where they are 0."""
    system: Any = Outputs(a=lambda x, v, tau: 0 * x + 2.0)
    found = Extremes(np.array([0.0, 2.0]), np.array([0.0, 2.0 + 1e-9]), np.zeros(2), np.zeros(2))
    assert apart(system, orbit(), found, orbit) == pytest.approx(1e-9 / 2e-6, rel=1e-3)
    none: Any = Outputs(a=lambda x, v, tau: 0 * x)
    zero = Extremes(*(np.zeros(2) for _ in range(4)))
    assert apart(none, orbit(), zero, orbit) == 0.0


@pytest.mark.parametrize("late", [0.02, -0.02])
def test_outputs_that_jump_at_events(late: float) -> None:
    """Assert that an output which jumps where the better orbit's event is later is compared beside it too."""
    system: Any = Outputs(step=lambda x, v, tau: np.where(np.mod(tau, 2 * np.pi) < 1.0 + late, 1.0, 0.0))
    one, other = orbit(nodes=[(EventNode(0, 1), 1.0)]), orbit(nodes=[(EventNode(0, 1), 1.0 + 1.5 * late)])
    found = Extremes(np.zeros(2), np.ones(2), np.array([0.0, 1.01]), np.array([0.0, 0.99]))
    assert apart(system, one, found, lambda: other) == 0.0
    assert apart(system, one, found, lambda: one) == (1.0 if late else 0.0)
