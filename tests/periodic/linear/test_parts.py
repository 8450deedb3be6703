"""Elimination and subspaces, of small matrices: against direct solutions and values by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.equilibrium.linearise import Constant
from periodic.linear import bordered, bordering, kinematic, pairwise
from periodic.linear.bordering import Chain
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


def chained(step: np.ndarray, origin: list[int] | None = None, **more: Any) -> Chain:
    """Equations with these steps, of an orbit without event nodes."""
    count = len(step)
    orbit = SimpleNamespace(phases=np.zeros(0), end_rates=np.arange(count + 1.0)[:, None])
    own = np.arange(count) if origin is None else np.array(origin)
    given: Any = SimpleNamespace(step=step, origin=own, orbit=orbit, compiled=None, residual=0.5, **more)
    return Chain(given)


def test_effect_of_parameters_over_a_period() -> None:
    """Assert the largest in an interval times the intervals that follow each other, of two parameters."""
    step = np.zeros((4, 1, 1 + 1 + 2))
    step[:, 0, :2] = 9.0
    step[1, 0, 2:], step[3, 0, 2:] = (-3.0, 0.5), (1.0, -2.0)
    assert chained(step).effect.tolist() == [12.0, 8.0]
    assert chained(step, [0, 0, 2, 2]).effect.tolist() == [6.0, 4.0]
    assert chained(step).residual == 0.5


@pytest.mark.parametrize("origin", [None, [0, 0, 2, 2]])
def test_joints_of_a_chain(origin: list[int] | None) -> None:
    """Assert the points that others follow from, and the last; the flow there, and none where states jump."""
    own = chained(np.ones((4, 1, 2)), origin)
    joints = [0, 1, 2, 3, 4] if origin is None else [0, 2, 4]
    assert own._joints.tolist() == joints and own.flow is not None
    assert own.flow[:, 0].tolist() == joints
    assert chained(np.ones((4, 1, 2)), origin, perturbed=np.ones((4, 1, 2))).flow is None


def test_maps_from_the_first_point() -> None:
    """Assert dx_j of numbers by hand, one after the other and from points that several follow from."""
    step = np.array([[[1.0, 2.0]], [[0.5, 3.0]], [[-1.0, 4.0]]])
    assert bordering.chain(chained(step).eliminated)[:, 0].tolist() == [[0, 1], [1, 2], [3.5, 6], [13, 24]]
    forked = bordering.chain(chained(step, [0, 0, 2]).eliminated)
    assert forked[:, 0].tolist() == [[0, 1], [1, 2], [0.5, 3], [1, 12]]


def test_growth_between_any_two_points() -> None:
    """Assert the largest product of consecutive steps, which need not begin at the first, and infinity."""
    numbers = np.array([0.1, 20.0, 0.5, 30.0, 0.01, 2.0])
    assert bordering.between_any(numbers[:, None, None]) == pytest.approx(300.0)
    assert bordering.between_any(-numbers[:, None, None]) == pytest.approx(300.0)
    assert bordering.between_any(np.full((3, 1, 1), 0.5)) == 1.0
    many = np.full((5 * bordering.PLACES, 1, 1), 0.5)
    many[40:44] = 10.0
    assert 1e3 / 16 <= bordering.between_any(many) <= 1e4
    assert bordering.between_any(np.full((4, 1, 1), 1e200)) == np.inf


def test_fundamental_matrices_are_bounded() -> None:
    """Assert products of steps, as they are while they are finite and far less than the largest number."""
    step = np.zeros((3, 1, 2))
    step[:, 0, 1] = 2.0
    assert chained(step).fundamental.ravel().tolist() == [1.0, 2.0, 4.0, 8.0]
    step[:, 0, 1] = 1e100
    found = chained(step).fundamental.ravel()
    assert np.isfinite(found).all() and found[1] == 1e100 and 1e140 < found[3] <= 1e160


def test_effect_of_parameters_on_equilibria() -> None:
    """Assert the largest derivative in each over the largest in the states; 0 where there is none."""
    rows: Any = SimpleNamespace(
        residual=np.array([0.1, -0.7]), d_unknown=np.array([[1.0, -4.0, 2.0, 0.0], [0.5, 3.0, -6.0, 1.0]])
    )
    orbit: Any = SimpleNamespace(nodes=np.zeros((1, 2)))
    own = Constant(orbit, rows)
    assert own.effect.tolist() == [1.5, 0.25] and own.residual == 0.7
    rows.d_unknown[:, :2] = 0.0
    assert own.effect.tolist() == [0.0, 0.0]
