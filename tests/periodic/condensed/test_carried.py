"""Own states that follow from forces one by one: eliminated, they are those of the whole equations."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.condensed.carried import Carried
from periodic.orbit.scheme import Array, Scheme

COUNT, POINTS, FORCES, OWN, GIVEN = 3, 4, 2, 3, 5
N = 6
OTHERS = np.array([1, 3, 4])
"""Which of N states are own ones."""


def rows() -> Array:
    """Rows of forces, then of own states, each own state with its rate in its own row alone."""
    given = np.random.default_rng(3).normal(size=(COUNT, POINTS, FORCES + OWN, 1 + 2 * N + GIVEN))
    rate, state = 1 + OTHERS, 1 + N + OTHERS
    given[..., rate] = 0.0
    given[:, :, FORCES:, state] = 0.0
    for k in range(OWN):
        given[:, :, FORCES + k, rate[k]] = 1.0 + k
        given[:, ::2, FORCES + k, state[k]] = 0.5 - k
    return np.asarray(given)


def test_forces_and_states_are_those_of_the_whole_equations() -> None:
    """Assert the solution of all rows at once, to rounding."""
    given, draw = rows(), np.random.default_rng(4)
    block = draw.normal(size=(COUNT, POINTS, FORCES + OWN, POINTS * FORCES))
    right = draw.normal(size=(COUNT, POINTS, FORCES + OWN, GIVEN))
    width, rates = np.array([0.1, 0.2, 0.4]), Scheme().stage_rates[:, 1:]
    points = len(rates)
    assert points == POINTS
    carried = Carried.of(given, OTHERS, N, FORCES)
    assert carried is not None
    found = carried.solved(block, right, rates, width)
    inside = given[..., 1 + OTHERS][:, :, :, None, :] * (rates / width[:, None, None])[:, :, None, :, None]
    for point in range(POINTS):
        inside[:, point, :, point] += given[:, point, :, 1 + N + OTHERS].transpose(1, 2, 0)
    whole = np.concatenate([block, inside.reshape(COUNT, POINTS, FORCES + OWN, -1)], axis=3)
    size = POINTS * (FORCES + OWN)
    expected = np.linalg.solve(whole.reshape(COUNT, size, size), -right.reshape(COUNT, size, GIVEN))
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-11)


@pytest.mark.parametrize(
    ("row", "column"),
    [(FORCES, 1 + OTHERS[1]), (0, 1 + OTHERS[0]), (FORCES, 1 + N + OTHERS[2])],
    ids=["a rate in another one's row", "a rate in a force", "another own state"],
)
def test_own_states_that_depend_on_each_other_are_solved_for_at_once(row: int, column: int) -> None:
    """Assert none where they are coupled, in one row at one point."""
    given = rows()
    given[1, 2, row, column] = 0.1
    assert Carried.of(given, OTHERS, N, FORCES) is None
