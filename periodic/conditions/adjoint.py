"""How a functional of the linearised flow changes with the orbit: exact second derivatives at adjoint cost.

A tangent v = (v_0, v_y) is carried through the linearised collocation equations A(u) v = 0 to all mesh points
and stages; s . v is a functional of it. At fixed v_0 and v_y its gradient in the orbit u is

    d(s . v) = lambda . dA v,   A^T lambda = -s,

with the contraction of the second derivatives from the system (Govaerts, Numerical Methods for Bifurcations
of Dynamical Equilibria, 2000, ch. 5).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from periodic.collocation.condensation import Condensed, condensed
from periodic.linear.bordering import chain, onto_start
from periodic.orbit.gradients import Points, Slopes, collocation_points, gathered, solved
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array, Family, Scheme
from periodic.system import Differentiable, LinearisationLike, jumps_of, resets_of


@dataclass(frozen=True)
class Tangent:
    """A solution of the linearised equations: mesh points (N+1, n), stages (N, ncol, n), unknowns
    (N, ncol, m), and the parameters' part (p,)."""

    nodes: Array
    stages: Array
    algebraic: Array
    parameter: Array

    def moved(self, orbit: Orbit, step: float) -> Orbit:
        """Return the orbit a step along the tangent."""
        return replace(
            orbit,
            nodes=orbit.nodes + step * self.nodes,
            stages=orbit.stages + step * self.stages,
            algebraic=orbit.algebraic + step * self.algebraic,
            parameter=orbit.parameter + step * self.parameter,
        )


@dataclass(frozen=True)
class Linear:
    """The linearised flow of an orbit: maps (1, dx_0, dphi, dy) -> dx_j, and its parts."""

    system: Differentiable
    orbit: Orbit
    free: tuple[int, ...]
    condensed: Condensed
    maps: Array

    @staticmethod
    def about(system: Differentiable, orbit: Orbit, free: tuple[int, ...]) -> Linear:
        """Linearise; `free` are the parameters that tangents may change.

        Raises ValueError for an orbit that is no piecewise polynomial.
        """
        polynomial(orbit)
        if resets_of(system) or jumps_of(system):
            raise ValueError("system has impacts or jumps; exact second derivatives need one without")
        local = condensed(system, orbit, free)
        return Linear(system, orbit, free, local, chain(local))

    @property
    def monodromy(self) -> Array:
        """The monodromy matrix, shape (n, n)."""
        n = self.maps.shape[1]
        return self.maps[-1][:, 1 : 1 + n]

    def columns(self, maps: Array) -> Array:
        """Leave out the constant's and the event nodes' columns of maps (..., w): (dx_0, dy) are left."""
        n, k = self.orbit.nodes.shape[1], len(self.orbit.phases)
        return np.concatenate([maps[..., 1 : 1 + n], maps[..., 1 + n + k :]], axis=-1)

    def tangent(self, unknown: Array) -> Tangent:
        """Return the tangent of (v_0, v_y)."""
        n, k = self.orbit.nodes.shape[1], len(self.orbit.phases)
        outer = np.concatenate([np.zeros(k), unknown[n:]])
        nodes = self.columns(self.maps) @ unknown
        stages, algebraic = self.condensed.recover(nodes, outer, 0.0)
        parameter = np.zeros_like(self.orbit.parameter)
        parameter[list(self.free)] = unknown[n:]
        return Tangent(nodes, stages, algebraic, parameter)

    def functional(self, row: Row) -> Array:
        """Return a row as a functional of (v_0, v_y)."""
        return self.columns(onto_start(self.condensed.reduced(row), self.maps))

    def source(self, end: Array) -> Row:
        """Return the functional end . v_N."""
        nodes = np.zeros_like(self.orbit.nodes)
        nodes[-1] = end
        return Row(0.0, nodes, np.zeros(len(self.orbit.phases) + len(self.free)))


def polynomial(orbit: Orbit) -> None:
    """Raise ValueError for an orbit that is no piecewise polynomial."""
    if orbit.mesh.scheme not in (Scheme(f, orbit.mesh.scheme.ncol) for f in Family):
        raise ValueError(f"orbit is a {orbit!r}; exact derivatives need one found by Collocation or Shooting")


def gradient(linear: Linear, tangent: Tangent, source: Row, free: tuple[int, ...]) -> Row:
    """Return the gradient of source . v in the orbit and the parameters `free`.

    The row's value is what the algebraic rows, not yet met, will add.
    """
    system, orbit = linear.system, linear.orbit
    points = collocation_points(orbit)
    line = system.linearise(*points.arguments(orbit), ())
    weights = _adjoint(linear, line, source)
    n, m = orbit.nodes.shape[1], orbit.algebraic.shape[2]
    knots = np.concatenate([tangent.nodes[:-1, None], tangent.stages], axis=1)
    rates = (orbit.mesh.scheme.stage_rates @ knots / orbit.grid.width[:, None, None]).reshape(-1, n)
    found = system.curvature(
        *points.arguments(orbit),
        weights,
        rates,
        tangent.stages.reshape(-1, n),
        tangent.algebraic.reshape(-1, m) if m else np.zeros((len(rates), 0)),
        tangent.parameter,
    )
    row = gathered(system, orbit, points, Slopes.of(found, free), free)
    slope = np.einsum("pr,prn,pn->p", weights, line.d_rate, rates)
    outer = row.outer
    outer[: len(orbit.phases)] -= _stretched(orbit, points, slope)
    return Row(row.value, row.nodes, outer, row.stages)


def _stretched(orbit: Orbit, points: Points, slope: Array) -> Array:
    """How wider intervals slow the tangent down, in the event node phases."""
    relative = orbit.grid.width_gradient / orbit.grid.width[:, None]
    return slope @ relative[points.index]


def _adjoint(linear: Linear, line: LinearisationLike, source: Row) -> Array:
    """Solve A^T lambda = -source backwards; shape (points, n+m)."""
    orbit, condensed = linear.orbit, linear.condensed
    count, ncol, n = orbit.stages.shape
    stages = np.zeros((count, ncol, n)) if source.stages is None else source.stages
    step = condensed.step[:, :, 1 : 1 + n]
    direct = np.einsum("jln,jlnw->jw", stages, condensed.stages[..., 1 : 1 + n])
    at_end = np.empty((count, n))
    later = source.nodes[-1]
    for j in range(count - 1, -1, -1):
        at_end[j] = later
        later = later @ step[j] + direct[j] + source.nodes[j]
    right = orbit.mesh.scheme.end[1:, None] * at_end[:, None] + stages
    matrix, eliminated = _stage_matrix(orbit, line)
    size = ncol * n
    found = -np.linalg.solve(np.swapaxes(matrix, 1, 2), right.reshape(count, size, 1)).reshape(-1, n)
    return np.concatenate([found, -np.einsum("pn,pnm->pm", found, eliminated)], axis=1)


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
