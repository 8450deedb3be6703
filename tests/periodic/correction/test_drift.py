"""States that nothing holds."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.correction import drift
from periodic.correction.drift import AWAY, FREE_MOTION, PHASES, TAKES_PART, drifting


def system(stiffness: Callable[[Any], Any], states: int = 2, unknowns: int = 0) -> Any:
    """A system of states x0, x1, ... at rest at 1, 1, ..., whose stiffness is a function of the place."""

    def linearise(rate: Any, state: Any, algebraic: Any, phase: Any, parameter: Any) -> Any:
        assert not rate.any() and np.array_equal(phase, PHASES) and (algebraic == 7.0).all()
        found = np.array([stiffness(place) for place in state])
        return SimpleNamespace(d_state=found[:, :, :states], d_algebraic=found[:, :, states:])

    return SimpleNamespace(
        rest=lambda parameter: (np.ones(states), np.full(unknowns, 7.0)),
        states=[SimpleNamespace(name=f"x{k}") for k in range(states)],
        linearise=linearise,
    )


def tied(spring: float) -> Any:
    """Two masses that are tied to each other, the first to the ground by a spring."""
    return np.array([[1.0 + spring, -1.0], [-1.0, 1.0]])


def test_masses_that_drift_together() -> None:
    """Assert that both are named where nothing holds them, and none where a spring does."""
    assert drifting(system(lambda place: tied(0.0)), np.ones(1)) == ["x0", "x1"]
    assert drifting(system(lambda place: tied(1e-3)), np.ones(1)) == []


@pytest.mark.parametrize("unit", [1.0, 1e6])
@pytest.mark.parametrize(("least", "named"), [(0.5, ["x1"]), (2.0, [])])
def test_what_counts_as_held(least: float, named: list[str], unit: float) -> None:
    """Assert the ratio of the least singular value to the largest, whatever their unit."""
    stiffness = np.diag([unit, least * FREE_MOTION * unit])
    assert drifting(system(lambda place: stiffness), np.ones(1)) == named


@pytest.mark.parametrize(("part", "named"), [(0.9, ["x1"]), (1.1, ["x0", "x1"])])
def test_states_that_take_part(part: float, named: list[str]) -> None:
    """Assert that a state drifts that moves by more than a part of the most: x0 = part TAKES_PART x1."""
    row = np.array([[1.0, -part * TAKES_PART], [0.0, 0.0]])
    assert drifting(system(lambda place: row), np.ones(1)) == named


def test_what_is_held_at_one_place_is_held() -> None:
    """Assert that a spring without stiffness at rest holds; at rest and away from it it is looked at."""
    places: list[Any] = []

    def cubic(place: Any) -> Any:
        places.append(place)
        return np.diag([1.0, (place[1] - 1.0) ** 2])

    assert drifting(system(cubic), np.ones(1)) == []
    assert np.array_equal(places[0], [1.0, 1.0]) and len(places) == len(PHASES)
    for k, place in enumerate(places[1:], 1):
        assert place == pytest.approx([1.0 + AWAY * np.sin(1.0 + k)] * 2, rel=1e-12)


def test_unknowns_hold_and_are_not_named() -> None:
    """Assert that an unknown of a row holds a state, and that one that is free is no state that drifts."""
    held = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
    assert drifting(system(lambda place: held, unknowns=1), np.ones(1)) == []
    free = np.array([[1.0, 0.0, 0.0], [0.0, 1e-13, 0.0], [0.0, 0.0, 1.0]])
    assert drifting(system(lambda place: free, unknowns=1), np.ones(1)) == ["x1"]


def test_stiffness_that_is_no_number_names_nothing() -> None:
    """Assert none where it is infinite."""
    assert drifting(system(lambda place: np.diag([1.0, np.inf])), np.ones(1)) == []
    assert drift.PHASES[1] == pytest.approx(np.pi / 2) and drift.PHASES[-1] == pytest.approx(1.5 * np.pi)
