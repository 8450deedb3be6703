"""Equations that close the collocation system: events at anchors, and the plane of a continuation step.

Each closure is one scalar equation in the mesh-point states, the anchor phases and the free parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Protocol

import numpy as np

from periodic.orbit import Orbit
from periodic.scheme import Array
from periodic.system import System


@dataclass(frozen=True)
class Row:
    """A closure linearised: value, gradient in the mesh-point states (N+1, n) and in y (q,).

    Where it depends on the stages too, also the gradient in them, (N, ncol, n).
    """

    value: float
    nodes: Array
    outer: Array
    stages: Array | None = None

    def scaled(self, factor: float) -> Row:
        """Return value and gradient times a factor."""
        stages = None if self.stages is None else factor * self.stages
        return Row(factor * self.value, factor * self.nodes, factor * self.outer, stages)

    def __add__(self, other: Row) -> Row:
        both = [row.stages for row in (self, other) if row.stages is not None]
        stages = np.sum(both, axis=0) if both else None
        return Row(self.value + other.value, self.nodes + other.nodes, self.outer + other.outer, stages)


class Closure(Protocol):
    """One scalar equation c(orbit) = 0."""

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient at an orbit; y holds the anchor phases, then the free parameters."""


@dataclass(frozen=True)
class Event:
    """The switch of anchor `index` is at its level where the segment begins: s(x, phi, p) = level."""

    index: int

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient of the switch function at the anchor."""
        node = orbit.mesh.starts[self.index]
        anchor = orbit.mesh.anchors[self.index]
        switch = anchor.switch
        where = (orbit.nodes[node : node + 1], orbit.phases[self.index : self.index + 1], orbit.parameter)
        d_state, d_phase, d_parameter = system.switch_gradient(*where)
        nodes = np.zeros_like(orbit.nodes)
        nodes[node] = d_state[0, switch]
        outer = np.zeros(len(orbit.phases) + len(free))
        outer[self.index] = d_phase[0, switch]
        outer[len(orbit.phases) :] = d_parameter[0, switch, list(free)]
        return Row(float(system.switch(*where)[0, switch]) - anchor.level, nodes, outer)


@dataclass(frozen=True)
class Direction:
    """A direction along the solution set, of unit length in the metric of `Metric`.

    nodes, stages, algebraic, phases are rates at fixed sigma (they move with the mesh); profile (N+1, n)
    is the rate of the mesh-point states at fixed tau; parameter the rate of the continuation parameter,
    others (k,) those of further free parameters.
    """

    nodes: Array
    stages: Array
    algebraic: Array
    phases: Array
    profile: Array
    parameter: float
    others: Array

    def scaled(self, factor: float) -> Direction:
        """Return the direction times a factor."""
        return Direction(
            nodes=factor * self.nodes,
            stages=factor * self.stages,
            algebraic=factor * self.algebraic,
            phases=factor * self.phases,
            profile=factor * self.profile,
            parameter=factor * self.parameter,
            others=factor * self.others,
        )

    def __add__(self, other: Direction) -> Direction:
        return Direction(*(getattr(self, f.name) + getattr(other, f.name) for f in fields(self)))

    def with_profile(self, profile: Array) -> Direction:
        """Return the direction with another profile: all that a plane needs on another mesh."""
        return replace(self, profile=profile)


@dataclass(frozen=True)
class Metric:
    """|u|^2 = mean over the period of |x|^2 + (parameter / scale)^2, with x at fixed tau."""

    scale: float

    @staticmethod
    def weights(orbit: Orbit) -> Array:
        """Trapezoidal weights of the mesh points over one period, shape (N+1,); their sum is 1."""
        half = orbit.grid.width / (2 * orbit.mesh.period)
        return np.append(half, 0.0) + np.append(0.0, half)

    def dot(self, orbit: Orbit, a: Direction, b: Direction) -> float:
        """Scalar product of two directions on the mesh of `orbit`."""
        states = np.einsum("j,jn,jn->", self.weights(orbit), a.profile, b.profile)
        return float(states) + a.parameter * b.parameter / self.scale**2


def node_phase_gradient(orbit: Orbit) -> Array:
    """How the mesh points' phases follow the anchor phases, shape (N+1, k)."""
    gradient = orbit.grid.left_gradient
    return np.concatenate([gradient, gradient[:1]])


@dataclass(frozen=True)
class Plane:
    """The plane through `origin`, moved along `direction`: <u - origin, direction> = distance."""

    origin: Orbit
    direction: Direction
    distance: float
    metric: Metric
    index: int

    def rate(self, direction: Direction) -> float:
        """How fast the distance grows along a direction on the origin's mesh."""
        row = self._gradient(self.origin, (self.index,))
        outer = np.append(direction.phases, direction.parameter)
        return float(np.vdot(row[0], direction.nodes) + row[1] @ outer)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient; mesh points that move carry the origin's slope with them."""
        weighted, outer = self._gradient(orbit, free)
        shift = orbit.parameter[list(free)] - self.origin.parameter[list(free)]
        moved = np.append(orbit.phases - self.origin.phases, shift)
        value = np.einsum("jn,jn->", weighted, orbit.nodes - self.origin.nodes) + outer @ moved
        return Row(float(value) - self.distance, weighted, outer)

    def _gradient(self, orbit: Orbit, free: tuple[int, ...]) -> tuple[Array, Array]:
        slope, moving = self.origin.node_rates, node_phase_gradient(orbit)
        weighted = self.metric.weights(self.origin)[:, None] * self.direction.profile
        k = len(orbit.phases)
        outer = np.zeros(k + len(free))
        outer[:k] = -np.einsum("jn,jn,jk->k", weighted, slope, moving)
        outer[k + free.index(self.index)] = self.direction.parameter / self.metric.scale**2
        return weighted, outer


@dataclass(frozen=True)
class Given:
    """What else determines an orbit: the further free parameters and as many closures.

    own: index of the free parameter that a condition is given for.
    """

    own: int
    free: tuple[int, ...] = ()
    closures: tuple[Closure, ...] = ()


class Condition(Protocol):
    """What determines a further free parameter: a closure that may refer to an earlier orbit.

    One that is `intrinsic` belongs to every orbit of the system (a phase condition); others pick points of a
    branch (its folds, a level of an output), and are told the intrinsic ones.
    """

    @property
    def intrinsic(self) -> bool: ...

    def at(self, origin: Orbit, given: Given) -> Closure:
        """Return the closure for orbits near `origin`, on the same mesh."""


def closures(conditions: Sequence[Condition], free: Sequence[int], origin: Orbit) -> list[Closure]:
    """Return the closures of conditions for the parameters `free`, one for each, near an orbit."""
    both = list(zip(free, conditions, strict=True))
    own = tuple(k for k, condition in both if condition.intrinsic)
    basic = tuple(condition.at(origin, Given(k)) for k, condition in both if condition.intrinsic)
    return [
        basic[own.index(k)] if condition.intrinsic else condition.at(origin, Given(k, own, basic))
        for k, condition in both
    ]


@dataclass(frozen=True)
class PhaseCondition:
    """The integral phase condition of autonomous orbits: mean over the period of <x - x_o, x_o'> = 0.

    x_o is the orbit before (Doedel 1981). It holds the phase that the equations leave open, and determines
    the angular frequency. `unit` is the number of multipliers that are then 1 whatever the parameters.
    """

    intrinsic = True
    unit = 1

    def at(self, origin: Orbit, given: Given) -> Closure:
        """Return the condition with respect to an orbit."""
        return _Phase(origin)


@dataclass(frozen=True)
class Conservative(PhaseCondition):
    """The phase condition of systems that conserve energy, whose orbits come in families.

    It determines a parameter that would dissipate energy, such as a damping, which so stays 0 (Munoz-Almaraz
    et al., Physica D 181, 2003); the angular frequency is then a parameter like any other. Two multipliers
    are 1 whatever the parameters.
    """

    unit = 2


@dataclass(frozen=True)
class _Phase:
    """The phase condition with respect to one orbit."""

    origin: Orbit

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient; mesh points that move carry the origin's slope with them."""
        slope, k = self.origin.node_rates, len(orbit.phases)
        weighted = Metric.weights(self.origin)[:, None] * slope
        outer = np.zeros(k + len(free))
        outer[:k] = -np.einsum("jn,jn,jk->k", weighted, slope, node_phase_gradient(orbit))
        value = np.einsum("jn,jn->", weighted, orbit.nodes - self.origin.nodes)
        value += outer[:k] @ (orbit.phases - self.origin.phases)
        return Row(float(value), weighted, outer)
