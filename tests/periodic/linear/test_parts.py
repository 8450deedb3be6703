"""Elimination and subspaces, of small matrices: against direct solutions and values by hand."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.linear import bordered, kinematic, pairwise
from periodic.linear.invariantpair import subspaces, within
from periodic.system.precision import difference_step


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7])
def test_chain_from_both_ends(count: int) -> None:
    """Assert that mesh points follow from the ends as by dx_{j+1} = S_j (1, dx_j, dy)."""
    random = np.random.default_rng(count)
    n, q = 2, 1
    step = random.standard_normal((count, n, 1 + n + q))
    found = pairwise.reduce(step)
    points = [random.standard_normal(n)]
    dy = np.array([0.7])
    for own in step:
        points.append(own @ np.concatenate([[1.0], points[-1], dy]))
    given = np.concatenate([[1.0], points[0], points[-1], dy])
    assert found.ends @ given == pytest.approx(np.zeros(n), abs=1e-10)
    assert found.maps @ given == pytest.approx(np.array(points), abs=1e-9)


def test_chain_of_motions_that_grow_by_decades() -> None:
    """Assert that a chain of numbers 10^4 keeps the points between ends 1 and 10^40.

    To eps 10^8, the square of what an interval grows by: two intervals are joined at a time.
    """
    step = np.zeros((10, 1, 2))
    step[:, 0, 1] = 1e4
    points = (pairwise.reduce(step).maps @ np.array([0.0, 1.0, 1e40]))[:, 0]
    assert points == pytest.approx(10.0 ** (4 * np.arange(11)), rel=1e-7)


def test_equations_closed_by_side_conditions() -> None:
    """Assert 2 u_1 + u_2 = -3 s and u_1 - u_2 = b - s for s = 1, b = 0 and s = 0, b = 3, by hand."""
    rows = np.array([[3.0, 2.0, 1.0], [1.0, 1.0, -1.0]])
    found = bordered.solve(rows, np.array([[1.0, 0.0], [0.0, 3.0]]))
    assert found[:, 0] == pytest.approx([-4 / 3, -1 / 3])
    assert found[:, 1] == pytest.approx([1.0, -2.0])
    with pytest.raises(np.linalg.LinAlgError):
        bordered.solve(np.array([[0.0, 1.0, 1.0], [0.0, 1.0, 1.0]]), np.array([[1.0], [0.0]]))


def chain_of(n: int, ncol: int = 3, count: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """R_x' and R_x of n/2 positions q' = v and velocities v' = -K q - C v."""
    random = np.random.default_rng(n)
    half = n // 2
    by_rate, by_state = np.zeros((2, count, ncol, n, n))
    by_rate[..., :half, :half] = np.eye(half)
    by_rate[..., half:, half:] = np.eye(half) + 0.1 * random.standard_normal((half, half))
    by_state[..., :half, half:] = -np.eye(half)
    by_state[..., half:, :] = random.standard_normal((half, n))
    return by_rate, by_state


def test_kinematic_rows_are_found() -> None:
    """Assert the rows, positions and velocities of 4 masses; none of 3, and of those not coupled singly."""
    found = kinematic.kinematic(*chain_of(8))
    assert found is not None
    assert found.rows.tolist() == found.positions.tolist() == [0, 1, 2, 3]
    assert found.velocities.tolist() == [4, 5, 6, 7]
    assert found.other_rows.tolist() == found.other_states.tolist() == [4, 5, 6, 7]
    assert kinematic.kinematic(*chain_of(6)) is None
    by_rate, by_state = chain_of(8)
    by_state[..., 1, 0] = 0.5
    less = kinematic.kinematic(by_rate, by_state)
    assert less is not None and less.rows.tolist() == [0, 2, 3]


def test_stages_by_kinematic_rows() -> None:
    """Assert the solution of (R_x' D + R_x) X = -r against the whole system, to rounding."""
    by_rate, by_state = chain_of(8)
    count, ncol, n = by_rate.shape[:3]
    random = np.random.default_rng(0)
    weights = np.eye(ncol) + 0.3 * random.standard_normal((count, ncol, ncol))
    right = random.standard_normal((count, ncol, n, 2))
    found = kinematic.kinematic(by_rate, by_state)
    assert found is not None
    stages = kinematic.solve(found, by_rate, by_state, right, weights)
    for j in range(count):
        rates = np.einsum("kl,lnw->knw", weights[j], stages[j])
        left = np.einsum("knm,kmw->knw", by_rate[j], rates) + np.einsum(
            "knm,kmw->knw", by_state[j], stages[j]
        )
        assert left == pytest.approx(-right[j], abs=1e-10)


@pytest.mark.parametrize("pair", [(2.0, 0.5), (1.2 + 0.3j, 1.2 - 0.3j)])
def test_subspace_of_two_eigenvalues(pair: tuple[complex, complex]) -> None:
    """Assert bases of both sides with left.T right = I that hold just these eigenvalues."""
    random = np.random.default_rng(2)
    block = np.diag([2.0, 0.5]) if pair[0].imag == 0 else np.array([[1.2, 0.3], [-0.3, 1.2]])
    whole = np.zeros((4, 4))
    whole[:2, :2], whole[2:, 2:] = block, np.diag([-0.3, 0.1])
    turn = np.eye(4) + 0.3 * random.standard_normal((4, 4))
    matrix = np.linalg.solve(turn, whole @ turn)
    values = np.linalg.eigvals(matrix)
    which = [int(np.abs(values - value).argmin()) for value in pair]
    right, left = subspaces(matrix, which, values)
    assert left.T @ right == pytest.approx(np.eye(2), abs=1e-12)
    small = left.T @ matrix @ right
    assert matrix @ right == pytest.approx(right @ small, abs=1e-12)
    assert np.sort_complex(np.linalg.eigvals(small)) == pytest.approx(
        np.sort_complex(np.array(pair)), abs=1e-10
    )


def test_vectors_nearest_to_a_subspace() -> None:
    """Assert the two that lie in the plane of the first two axes, but for 0.1."""
    basis = np.eye(3)[:, :2]
    vectors = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.1], [0.6, 0.8, 0.0]]).T
    assert within(basis, vectors / np.linalg.norm(vectors, axis=0)) == [1, 2]


def test_steps_of_differences() -> None:
    """Assert eps^(1/3) of central first differences, and noise^(1/4) of second ones."""
    assert difference_step(2) == pytest.approx(np.finfo(float).eps ** (1 / 3))
    assert difference_step(2, 2, 1e-8) == pytest.approx(1e-2)
