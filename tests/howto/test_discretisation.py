"""How to bring a discretisation of one's own: the trapezoidal rule, in one file.

    x_{j+1} - x_j = h_j (f_j + f_{j+1}) / 2,   R(f_j, x_j, tau_j, p) = 0

A discretisation is a class with five methods. `guess` gives the orbit that Newton starts from, `linearise` an
`Operator`: the equations at an orbit. `transfer` carries an orbit to another mesh, `error` estimates what it
misses, `refine` says which mesh it needs. Continuation, special points, stability and results ask for nothing
else. Orbits are `per.Orbit`: states at mesh points and at points between them, here of the cubic through
values and rates at both ends. The operator is the `Chain` of collocation, dx_{j+1} = step[j] (1, dx_j, dp).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
from support.traces import DUFFING_A, duffing_system

import periodic as per
from periodic.extend import (
    Chain,
    Correction,
    Discretisation,
    ErrorEstimate,
    Increment,
    Mesh,
    Refinement,
    Row,
    Spectrum,
    System,
    at_rest,
    deferred,
    transfer,
    uniform,
)
from periodic.orbit.scheme import Array

CUBIC = per.Scheme(per.Family.RADAU, 3)
"""Its points and the left end carry a cubic."""


@dataclass(frozen=True)
class Steps:
    """The rule at an orbit, see `periodic.linear.bordering.Condensed`: maps of rates f_j and of points."""

    orbit: per.Orbit
    rates: Array
    step: Array
    origin: Array
    residual: float
    compiled = None

    def reduced(self, row: Row) -> Row:
        """Return the row: only mesh points occur in those met here."""
        assert row.stages is None
        return row

    def recover(self, nodes: Array, outer: Array, constant: float) -> tuple[Array, Array]:
        """Return the increments between the mesh points that go with those at them."""
        head = np.column_stack([np.full(len(nodes), constant), nodes, np.tile(outer, (len(nodes), 1))])
        slopes = np.einsum("jnw,jw->jn", self.rates, head)
        still = 0.0 if constant == 0 else self.orbit.stages
        stages = between(self.orbit.mesh, constant * self.orbit.nodes + nodes, slopes) - still
        return stages, np.zeros_like(self.orbit.algebraic)


def between(mesh: Mesh, nodes: Array, rates: Array) -> Array:
    """The cubics through values and rates at mesh points, at the scheme's points: shape (N, 3, n)."""
    c, h = CUBIC.points[:, None], mesh.grid(np.zeros(0)).width[:, None, None]
    left, right, begin, end = (a[:, None] for a in (nodes[:-1], nodes[1:], rates[:-1], rates[1:]))
    ends = (1 + 2 * c) * (1 - c) ** 2 * left + c**2 * (3 - 2 * c) * right
    return ends + h * (c * (1 - c) ** 2 * begin + c**2 * (c - 1) * end)


@dataclass(frozen=True)
class Trapezoidal(Discretisation):
    """The trapezoidal rule on `ntst` equal intervals, as many as `tolerance` asks for up to `most`."""

    ntst: int = 64
    most: int = 4096
    tolerance: float = 1e-3

    def at(self, tolerance: float) -> Trapezoidal:
        """Return it with meshes for a tolerance."""
        return replace(self, tolerance=tolerance)

    def guess(self, system: System, parameter: Array, near: per.Orbit | None) -> per.Orbit:
        """Return the orbit at rest, or any orbit on an even mesh."""
        mesh = uniform(CUBIC, self.ntst)
        return at_rest(system, mesh, parameter) if near is None else transfer(near, mesh, np.zeros(0))

    def linearise(self, system: System, orbit: per.Orbit, free: tuple[int, ...]) -> Chain:
        """Return the rule, linearised; R is linear in f."""
        phase, n = orbit.mesh.nodes(orbit.phases), orbit.nodes.shape[1]
        rates = np.zeros((len(phase), n, 1))
        for _ in range(2):  # once for f, once for its derivatives there
            at = (rates[:, :, 0], orbit.nodes, np.zeros((len(phase), 0)), phase, orbit.parameter)
            line = system.linearise(*at, free)
            columns = np.concatenate([line.residual[:, :, None], line.d_state, line.d_parameter], axis=2)
            first = rates[:, :, 0]
            rates = -np.linalg.solve(line.d_rate, columns)
            rates[:, :, 0] += first
        h, f = orbit.grid.width[:, None, None], rates[:, :, 1 : 1 + n]
        right = h / 2 * (rates[:-1] + rates[1:])
        right[:, :, 1 : 1 + n] = np.eye(n) + h / 2 * f[:-1]
        right[:, :, 0] -= np.diff(orbit.nodes, axis=0)
        step = np.linalg.solve(np.eye(n) - h / 2 * f[1:], right)
        residual = float(np.abs(right[:, :, 0]).max())
        return Chain(Steps(orbit, rates, step, np.arange(len(step)), residual))

    def transfer(self, system: System, orbit: per.Orbit, mesh: Mesh, phases: Array) -> Iterator[per.Orbit]:
        """Yield the orbit interpolated."""
        yield transfer(orbit, mesh, phases)

    def error(
        self, problem: per.Problem, correction: Correction, tangent: Increment, spectrum: Spectrum
    ) -> ErrorEstimate:
        """Estimate the errors by a Newton step on the halved mesh."""
        return deferred(self.linearise, problem, correction.orbit, tangent, spectrum)

    def refine(self, system: System, orbit: per.Orbit, error: ErrorEstimate) -> Refinement:
        """Ask for as many intervals as an error of second order needs."""
        return Even(self, orbit, error)


class Even(Refinement):
    """Even meshes for `Trapezoidal`, as fine as an error of second order asks for."""

    def __init__(self, method: Trapezoidal, orbit: per.Orbit, error: ErrorEstimate) -> None:
        super().__init__(orbit, error)
        factor = np.clip(np.sqrt(2 * error.worst / method.tolerance), 1 / 2, 4)
        self.ntst = int(min(orbit.mesh.ntst * factor + 1, method.most))

    @property
    def exhausted(self) -> bool:
        """Whether there are no finer ones."""
        return self.ntst <= self.orbit.mesh.ntst

    def refined(self) -> Mesh:
        """Return the mesh."""
        return uniform(CUBIC, self.ntst)

    def meshes(self) -> Iterator[tuple[Mesh, Array]]:
        """Yield it."""
        yield self.refined(), np.zeros(0)


def test_folds_by_the_trapezoidal_rule() -> None:
    """Assert that both folds of Duffing A and its stability come out as accurate as asked."""
    branch = per.trace(duffing_system(*DUFFING_A), "Omega", (0.3, 3.0), tol=1e-3, method=Trapezoidal())
    folds = [point.parameter for point in branch.labelled(per.Label.FOLD)]
    assert folds == pytest.approx([2.211935317020, 1.438670145514], rel=1e-3)
    assert branch.stop.reason is per.Reason.BOUND and not branch.stable.all()
    assert max(point.error.worst for point in branch) <= 1e-3
