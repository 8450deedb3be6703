"""A periodic orbit: a piecewise polynomial on a mesh, and ways to evaluate it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.mesh import Grid, Mesh
from periodic.scheme import Array
from periodic.system import System

FORCED = 2 * np.pi
"""Period of the excitation in tau."""


@dataclass(frozen=True, eq=False, repr=False)
class Orbit:
    """States at mesh points (N+1, n) and collocation points (N, ncol, n), unknowns (N, ncol, m).

    phases (k,) are the anchors' places; parameter (p,) the system's parameters. All scaled. An equilibrium is
    an orbit that is constant, on a mesh of one interval.
    """

    mesh: Mesh
    nodes: Array
    stages: Array
    algebraic: Array
    phases: Array
    parameter: Array
    equilibrium: bool = False

    def __repr__(self) -> str:
        if self.equilibrium:
            return f"Orbit(equilibrium, {self.nodes.shape[1]} states)"
        return f"Orbit({self.mesh.ntst} intervals, {self.nodes.shape[1]} states, {self.periods} periods)"

    @cached_property
    def grid(self) -> Grid:
        """The mesh at this orbit's anchor phases."""
        return self.mesh.grid(self.phases)

    @cached_property
    def knots(self) -> Array:
        """Values at the knots of each interval, shape (N, ncol+1, n)."""
        return np.concatenate([self.nodes[:-1, None, :], self.stages], axis=1)

    @cached_property
    def knot_rates(self) -> Array:
        """dx/dtau at the knots, shape (N, ncol+1, n)."""
        return self.mesh.scheme.differentiation @ self.knots / self.grid.width[:, None, None]

    @property
    def stage_phases(self) -> Array:
        """tau at the collocation points, shape (N, ncol)."""
        return self.grid.left[:, None] + self.grid.width[:, None] * self.mesh.scheme.points

    @cached_property
    def node_rates(self) -> Array:
        """dx/dtau at the mesh points, from the interval on the right; shape (N+1, n)."""
        rates = self.knot_rates[:, 0, :]
        return np.concatenate([rates, rates[:1]])

    def locate(self, tau: Array) -> tuple[NDArray[np.int_], Array]:
        """Return interval index and place theta in [0, 1] within it of each phase."""
        begin = self.grid.left[0]
        wrapped = begin + np.mod(tau - begin, self.mesh.period)
        index = np.clip(np.searchsorted(self.grid.left, wrapped, side="right") - 1, 0, self.mesh.ntst - 1)
        theta = np.clip((wrapped - self.grid.left[index]) / self.grid.width[index], 0.0, 1.0)
        return index, theta

    def state(self, tau: Array) -> Array:
        """States at phases tau, shape (len(tau), n)."""
        index, theta = self.locate(tau)
        return np.einsum("tl,tln->tn", self.mesh.scheme.basis(theta), self.knots[index])

    def rate(self, tau: Array) -> Array:
        """dx/dtau at phases tau, shape (len(tau), n)."""
        index, theta = self.locate(tau)
        return np.einsum("tl,tln->tn", self.mesh.scheme.basis(theta), self.knot_rates[index])

    def spread(
        self, index: NDArray[np.int_], theta: Array, by_state: Array, by_rate: Array
    ) -> tuple[Array, Array]:
        """Turn derivatives in states and rates at points into derivatives in mesh points and stages.

        index, theta (P,) place the points; by_state, by_rate (P, n); their anchors' phases are held.
        """
        scheme, width = self.mesh.scheme, self.grid.width[index]
        basis = scheme.basis(theta)
        rates = basis @ scheme.differentiation / width[:, None]
        knots = np.zeros_like(self.knots)
        np.add.at(knots, index, basis[:, :, None] * by_state[:, None] + rates[:, :, None] * by_rate[:, None])
        nodes = np.zeros_like(self.nodes)
        nodes[:-1] = knots[:, 0]
        return nodes, knots[:, 1:]

    def algebraic_guess(self, tau: Array) -> Array:
        """Unknowns at phases tau, interpolated within each interval, shape (len(tau), m)."""
        index, theta = self.locate(tau)
        return np.einsum("tl,tlm->tm", self.mesh.scheme.algebraic_basis(theta), self.algebraic[index])

    @property
    def periods(self) -> int:
        """How many periods of the excitation the orbit takes to come back."""
        return round(self.mesh.period / FORCED)

    def collocated(self) -> Orbit:
        """The orbit as a piecewise polynomial on the same mesh points: itself."""
        return self

    def span(self) -> float:
        """Largest peak-to-peak value of the scaled states: what errors are compared with.

        1, the size of scaled states, for an equilibrium.
        """
        if self.equilibrium:
            return 1.0
        flat = self.knots.reshape(-1, self.knots.shape[2])
        return float(np.ptp(flat, axis=0).max())


def at_rest(system: System, mesh: Mesh, parameter: Array) -> Orbit:
    """Return the constant orbit at the system's rest values."""
    return constant(mesh, *system.rest(parameter), parameter)


def constant(mesh: Mesh, state: Array, algebraic: Array, parameter: Array) -> Orbit:
    """Return the constant orbit of a state (n,) and unknowns (m,)."""
    count, ncol = mesh.ntst, mesh.scheme.ncol
    return Orbit(
        mesh,
        np.tile(state, (count + 1, 1)),
        np.tile(state, (count, ncol, 1)),
        np.tile(algebraic, (count, ncol, 1)),
        np.zeros(0),
        np.array(parameter, dtype=float),
    )


def transfer(orbit: Orbit, mesh: Mesh, phases: Array) -> Orbit:
    """Return the orbit interpolated onto another mesh whose anchors lie at `phases`."""
    grid = mesh.grid(phases)
    tau = (grid.left[:, None] + grid.width[:, None] * mesh.scheme.points).ravel()
    inside = tau - 1e-9 * np.repeat(grid.width, mesh.scheme.ncol)
    shape = (mesh.ntst, mesh.scheme.ncol, -1)
    return Orbit(
        mesh,
        orbit.state(mesh.nodes(phases)),
        orbit.state(tau).reshape(shape),
        orbit.algebraic_guess(inside).reshape(*shape[:2], orbit.algebraic.shape[2]),
        phases,
        orbit.parameter,
    )


def bisect(orbit: Orbit) -> Orbit:
    """Return the same piecewise polynomial on the mesh with every interval halved."""
    scheme = orbit.mesh.scheme
    halves = np.concatenate([scheme.points / 2, (1 + scheme.points) / 2])
    count = 2 * orbit.mesh.ntst
    nodes = np.empty((count + 1, orbit.nodes.shape[1]))
    nodes[::2] = orbit.nodes
    nodes[1::2] = scheme.basis(np.array([0.5]))[0] @ orbit.knots
    return replace(
        orbit,
        mesh=orbit.mesh.bisected(),
        nodes=nodes,
        stages=(scheme.basis(halves) @ orbit.knots).reshape(count, scheme.ncol, -1),
        algebraic=(scheme.algebraic_basis(halves) @ orbit.algebraic).reshape(
            count, scheme.ncol, orbit.algebraic.shape[2]
        ),
    )
