"""A system of surfaces alone: switches that are given functions of the state, for what reads words of orbits.

The states of its orbits are given functions of tau as well, so that places and values are known by hand.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from periodic.orbit.mesh import EventNode, Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Scheme
from periodic.system import Kind
from periodic.system.events import Surface
from support.numpy_systems import Array, Quantity, Switch


class Surfaces:
    """Switches that are linear in the states: s = weights x + offset, shape (switches, n) and (switches,)."""

    algebraics: tuple[Quantity, ...] = ()
    outputs: tuple[Quantity, ...] = ()

    def __init__(
        self,
        surfaces: Sequence[Surface],
        weights: Sequence[Sequence[float]],
        offset: Sequence[float] = (),
        directions: Sequence[int] = (),
        guards_depend: bool = False,
    ) -> None:
        self.surfaces = tuple(surfaces)
        self.weights = np.array(weights, dtype=float)
        self.offset = np.array(offset or np.zeros(len(weights)), dtype=float)
        ways = [*directions, *([0] * len(weights))][: len(weights)]
        self.switches = tuple(Switch(f"s{k}", way) for k, way in enumerate(ways))
        self.states = tuple(Quantity(f"x{k}") for k in range(self.weights.shape[1]))
        self.parameters = (Quantity("Omega", value=1.0),)
        self.nominal = np.ones(1)
        self.resets = tuple(s.switch for s in self.surfaces if s.kind == Kind.IMPACT)
        self.guards_depend = guards_depend

    def rest(self, parameter: Array) -> tuple[Array, Array]:
        """All states are 0."""
        return np.zeros(len(self.states)), np.zeros(0)

    def switch(self, state: Array, phase: Array, parameter: Array, side: Any = None) -> Array:
        """The switches (N, switches)."""
        return state @ self.weights.T + self.offset

    def switch_gradient(self, state: Array, phase: Array, parameter: Array, side: Any = None) -> Any:
        """Their derivatives in states, phase and parameters."""
        shape = len(state), len(self.weights)
        return np.tile(self.weights, (len(state), 1, 1)), np.zeros(shape), np.zeros((*shape, 1))


def joint(column: int = 0, first: int = 0, kind: Kind = Kind.SLIDING, **more: Any) -> Surface:
    """A surface with the guard `first` and the releases after it."""
    return Surface(kind, f"joint {column}", first, (first + 1, first + 2), column, **more)


def along(
    states: Callable[[Array], Array],
    nodes: Sequence[tuple[EventNode, float]] = (),
    modes: Sequence[tuple[int, int]] = (),
    intervals: int = 40,
) -> Orbit:
    """The orbit of given states at phases (K,), shape (K, n), with event nodes at given phases."""
    scheme = Scheme()
    events, phases = tuple(event for event, _ in nodes), np.array([phase for _, phase in nodes], dtype=float)
    if nodes:
        each = tuple(np.linspace(0, 1, intervals // len(nodes) + 1) for _ in nodes)
        mesh = Mesh(scheme, each, events, modes=tuple(modes))
    else:
        plain = uniform(scheme, intervals)
        mesh = Mesh(scheme, plain.breaks, (), plain.period, tuple(modes))
    grid = mesh.grid(phases)
    stages = grid.left[:, None] + grid.width[:, None] * scheme.points
    found = states(stages.ravel())
    inner = found.reshape(*stages.shape, found.shape[1])
    return Orbit(mesh, states(mesh.nodes(phases)), inner, np.zeros((*stages.shape, 0)), phases, np.ones(1))


def three_joints(third: Kind = Kind.SLIDER) -> Surfaces:
    """Joints 0 (1, 2) of x, 3 (4, 5) of y and 6 (7, 8) of x - y, the last of a kind; and a kink 9 of x."""
    kinds = Kind.SLIDING, Kind.SLIDING, third
    surfaces = [joint(k, 3 * k, kind) for k, kind in enumerate(kinds)]
    weights = [*[[1.0, 0.0]] * 3, *[[0.0, 1.0]] * 3, *[[1.0, -1.0]] * 3, [1.0, 0.0]]
    return Surfaces([*surfaces, Surface(Kind.KINK, "kink", 9, column=3)], weights)


def at(*nodes: tuple[EventNode, float]) -> Orbit:
    """An orbit (sin tau, cos tau) with event nodes at given phases."""
    return along(lambda tau: np.column_stack([np.sin(tau), np.cos(tau)]), nodes, intervals=4 * len(nodes))
