"""One arithmetic for Newton increments, tangents and differences of orbits, and their metric."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np

from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.orbit.shallow import shallow

STEEP = 5.0
"""Rates of the states, in sizes a rad, from which on an orbit with kinks is steep.

This and the next two shape the metric, so they decide how many points there are, and nothing else: with each
of them half and twice as large 16 models drawn at random have the same special points, to 1e-9 in the
parameter, on branches of 4 % more or fewer points.
"""

BRIEF = 0.02
"""Length (rad) of excursions below which distances of orbits include those of the logarithms of the lengths:
beside a grazing an orbit hardly changes while the excursion grows by decades. See `STEEP`."""

E_FOLD = 0.03
"""Distance of orbits whose brief excursions differ by a factor of e, in parameter ranges; see `STEEP`."""


class Unknowns(Protocol):
    """A change of an orbit and of its free parameters: what continuation adds, scales, measures and carries.

    `Increment` is one; a discretisation of another kind brings its own.
    """

    @property
    def parameters(self) -> Array:
        """Changes of the free parameters, shape (q,), the continuation parameter first."""

    def __add__(self, other: Self) -> Self:
        """Return the sum of two changes of the same orbit."""

    def scaled(self, factor: float) -> Self:
        """Return the change times a factor.

        Parameters
        ----------
        factor : float
            The factor.

        Returns
        -------
        Unknowns
            The multiple.
        """

    def dot(self, other: Self, orbit: Orbit, scale: float | Array, size: float = 1.0) -> float:
        """Return the scalar product in the metric of continuation.

        Parameters
        ----------
        other : Unknowns
            A change of the same orbit.
        orbit : Orbit
            The orbit, whose mesh weights the states.
        scale : float or ndarray, shape (q,)
            Unit of arclength in the continuation parameter (SI), or those in all free parameters.
        size : float
            Unit of arclength in the states (scaled).

        Returns
        -------
        float
            The scalar product.
        """

    def restricted(self, old: Orbit, new: Orbit, later: float = 0.0) -> Self:
        """Return the parts that the arclength constraint needs, on another mesh.

        Parameters
        ----------
        old, new : Orbit
            Orbits on the present mesh and on the other one.
        later : float
            How much later in phase (rad) it is taken.

        Returns
        -------
        Unknowns
            The change on the mesh of `new`.
        """

    def save(self) -> dict[str, Array]:
        """Return the arrays that it is made of, by name."""


@dataclass(frozen=True)
class Increment:
    """A change of an `Orbit`; see `Unknowns`.

    Parameters
    ----------
    nodes, stages, algebraic : ndarray, shapes (N+1, n), (N, ncol, n), (N, ncol, m)
        Of states and unknowns at points that move with the mesh.
    phases : ndarray, shape (k,)
        Of the event nodes' phases.
    parameters : ndarray, shape (q,)
        Of the free parameters, the continuation parameter first.
    profile : ndarray, shape (N+1, n)
        Of the states at the mesh points, at fixed tau.
    """

    nodes: Array
    stages: Array
    algebraic: Array
    phases: Array
    parameters: Array
    profile: Array

    @classmethod
    def of(
        cls, orbit: Orbit, nodes: Array, stages: Array, algebraic: Array, phases: Array, parameters: Array
    ) -> Self:
        """Return an increment whose profile follows from the others.

        Parameters
        ----------
        orbit : Orbit
            The orbit that is changed.
        nodes, stages, algebraic, phases, parameters : ndarray
            As in `Increment`.

        Returns
        -------
        Increment
            With the states' change at fixed tau as profile.
        """
        return cls(nodes, stages, algebraic, phases, parameters, at_fixed_phase(orbit, nodes, phases))

    @property
    def parameter(self) -> float:
        """Change of the continuation parameter."""
        return float(self.parameters[0])

    @property
    def others(self) -> Array:
        """Changes of the further free parameters, shape (q-1,)."""
        return self.parameters[1:]

    @property
    def _arrays(self) -> tuple[Array, ...]:
        return self.nodes, self.stages, self.algebraic, self.phases, self.parameters, self.profile

    def __add__(self, other: Self) -> Self:
        return type(self)(*(a + b for a, b in zip(self._arrays, other._arrays, strict=True)))

    def scaled(self, factor: float) -> Self:
        """Return the increment times a factor."""
        return type(self)(*(factor * array for array in self._arrays))

    def dot(self, other: Self, orbit: Orbit, scale: float | Array, size: float = 1.0) -> float:
        """Return the mean over the period of <x, y>/size^2, x and y at fixed tau, plus p q / scale^2.

        With kinks the mean has the weights `metric_weights`, and brief excursions add `length_metric`'s part.
        """
        states = np.einsum("j,jn,jn->", metric_weights(orbit), self.profile, other.profile)
        lengths = length_metric(orbit, self.phases) @ other.phases
        return float(states) / size**2 + outer(self, other, scale) + float(lengths)

    def restricted(self, old: Orbit, new: Orbit, later: float = 0.0) -> Self:
        """Return profile and parameters on the mesh of `new`, taken `later` (rad) than its mesh points.

        Changes of phases are kept where the events are the same: beside a grazing only excursions' lengths
        show how far along a branch an orbit is.
        """
        at, where = old.mesh.nodes(old.phases), new.mesh.nodes(new.phases) + later
        wrapped = at[0] + np.mod(where - at[0], old.mesh.period)
        profile = np.stack([np.interp(wrapped, at, column) for column in self.profile.T], axis=1)
        blank, same = parameter_only(new, self.parameter), new.mesh.events == old.mesh.events and not later
        phases = self.phases if same else blank.phases
        return type(self)(blank.nodes, blank.stages, blank.algebraic, phases, self.parameters, profile)

    def rate_of(self, row: Row) -> float:
        """Return how fast a number of an orbit changes along the increment, by its gradient.

        Parameters
        ----------
        row : Row
            The number.

        Returns
        -------
        float
            Its derivative.
        """
        found = np.vdot(row.nodes, self.nodes) + row.outer @ np.append(self.phases, self.parameters)
        return float(found if row.stages is None else found + np.vdot(row.stages, self.stages))

    def save(self) -> dict[str, Array]:
        """Return the arrays by name."""
        return shallow(self)


def outer(a: Unknowns, b: Unknowns, scale: float | Array) -> float:
    """Return the free parameters' part of a scalar product: of all that both have, or of the first alone."""
    if not isinstance(scale, np.ndarray):
        return float(a.parameters[0] * b.parameters[0]) / scale**2
    count = min(len(a.parameters), len(b.parameters))
    return float(np.sum(a.parameters[:count] * b.parameters[:count] / scale[:count] ** 2))


def parameter_only(orbit: Orbit, rate: float) -> Increment:
    """Return the increment in which only the continuation parameter changes."""
    zero = np.zeros_like(orbit.nodes)
    stages, algebraic = np.zeros_like(orbit.stages), np.zeros_like(orbit.algebraic)
    return Increment(zero, stages, algebraic, np.zeros_like(orbit.phases), np.array([rate]), zero)


def size_of(orbit: Orbit) -> float:
    """The unit of arclength in the states: the amplitude of a motion, where that is more than 1."""
    return max(1.0, orbit.span() / 2)


def mean_weights(orbit: Orbit) -> Array:
    """Trapezoidal weights of the mesh points over one period, shape (N+1,); their sum is 1."""
    return orbit.grid.mean_weights


def metric_weights(orbit: Orbit) -> Array:
    """Mean weights that count less where an orbit with kinks is steep, shape (N+1,).

    At fixed tau a hard contact that comes a little later changes the velocity by all it has; so distances are
    measured where an orbit is not steep, with 1 / (1 + x'^4) of the weight, x' in `STEEP` sizes a rad.
    """
    weights = mean_weights(orbit)
    if len(orbit.mesh.exact_ends) == 0:
        return weights
    steep = np.abs(orbit.node_rates).max(axis=1) / (STEEP * size_of(orbit))
    return weights / (1 + steep**4)


def length_metric(orbit: Orbit, phases: Array) -> Array:
    """Return the metric of excursions' lengths times changes of the event nodes' phases (k,), shape (k,).

    The metric sums the squares of changes of excursions' lengths, relative where they are brief. Within an
    excursion the motion may be turned by friction.
    """
    found = np.zeros(len(orbit.mesh.events))
    if len(orbit.mesh.exact_ends) == 0:
        return found
    lengths = excursion_lengths(orbit)
    for (i, j), length in zip(orbit.mesh.excursions, lengths, strict=True):
        weight = (E_FOLD / length) ** 2 / (1 + (length / BRIEF) ** 4)
        found[[i, j]] += weight * (phases[j] - phases[i]) * np.array([-1.0, 1.0])
    return found


def excursion_lengths(orbit: Orbit) -> Array:
    """Return the lengths of excursions (rad), in the order of `mesh.excursions`."""
    lengths = orbit.mesh.segment_lengths(orbit.phases)
    parts = [range(i, j if i < j else j + len(lengths)) for i, j in orbit.mesh.excursions]
    return np.array([sum(lengths[m % len(lengths)] for m in part) for part in parts], dtype=float)


def node_phase_gradient(orbit: Orbit) -> Array:
    """How the mesh points' phases follow those of the event nodes, shape (N+1, k)."""
    gradient = orbit.grid.left_gradient
    return np.concatenate([gradient, gradient[:1]])


def at_fixed_phase(orbit: Orbit, nodes: Array, phases: Array) -> Array:
    """Turn increments of mesh-point states that move with the mesh into increments at fixed tau."""
    if len(phases) == 0:
        return nodes
    return nodes - orbit.node_rates * (node_phase_gradient(orbit) @ phases)[:, None]
