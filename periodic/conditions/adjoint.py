"""How a functional of the linearised flow changes with the orbit: exact second derivatives at adjoint cost.

A tangent v = (v_0, v_y) is carried through the linearised collocation equations A(u) v = 0 to all mesh points
and stages; s . v is a functional of it. At fixed v_0 and v_y its gradient in the orbit u is

    d(s . v) = lambda . dA v,   A^T lambda = -s,

with the contraction of the second derivatives from the system (Govaerts, Numerical Methods for Bifurcations
of Dynamical Equilibria, 2000, ch. 5); see `periodic.conditions.curvature`. Tangents are perturbations at
fixed tau: impacts and jumps they pass by saltation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from periodic.collocation.elimination import EliminatedStages, eliminate_stages
from periodic.collocation.residual import evaluated
from periodic.conditions.curvature import beside, curvature
from periodic.events.impacts import jumps
from periodic.events.saltation import at_fixed_phase, saltation_gradient
from periodic.linear.bordering import Chain, chain, onto_start
from periodic.linear.invariantpair import subspaces, within
from periodic.linear.variation import Complex, Tangent
from periodic.orbit.gradients import Points, collocation_points, gathered, solved
from periodic.orbit.jump import Jump
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array, Family, Scheme
from periodic.system import LinearisationLike, System


@dataclass(frozen=True)
class Linear:
    """The linearised flow of an orbit: maps (1, dx_0, dphi, dy) -> dx_j, and its parts.

    See `periodic.linear.variation.Variations`.
    """

    system: System
    orbit: Orbit
    free: tuple[int, ...]
    eliminated: EliminatedStages
    maps: Array
    jumps: Sequence[Jump] = ()

    @staticmethod
    def about(system: System, orbit: Orbit, free: tuple[int, ...]) -> Linear:
        """Linearise; `free` are the parameters that tangents may change."""
        found = jumps(system, orbit, free)
        local = eliminate_stages(system, orbit, evaluated(system, orbit, free), found)
        if local.perturbed is not None:
            n, k = orbit.nodes.shape[1], len(orbit.phases)
            step = np.zeros_like(local.step)
            step[:, :, 1 : 1 + n], step[:, :, 1 + n + k :] = np.split(local.perturbed, [n], axis=2)
            local = replace(local, step=step)
        return Linear(system, orbit, free, local, chain(local), found)

    @cached_property
    def fundamental(self) -> Array:
        """Fundamental matrices at the mesh points, shape (N+1, n, n)."""
        return Chain(self.eliminated).fundamental

    @property
    def monodromy(self) -> Array:
        """The monodromy matrix, shape (n, n)."""
        return self.fundamental[-1]

    @property
    def ways(self) -> Array:
        """How (v_0, v_y) move the mesh points, shape (N+1, n, n+q)."""
        first = 1 + self.maps.shape[1] + len(self.orbit.phases)
        return np.concatenate([self.fundamental, self.maps[:, :, first:]], axis=2)

    def repeating(self, multiplier: float) -> Closed:
        """Return the equations of motions that are multiplied by a number."""
        return Closed(self, multiplier)

    @cached_property
    def _eigen(self) -> tuple[Complex, Complex]:
        values, vectors = np.linalg.eig(self.monodromy)
        return values.astype(np.complex128), vectors.astype(np.complex128)

    @property
    def multipliers(self) -> Complex:
        """All multipliers."""
        return self._eigen[0]

    def outside(self, radius: float) -> int:
        """Return how many multipliers have a modulus larger than `radius`."""
        return int((np.abs(self.multipliers) > radius).sum())

    def multiplier(self, which: int, factor: complex, free: tuple[int, ...]) -> Row:
        """Return the gradient of Re(factor mu), d mu = w' dM v / w' v."""
        value, right = self._eigen[0][which], self._eigen[1][:, which]
        others, vectors = np.linalg.eig(self.monodromy.T)
        left = vectors[:, np.abs(others - value).argmin()]
        left = factor * left / (left @ right)
        row = gradient(self, self.tangent(right.real), self.source(left.real), free)
        return row + gradient(self, self.tangent(right.imag), self.source(-left.imag), free)

    def pair(self, near: Array | None, free: tuple[int, ...]) -> tuple[Row, Array]:
        """Return det B - 1, B the monodromy matrix on the pair's subspace, and a basis of that."""
        right, left = _subspaces(self.monodromy, near)
        block = left.T @ self.monodromy @ right
        (a, b), (c, d) = block
        size = float(a * d - b * c)
        weights = left @ np.array([[d, -c], [-b, a]])
        total = Row(size - 1, np.zeros_like(self.orbit.nodes), np.zeros(len(self.orbit.phases) + len(free)))
        for column, weight in zip(right.T, weights.T, strict=True):
            total += gradient(self, self.tangent(column), self.source(weight), free)
        return total, right if near is None else near

    def columns(self, maps: Array) -> Array:
        """Leave out the constant's and the event nodes' columns of maps (..., w): (dx_0, dy) are left."""
        n, k = self.orbit.nodes.shape[1], len(self.orbit.phases)
        return np.concatenate([maps[..., 1 : 1 + n], maps[..., 1 + n + k :]], axis=-1)

    def tangent(self, unknown: Array) -> Tangent:
        """Return the tangent of (v_0, v_y)."""
        n, k = self.orbit.nodes.shape[1], len(self.orbit.phases)
        outer = np.concatenate([np.zeros(k), unknown[n:]])
        nodes = self.ways @ unknown
        stages, algebraic = self.eliminated.recover(nodes, outer, 0.0)
        parameter = np.zeros_like(self.orbit.parameter)
        parameter[list(self.free)] = unknown[n:]
        return Tangent(nodes, stages, algebraic, parameter)

    def functional(self, row: Row) -> Array:
        """Return a row as a functional of (v_0, v_y)."""
        return self.columns(onto_start(self.eliminated.reduced(self.at_fixed_phase(row)), self.maps))

    def at_fixed_phase(self, row: Row) -> Row:
        """Return a row for tangents at fixed tau, by which event nodes at jumps are told."""
        return at_fixed_phase(self.system, self.orbit, self.jumps, row, self.free)

    def source(self, end: Array) -> Row:
        """Return the functional end . v_N."""
        nodes = np.zeros_like(self.orbit.nodes)
        nodes[-1] = end
        return Row(0.0, nodes, np.zeros(len(self.orbit.phases) + len(self.free)))


@dataclass(frozen=True)
class Closed:
    """The flow closed by v_N = mu v_0; see `periodic.linear.variation.Repeating`."""

    linear: Linear
    multiplier: float

    @property
    def matrix(self) -> Array:
        """M - mu I, with the columns of the free parameters."""
        top = self.linear.ways[-1]
        n = len(top)
        top[:, :n] -= self.multiplier * np.eye(n)
        return top

    def functional(self, row: Row) -> Array:
        """Return a row as a functional of (v_0, v_y)."""
        return self.linear.functional(row)

    def tangent(self, unknown: Array) -> Tangent:
        """Return the tangent of (v_0, v_y)."""
        return self.linear.tangent(unknown)

    def gradient(self, unknown: Array, left: Array, source: Row | None, free: tuple[int, ...]) -> Row:
        """Return the gradient of left . (M - mu I) v_0 + source . v."""
        end, linear = self.linear.source(left), self.linear
        whole = end if source is None else end + linear.at_fixed_phase(source)
        return gradient(linear, self.tangent(unknown), whole, free)


def polynomial(orbit: Orbit) -> None:
    """Raise ValueError for an orbit that is no piecewise polynomial."""
    if orbit.mesh.scheme not in (Scheme(f, orbit.mesh.scheme.ncol) for f in Family):
        raise ValueError(f"orbit is a {orbit!r}; exact derivatives need one found by Collocation or Shooting")


def gradient(linear: Linear, tangent: Tangent, source: Row, free: tuple[int, ...]) -> Row:
    """Return the gradient of source . v in the orbit and the parameters `free`, both at fixed tau.

    The row's value is what the algebraic rows, not yet met, will add.
    """
    system, orbit = linear.system, linear.orbit
    points = collocation_points(orbit)
    line = beside(system, orbit, points, ())
    weights, at_end = _adjoint(linear, line, source)
    n, m = orbit.nodes.shape[1], orbit.algebraic.shape[2]
    knots = np.concatenate([tangent.nodes[:-1, None], tangent.stages], axis=1)
    rates = (orbit.mesh.scheme.stage_rates @ knots / orbit.grid.width[:, None, None]).reshape(-1, n)
    states, unknowns = tangent.stages.reshape(-1, n), tangent.algebraic.reshape(len(rates), m)
    along = replace(points, rate=rates, state=states, algebraic=unknowns)
    slopes = curvature(system, orbit, points, weights, along, tangent.parameter, free)
    row = gathered(system, orbit, points, slopes, free)
    slope = np.einsum("pr,prn,pn->p", weights, line.d_rate, rates)
    outer = row.outer
    outer[: len(orbit.phases)] -= _stretched(orbit, points, slope)
    row = Row(row.value, row.nodes, outer, row.stages)
    for jump in linear.jumps:
        arriving = orbit.mesh.scheme.end @ knots[jump.interval]
        passed = np.append(arriving, tangent.parameter[list(linear.free)])
        row += saltation_gradient(system, orbit, jump.index, at_end[jump.interval], passed, linear.free, free)
    return row


def _stretched(orbit: Orbit, points: Points, slope: Array) -> Array:
    """How wider intervals slow the tangent down, in the event node phases."""
    relative = orbit.grid.width_gradient / orbit.grid.width[:, None]
    return slope @ relative[points.index]


def _adjoint(linear: Linear, line: LinearisationLike, source: Row) -> tuple[Array, Array]:
    """Solve A^T lambda = -source backwards; shape (points, n+m); and what the mesh points' states count.

    The latter, shape (N, n), for the states in which intervals end, behind their jump.
    """
    orbit, between = linear.orbit, linear.eliminated
    count, ncol, n = orbit.stages.shape
    stages = np.zeros((count, ncol, n)) if source.stages is None else source.stages
    step = between.step[:, :, 1 : 1 + n]
    direct = np.einsum("jln,jlnw->jw", stages, between.stages[..., 1 : 1 + n])
    at_end = np.empty((count, n))
    later = source.nodes[-1]
    for j in range(count - 1, -1, -1):
        at_end[j] = later
        later = later @ step[j] + direct[j] + source.nodes[j]
    behind = at_end.copy()
    for jump in linear.jumps:
        at_end[jump.interval] = at_end[jump.interval] @ jump.saltation[:, :n]
    right = orbit.mesh.scheme.end[1:, None] * at_end[:, None] + stages
    matrix, eliminated = _stage_matrix(orbit, line)
    size = ncol * n
    found = -np.linalg.solve(np.swapaxes(matrix, 1, 2), right.reshape(count, size, 1)).reshape(-1, n)
    return np.concatenate([found, -np.einsum("pn,pnm->pm", found, eliminated)], axis=1), behind


def _stage_matrix(orbit: Orbit, line: LinearisationLike) -> tuple[Array, Array]:
    """The matrix of each interval's rows in its stages, (N, ncol n, ncol n); R_dz R_az^-1 (points, n, m)."""
    count, ncol, n = orbit.stages.shape
    m = orbit.algebraic.shape[2]
    right = line.d_algebraic[:, :n]
    eliminated = np.stack([solved(line, right[:, i]) for i in range(n)], axis=1) if m else right
    d_rate = line.d_rate[:, :n] - eliminated @ line.d_rate[:, n:]
    d_state = line.d_state[:, :n] - eliminated @ line.d_state[:, n:]
    weights = orbit.mesh.scheme.stage_rates[:, 1:] / orbit.grid.width[:, None, None]
    matrix = d_rate.reshape(count, ncol, n, 1, n) * weights[:, :, None, :, None]
    each = np.arange(ncol)
    matrix[:, each, :, each, :] += np.moveaxis(d_state.reshape(count, ncol, n, n), 1, 0)
    return matrix.reshape(count, ncol * n, ncol * n), eliminated


def _subspaces(matrix: Array, basis: Array | None) -> tuple[Array, Array]:
    """Right and left bases (n, 2) of a pair's invariant subspace, with left.T right = I.

    The pair is the one whose product is nearest to 1, or whose subspace is nearest to `basis`.
    """
    values, vectors = np.linalg.eig(matrix)
    if basis is not None:
        return subspaces(matrix, within(basis, vectors), values)
    first, second = np.triu_indices(len(values), 1)
    k = int(np.abs(values[first] * values[second] - 1).argmin())
    return subspaces(matrix, [int(first[k]), int(second[k])], values)
