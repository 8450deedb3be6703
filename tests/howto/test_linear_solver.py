"""How to bring a linear solver of one's own: SciPy's sparse LU (`splu`) in place of elimination.

`Collocation(solver=...)` takes a function of the system, an orbit, its equations evaluated at the collocation
points and the rows of its event nodes; it returns an `Operator`. Newton asks the operator for three things:
increments that solve the bordered equations for some right-hand sides (`solve`), the fundamental matrices at
the mesh points, whose last is the monodromy matrix (`fundamental`), and how strongly the free parameters act
(`effect`). Everything else, from error estimates to special points, goes on as it does.

This one puts all unknowns into one sparse matrix, u = (mesh points, stages, algebraic unknowns, y), y the
phases of the event nodes and the free parameters: no elimination, no product of matrices.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.sparse.linalg import splu
from support.traces import DUFFING_A, RPM, disc_system, duffing_system

import periodic as per
from periodic.collocation.residual import Rows, rows_of
from periodic.extend import Increment, LinearisationLike, Row, System
from periodic.orbit.jump import Jump
from periodic.orbit.scheme import Array


@dataclass(frozen=True)
class SparseOperator:
    """The collocation equations of an orbit as one sparse matrix."""

    orbit: per.Orbit
    rows: Rows
    own: Sequence[Row]

    @property
    def residual(self) -> float:
        """The largest residual."""
        return self.rows.residual

    @cached_property
    def sizes(self) -> tuple[int, int, int, int]:
        """How many numbers u has of each kind."""
        n, columns = self.orbit.nodes.shape[1], self.rows.columns.shape[2]
        return self.orbit.nodes.size, self.orbit.stages.size, self.orbit.algebraic.size, columns - 1 - 2 * n

    @cached_property
    def equations(self) -> tuple[sparse.csc_matrix, Array]:
        """Matrix and residual of the collocation equations and of the continuity at mesh points."""
        orbit, (count, ncol, n), m = self.orbit, self.orbit.stages.shape, self.orbit.algebraic.shape[2]
        scheme, width, columns = orbit.mesh.scheme, orbit.grid.width, self.rows.columns
        local = columns.reshape(count, ncol, n + m, -1)
        rate, state, outer = np.split(local[..., 1:], [n, 2 * n], axis=-1)
        slopes = np.einsum("jlra,lk->jlrka", rate / width[:, None, None, None], scheme.stage_rates)
        for point in range(ncol):
            slopes[:, point, :, 1 + point] += state[:, point]
        size = ncol * (n + m)
        begin = _block_diagonal(slopes[:, :, :, 0].reshape(count, size, n))
        inner = _block_diagonal(slopes[:, :, :, 1:].reshape(count, size, ncol * n))
        unknown = _block_diagonal(self.rows.d_algebraic)
        padded = sparse.hstack([begin, sparse.csr_matrix((begin.shape[0], n))])
        collocated = sparse.hstack(
            [padded, inner, unknown, sparse.csr_matrix(outer.reshape(count * size, -1))]
        )
        last = sparse.kron(sparse.eye(count), np.kron(scheme.end[1:], np.eye(n)))
        first = sparse.kron(
            sparse.eye(count, count + 1) * scheme.end[0] - sparse.eye(count, count + 1, 1), np.eye(n)
        )
        joined = sparse.hstack([first, last, sparse.csr_matrix((count * n, sum(self.sizes[2:])))])
        gap = scheme.end @ orbit.knots - orbit.nodes[1:]
        return sparse.vstack([collocated, joined]).tocsc(), np.append(columns[:, :, 0], gap)

    def _with(self, border: sparse.spmatrix) -> sparse.csc_matrix:
        return sparse.vstack([self.equations[0], border]).tocsc()

    def solve(self, rows: Sequence[Row], right: Array) -> tuple[Increment, ...]:
        """Return an increment for each column of `right`: see `periodic.linear.operator.Operator`."""
        n, every = self.orbit.nodes.shape[1], [*self.own, *rows]
        wide = sum(self.sizes)
        periodic = sparse.eye(n, wide, self.sizes[0] - n) - sparse.eye(n, wide)
        border = sparse.vstack([periodic, *(sparse.csr_matrix(self._flat(row)) for row in every)])
        constant = np.concatenate(
            [self.equations[1], self.orbit.nodes[-1] - self.orbit.nodes[0], [row.value for row in every]]
        )
        aim = -constant[:, None] * right[:1]
        aim[len(aim) - len(rows) :] += right[1:]
        return tuple(self._increment(u) for u in splu(self._with(border)).solve(aim).T)

    def _flat(self, row: Row) -> Array:
        stages = np.zeros_like(self.orbit.stages) if row.stages is None else row.stages
        return np.concatenate([row.nodes.ravel(), stages.ravel(), np.zeros(self.sizes[2]), row.outer])

    def _increment(self, u: Array) -> Increment:
        orbit, k = self.orbit, len(self.orbit.phases)
        nodes, stages, algebraic, y = np.split(u, np.cumsum(self.sizes[:3]))
        shapes = (orbit.nodes.shape, orbit.stages.shape, orbit.algebraic.shape)
        shaped = [a.reshape(shape) for a, shape in zip((nodes, stages, algebraic), shapes, strict=True)]
        return Increment.of(orbit, *shaped, y[:k], y[k:])

    @cached_property
    def _responses(self) -> Array:
        """Mesh points that follow from unit changes of the first one and of y, shape (N+1, n, n+q)."""
        n, q = self.orbit.nodes.shape[1], self.sizes[3]
        held = sparse.vstack(
            [sparse.eye(n, sum(self.sizes)), sparse.eye(q, sum(self.sizes), sum(self.sizes[:3]))]
        )
        unit = np.zeros((sum(self.sizes), n + q))
        unit[-n - q :] = np.eye(n + q)
        return splu(self._with(held)).solve(unit)[: self.sizes[0]].reshape(-1, n, n + q)

    @property
    def fundamental(self) -> Array:
        """Fundamental matrices at the mesh points."""
        return self._responses[:, :, : self.orbit.nodes.shape[1]]

    @property
    def effect(self) -> Array:
        """How much the states change with each free parameter."""
        first = self.orbit.nodes.shape[1] + len(self.orbit.phases)
        return np.abs(self._responses[:, :, first:]).max(axis=(0, 1), initial=0.0)


def _block_diagonal(blocks: Array) -> sparse.csr_matrix:
    return sparse.block_diag(list(blocks), format="csr")


def by_splu(
    system: System,
    orbit: per.Orbit,
    line: LinearisationLike,
    own: Sequence[Row],
    jumps: Sequence[Jump],
) -> SparseOperator:
    """The linear solver, of systems without impacts."""
    if jumps:
        raise ValueError("the system has impacts; by_splu is for systems without")
    return SparseOperator(orbit, rows_of(orbit, line), own)


@pytest.mark.parametrize("scene", ["duffing", "disc"])
def test_same_branch_with_another_solver(scene: str) -> None:
    """Assert that points, folds and multipliers are those of the elimination, to the orbits' tolerance."""
    duffing = (duffing_system(*DUFFING_A), "Omega", (1.8, 2.4))
    disc = (disc_system("vitrea79-810N"), "speed", (300 * RPM, 270 * RPM))  # contact is lost on the way
    problem = duffing if scene == "duffing" else disc
    found = per.trace(*problem, tol=1e-4, method=per.Collocation(solver=by_splu))
    known = per.trace(*problem, tol=1e-4)
    assert found.stop == known.stop and [p.label for p in found] == [p.label for p in known]
    assert found.values == pytest.approx(known.values, rel=1e-7)
    for one, other in zip(found, known, strict=True):
        assert one.multipliers == pytest.approx(other.multipliers, abs=1e-7)
