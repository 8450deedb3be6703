"""A periodic orbit: a piecewise polynomial on a mesh, and ways to evaluate it.

Inside, states are scaled and functions of the phase tau; read by name, `orbit["x"](t)`, they are functions of
time in SI units.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.checks import ByName
from periodic.display.htmltables import paragraph
from periodic.orbit.layout import Layout, Source
from periodic.orbit.mesh import Grid, Mesh
from periodic.orbit.orbitoverview import orbit_html
from periodic.orbit.scheme import Array
from periodic.orbit.signal import Signal

FORCED = 2 * np.pi
"""Period of the excitation in tau."""

LEAST_SPAN = 1e-6
"""Peak to peak (scaled) below which an orbit is at rest; errors are compared with no less."""


@dataclass(frozen=True, eq=False, repr=False)
class Orbit:
    """A periodic orbit on a mesh of N intervals with ncol collocation points each.

    Its arrays are scaled: SI value = scale * value, with the scales of `layout`.

    Parameters
    ----------
    mesh : Mesh
        The intervals, with the scheme of each.
    nodes : Array
        States at the mesh points, shape (N+1, n).
    stages : Array
        States at the collocation points, shape (N, ncol, n).
    algebraic : Array
        Unknowns at the collocation points, shape (N, ncol, m).
    phases : Array
        The event nodes' places in tau, shape (k,).
    parameter : Array
        The system's parameters, shape (p,).
    equilibrium : bool
        Whether it is a constant, on a mesh of one interval.
    layout : Layout, optional
        Names, units and scales; without it an orbit cannot be read by name.
    """

    mesh: Mesh
    nodes: Array
    stages: Array
    algebraic: Array
    phases: Array
    parameter: Array
    equilibrium: bool = False
    layout: Layout | None = None

    def __repr__(self) -> str:
        if self.equilibrium:
            return f"Orbit(equilibrium, {self.nodes.shape[1]} states)"
        return f"Orbit({self.mesh.ntst} intervals, {self.nodes.shape[1]} states, {self.periods} periods)"

    def _repr_html_(self) -> str:
        if self.equilibrium or self.layout is None:
            return paragraph(repr(self))
        caption = f"{self!r}: period {self.period:.9g} s, Omega {self.omega:.9g} rad/s"
        return orbit_html(caption, [self[name] for name in self.names], self.period)

    def __getitem__(self, name: str) -> Signal:
        """Return a signal in SI units over time in s.

        Parameters
        ----------
        name : str
            A state, `orbit["x"]`; its velocity dx/dt, `orbit["x'"]`, in m/s for a state in m, though the
            state that the system calls x' is dx/dtau; with one more prime the derivative of that. Or an
            unknown, interpolated between collocation points.

        Returns
        -------
        Signal
            A function of t (s), of any shape; t = 0 is tau = 0.

        Raises
        ------
        ValueError
            For a name that is none of the orbit's, and where nothing tells times in s.
        """
        column = self._known.column(name)
        omega = 1.0 if self.equilibrium else self.omega
        take = {Source.STATE: self.state, Source.RATE: self.rate, Source.ALGEBRAIC: self.algebraic_guess}
        return Signal(column, omega, take[column.source])

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the states and unknowns that can be read."""
        return self._known.names

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters in SI units, by name."""
        both = zip(self._known.parameters, self.parameter, strict=True)
        return ByName("parameter", {q.name: q.scale * float(value) for q, value in both})

    @property
    def omega(self) -> float:
        """Angular frequency Omega (rad/s) of the excitation, or of an autonomous orbit: tau = Omega t."""
        return self._known.omega(self.parameter)

    @property
    def period(self) -> float:
        """The orbit's period in s, that of all its periods of the excitation."""
        if self.equilibrium:
            raise ValueError("orbit is an equilibrium; it has no period")
        return self.mesh.period / self.omega

    @property
    def _known(self) -> Layout:
        if self.layout is None:
            raise ValueError("orbit has no names; it must have been traced, or sampled for a system")
        return self.layout

    def expressed_in(self, layout: Layout, whose: str = "orbit") -> Orbit:
        """Return the same orbit in the scales of another layout; one without names takes them over.

        Parameters
        ----------
        layout : Layout
            Names, units and scales of the system that is to read it.
        whose : str
            What the orbit is called in a refusal.

        Returns
        -------
        Orbit
            Itself where nothing changes.

        Raises
        ------
        ValueError
            Where numbers, names or units of states, unknowns or parameters differ.
        """
        self._counted(layout, whose)
        if self.layout == layout:
            return self
        if self.layout is None:
            return replace(self, layout=layout)
        states, unknowns, parameters = self.layout.factors(layout, whose)
        return replace(
            self,
            nodes=self.nodes * states,
            stages=self.stages * states,
            algebraic=self.algebraic * unknowns,
            parameter=self.parameter * parameters,
            layout=layout,
        )

    def _counted(self, layout: Layout, whose: str) -> None:
        counts = {
            "states": (self.nodes.shape[1], len(layout.states)),
            "algebraic unknowns": (self.algebraic.shape[2], len(layout.algebraics)),
            "parameters": (len(self.parameter), len(layout.parameters)),
        }
        for kind, (given, wanted) in counts.items():
            if given != wanted:
                raise ValueError(f"{whose} has {given} {kind}; it must have the {wanted} of the system")

    @cached_property
    def grid(self) -> Grid:
        """The mesh at this orbit's event node phases."""
        return self.mesh.grid(self.phases)

    @cached_property
    def knots(self) -> Array:
        """Values at the knots of each interval, shape (N, ncol+1, n)."""
        return np.concatenate([self.nodes[:-1, None, :], self.stages], axis=1)

    @cached_property
    def knot_rates(self) -> Array:
        """dx/dtau at the knots, shape (N, ncol+1, n).

        From differences to each interval's begin, which are exact: rounding grows with 1 / width otherwise.
        """
        apart = self.stages - self.nodes[:-1, None, :]
        return self.mesh.scheme.differentiation[:, 1:] @ apart / self.grid.width[:, None, None]

    @property
    def stage_phases(self) -> Array:
        """Phases tau of the collocation points, shape (N, ncol)."""
        return self.grid.left[:, None] + self.grid.width[:, None] * self.mesh.scheme.points

    @cached_property
    def node_rates(self) -> Array:
        """dx/dtau at the mesh points, from the interval on the right; shape (N+1, n)."""
        rates = self.knot_rates[:, 0, :]
        return np.concatenate([rates, rates[:1]])

    @property
    def end_rates(self) -> Array:
        """dx/dtau at the mesh points, where the scheme collocates at their ends as exact as the equations.

        From the interval on the left, shape (N+1, n).
        """
        if self.mesh.scheme.points[-1] < 1.0:
            return self.node_rates
        rates = self.knot_rates[:, -1, :]
        return np.concatenate([rates[-1:], rates])

    def locate(self, tau: Array) -> tuple[NDArray[np.int_], Array]:
        """Return where phases lie on the mesh.

        Parameters
        ----------
        tau : ndarray, shape (K,)
            Phases in rad, of any period.

        Returns
        -------
        index : ndarray, shape (K,)
            Interval.
        theta : ndarray, shape (K,)
            Place within it, in [0, 1].
        """
        begin = self.grid.left[0]
        wrapped = begin + np.mod(tau - begin, self.mesh.period)
        index = np.clip(np.searchsorted(self.grid.left, wrapped, side="right") - 1, 0, self.mesh.ntst - 1)
        theta = np.clip((wrapped - self.grid.left[index]) / self.grid.width[index], 0.0, 1.0)
        return index, theta

    def state(self, tau: Array) -> Array:
        """Return the scaled states x(tau).

        Parameters
        ----------
        tau : ndarray, shape (K,)
            Phases in rad.

        Returns
        -------
        ndarray, shape (K, n)
            Scaled; `orbit["x"](t)` gives SI values at times.
        """
        index, theta = self.locate(tau)
        return np.einsum("tl,tln->tn", self.mesh.scheme.basis(theta), self.knots[index])

    def rate(self, tau: Array) -> Array:
        """Return the rates dx/dtau of the scaled states.

        Parameters
        ----------
        tau : ndarray, shape (K,)
            Phases in rad.

        Returns
        -------
        ndarray, shape (K, n)
            Scaled; `orbit["x'"](t)` gives velocities dx/dt.
        """
        index, theta = self.locate(tau)
        return np.einsum("tl,tln->tn", self.mesh.scheme.basis(theta), self.knot_rates[index])

    def spread(
        self, index: NDArray[np.int_], theta: Array, by_state: Array, by_rate: Array
    ) -> tuple[Array, Array]:
        """Turn derivatives in states and rates at points into derivatives in mesh points and stages.

        The phases of the event nodes are held.

        Parameters
        ----------
        index, theta : ndarray, shape (P,)
            The points, as from `locate`.
        by_state, by_rate : ndarray, shape (P, n)
            Derivatives in the states and rates there.

        Returns
        -------
        nodes : ndarray, shape (N+1, n)
            Derivatives in the states at the mesh points.
        stages : ndarray, shape (N, ncol, n)
            Derivatives in the states at the collocation points.
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
        """Return the unknowns, interpolated within each interval: a guess for what the algebraic rows give.

        Parameters
        ----------
        tau : ndarray, shape (K,)
            Phases in rad.

        Returns
        -------
        ndarray, shape (K, m)
            Scaled.
        """
        index, theta = self.locate(tau)
        return np.einsum("tl,tlm->tm", self.mesh.scheme.algebraic_basis(theta), self.algebraic[index])

    @property
    def periods(self) -> int:
        """How many periods of the excitation the orbit takes to come back."""
        return round(self.mesh.period / FORCED)

    def collocated(self) -> Orbit:
        """Return the orbit as a piecewise polynomial on the same mesh points.

        Returns
        -------
        Orbit
            Itself, where it is no Fourier series.
        """
        return self

    def span(self) -> float:
        """Return the largest peak-to-peak value of the scaled states: what errors are compared with.

        Returns
        -------
        float
            1, the size of scaled states, for an equilibrium.
        """
        return self._span

    @cached_property
    def _span(self) -> float:
        if self.equilibrium:
            return 1.0
        flat = self.knots.reshape(-1, self.knots.shape[2])
        return float((flat.max(axis=0) - flat.min(axis=0)).max())
