"""Whether equations depend on the phase, and which methods take which systems."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.numpy_systems import LinearOscillator
from support.surfaces import Surfaces

from periodic.conditions import phase as conditions
from periodic.system import Kind
from periodic.system.events import Surface, check_continuous


class Turning:
    """x' = f(x + s tau) of two states, with an unknown; s: how far its unknowns shift with the phase."""

    algebraics = ("z",)

    def __init__(self, shift: float, force: float = 0.0) -> None:
        self.shift, self.force = shift, force

    def rest(self, parameter: Any) -> Any:
        """Rest away from 0."""
        return np.array([0.3, -0.2]), np.array([0.1])

    def linearise(self, rate: Any, state: Any, algebraic: Any, tau: Any, parameter: Any, free: Any) -> Any:
        """Derivatives of -sin(x + s tau) in the first row, of z - x in the last; the force in the second."""
        count, slope = len(tau), -np.cos(state[:, 0] + self.shift * tau)
        d_state, d_phase = np.zeros((count, 3, 2)), np.zeros((count, 3))
        d_state[:, 0, 0], d_phase[:, 0] = slope, self.shift * slope
        d_state[:, 1, 1], d_phase[:, 1] = 2.0, -self.force * np.sin(tau)
        d_state[:, 2, 0], d_phase[:, 2] = -1.0, -self.shift
        d_algebraic = np.zeros((count, 3, 1))
        d_algebraic[:, 2, 0] = 1.0
        return SimpleNamespace(d_state=d_state, d_phase=d_phase, d_algebraic=d_algebraic)


@pytest.mark.parametrize(
    ("shift", "force", "excited"),
    [(0.0, 0.0, False), (0.0, 1.0, True), (1.0, 0.0, False), (1.0, 1e-3, True), (2.0, 1e-11, False)],
)
def test_equations_that_depend_on_the_phase(shift: float, force: float, excited: bool) -> None:
    """Assert that a constant shift of an angle is no excitation, and a force is one, however small."""
    system: Any = Turning(shift, force)
    assert conditions.excited(system, np.zeros(0)) is excited


def test_excitation_of_a_linear_oscillator() -> None:
    """Assert it with its force, and none without."""
    assert conditions.excited(LinearOscillator(), LinearOscillator().nominal)
    free = LinearOscillator(F=0.0)
    assert not conditions.excited(free, free.nominal)


@pytest.mark.parametrize(
    ("kinds", "weights", "what"),
    [
        ([Kind.KINK], [[1.0]], ""),
        ([Kind.IMPACT], [[1.0]], "with impacts"),
        ([Kind.RELAY], [[1.0]], "with relays"),
        ([Kind.RELAY, Kind.IMPACT], [[1.0], [1.0]], "with impacts"),
        ([Kind.JUMP], [[1.0]], "whose equations jump"),
        ([Kind.JUMP], [[0.0]], ""),
    ],
)
def test_systems_that_a_blind_method_refuses(kinds: Any, weights: Any, what: str) -> None:
    """Assert the sentence; kinks are no jumps, and jumps at given phases bend all motions alike."""
    system: Any = Surfaces([Surface(kind, "s", k) for k, kind in enumerate(kinds)], weights)
    system.jumps = tuple(k for k, kind in enumerate(kinds) if kind == Kind.JUMP)
    if not what:
        check_continuous("Shooting()", system)
        return
    with pytest.raises(ValueError) as refused:
        check_continuous("Shooting()", system)
    assert str(refused.value) == f"method is Shooting(); for a system {what} it must be Collocation()"
