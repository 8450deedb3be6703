"""Shooting equations, linearised: the orbit's segments are trajectories that must join.

The unknowns are the states x_s where the segments start. With the flow phi, its fundamental matrix Phi and
its derivative P in the free parameters y,

    dx(tau) = Phi(tau) dx_s + P(tau) dy within a segment,   phi(x_s) - x_{s+1} + dx(tau_{s+1}) = dx_{s+1}.

Mesh points, stages and unknowns of an orbit are the flow's values there (Seydel, Practical Bifurcation and
Stability Analysis, 7.5).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import Flowing


@dataclass(frozen=True)
class SegmentMaps:
    """Maps from (1, dx_origin, dy), width w = 1+n+q: step (N, n, w), stages (N, ncol, n, w), algebraic
    (N, ncol, m, w). residual is the largest gap between segments. Fulfils
    `periodic.linear.bordering.Eliminated`.
    """

    orbit: Orbit
    origin: NDArray[np.int_]
    step: Array
    stages: Array
    algebraic: Array
    residual: float
    compiled = None

    def reduced(self, row: Row) -> Row:
        """Return a row in mesh-point states and y alone, its stages eliminated."""
        if row.stages is None:
            return row
        each, n = np.einsum("jli,jliw->jw", row.stages, self.stages), row.nodes.shape[1]
        nodes = row.nodes.copy()
        np.add.at(nodes, self.origin, each[:, 1 : 1 + n])
        return Row(row.value + float(each[:, 0].sum()), nodes, row.outer + each[:, 1 + n :].sum(axis=0))

    def recover(self, nodes: Array, outer: Array, constant: float) -> tuple[Array, Array]:
        """Return the increments of stages and unknowns that go with node increments and dy = `outer`.

        A Newton step (constant 1) leaves the unknowns alone: the next flow has them anew.
        """
        start = nodes[self.origin]
        head = np.column_stack([np.full(len(start), constant), start, np.tile(outer, (len(start), 1))])
        stages = np.einsum("jlnw,jw->jln", self.stages, head)
        if constant:
            return stages, np.zeros_like(self.orbit.algebraic)
        return stages, np.einsum("jlmw,jw->jlm", self.algebraic, head)


def starts(ntst: int, segments: int) -> NDArray[np.int_]:
    """Return the mesh points at which segments start, and the last one; a mesh point each at the most."""
    return np.unique(np.linspace(0, ntst, segments + 1).astype(int))


def segment_maps(
    system: Flowing, orbit: Orbit, free: tuple[int, ...], segments: int, tolerance: float
) -> SegmentMaps:
    """Integrate all segments of an orbit on a mesh without event nodes, with their derivatives.

    The result's orbit has the flow's values everywhere but where segments start. Raises ArithmeticError where
    the integration fails.
    """
    count, ncol, n = orbit.stages.shape
    nodes, stages, algebraic = orbit.nodes.copy(), orbit.stages.copy(), orbit.algebraic.copy()
    bounds = starts(count, segments)
    width = 1 + n + len(free)
    step = np.zeros((count, n, width))
    by_stage, by_unknown = np.zeros((*stages.shape, width)), np.zeros((*algebraic.shape, width))
    for first, last in pairwise(bounds):
        part = slice(first, last)
        phase = _phases(orbit, part)
        guess = orbit.algebraic[first, 0]
        begin = orbit.grid.left[first : first + 1]
        flow = system.flow(nodes[first], guess, orbit.parameter, np.append(begin, phase), free, tolerance)
        state, state_map = _cut(flow.state, phase), _cut(flow.state_gradient, phase)
        nodes[first + 1 : last] = state[:-1, -1]
        stages[part], by_stage[part, ..., 1:] = state[:, :ncol], state_map[:, :ncol]
        algebraic[part] = _cut(flow.algebraic, phase)[:, :ncol]
        by_unknown[part, ..., 1:] = _cut(flow.algebraic_gradient, phase)[:, :ncol]
        step[part, :, 1:] = state_map[:, -1]
        step[last - 1, :, 0] = state[-1, -1] - nodes[last]
    origin = np.repeat(bounds[:-1], np.diff(bounds))
    flowed = replace(orbit, nodes=nodes, stages=stages, algebraic=algebraic)
    return SegmentMaps(flowed, origin, step, by_stage, by_unknown, float(np.abs(step[:, :, 0]).max()))


def _phases(orbit: Orbit, part: slice) -> Array:
    """Phases of the stages and right ends of some intervals, each once, shape (intervals, ncol or ncol+1)."""
    points = orbit.mesh.scheme.points
    marks = points if points[-1] == 1.0 else np.append(points, 1.0)
    return orbit.grid.left[part, None] + orbit.grid.width[part, None] * marks


def _cut(values: Array, phase: Array) -> Array:
    """The values after the first, interval by interval."""
    return values[1:].reshape(*phase.shape, *values.shape[1:])
