"""Orbits as truncated Fourier series, carried by equidistant samples.

    x(tau) = a_0 + sum_k a_k cos k w tau + b_k sin k w tau,   k = 1..H,   w = 2 pi / period

The 2 (H+1) mesh points and the points midway between them are 4 (H+1) samples, enough to project
a cubic term without aliasing. Coefficients are ordered a_0, a_1..a_H, b_1..b_H along the first axis.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.construction import transfer
from periodic.orbit.mesh import Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Scheme


@dataclass(frozen=True)
class Halves(Scheme):
    """An interval's samples: its middle and its right end. They are no points to collocate at."""

    ncol: int = 2

    @cached_property
    def points(self) -> Array:
        """The samples' places, shape (2,)."""
        return np.array([0.5, 1.0])

    @cached_property
    def weights(self) -> Array:
        """Weights of the trapezoidal rule, which is exact for the harmonics that the samples represent."""
        return np.array([0.5, 0.5])


SAMPLES = Halves()

NO_PHASES = np.zeros(0)
"""The event nodes of a Fourier series: it has none."""


def mesh_for(harmonics: int, period: float) -> Mesh:
    """Return the mesh for a number of harmonics of the orbit's period."""
    return uniform(SAMPLES, 2 * (harmonics + 1), period)


def harmonics_of(mesh: Mesh) -> int:
    """The number of harmonics H that a mesh carries."""
    return mesh.ntst // 2 - 1


def basis(harmonics: int, angle: Array) -> Array:
    """1, cos k angle, sin k angle: shape (len(angle), 2H+1)."""
    each = angle[:, None] * np.arange(1, harmonics + 1)
    return np.concatenate([np.ones((len(angle), 1)), np.cos(each), np.sin(each)], axis=1)


def basis_slope(harmonics: int, angle: Array) -> Array:
    """Derivatives of the basis in the angle, shape (len(angle), 2H+1)."""
    k = np.arange(1, harmonics + 1)
    each = angle[:, None] * k
    return np.concatenate([np.zeros((len(angle), 1)), -k * np.sin(each), k * np.cos(each)], axis=1)


@dataclass(frozen=True)
class Transform:
    """Values and slopes of the basis at S samples (S, 2H+1) and at mesh points (N+1, 2H+1), and the inverse.

    analysis (2H+1, S) takes samples to coefficients.
    """

    values: Array
    slopes: Array
    analysis: Array
    nodes: Array


@lru_cache(maxsize=64)
def transform(harmonics: int) -> Transform:
    """Return the transform for H harmonics; the first sample lies one step after angle 0."""
    count = 4 * (harmonics + 1)
    angle = 2 * np.pi * np.arange(1, count + 1) / count
    values = basis(harmonics, angle)
    analysis = 2 * values.T / count
    analysis[0] /= 2
    return Transform(values, basis_slope(harmonics, angle), analysis, values[np.arange(-1, count, 2)])


@dataclass(frozen=True, eq=False, repr=False)
class FourierOrbit(Orbit):
    """An orbit that is evaluated as the Fourier series through its samples."""

    def __repr__(self) -> str:
        return (
            f"FourierOrbit({self.harmonics} harmonics, {self.nodes.shape[1]} states, {self.periods} periods)"
        )

    @property
    def harmonics(self) -> int:
        """The number of harmonics of the orbit's own period."""
        return harmonics_of(self.mesh)

    @property
    def frequency(self) -> float:
        """w, the orbit's frequency in that of the excitation: 1 over its number of periods."""
        return 2 * np.pi / self.mesh.period

    @cached_property
    def coefficients(self) -> Array:
        """Fourier coefficients of the states, shape (2H+1, n)."""
        return transform(self.harmonics).analysis @ self.stages.reshape(-1, self.nodes.shape[1])

    @property
    def amplitudes(self) -> Array:
        """Amplitude of each harmonic 1..H, that of the state in which it is largest; shape (H,)."""
        cosine, sine = self.coefficients[1 : self.harmonics + 1], self.coefficients[self.harmonics + 1 :]
        return np.asarray(np.hypot(cosine, sine).max(axis=1))

    @cached_property
    def knot_rates(self) -> Array:
        """dx/dtau at the mesh points and samples, shape (N, 3, n)."""
        rates = self.frequency * transform(self.harmonics).slopes @ self.coefficients
        stages = rates.reshape(self.stages.shape)
        return np.concatenate([np.roll(stages[:, -1:], 1, axis=0), stages], axis=1)

    def state(self, tau: Array) -> Array:
        """States at phases tau, shape (len(tau), n)."""
        return basis(self.harmonics, self.frequency * tau) @ self.coefficients

    def rate(self, tau: Array) -> Array:
        """dx/dtau at phases tau, shape (len(tau), n)."""
        return self.frequency * basis_slope(self.harmonics, self.frequency * tau) @ self.coefficients

    def spread(
        self, index: NDArray[np.int_], theta: Array, by_state: Array, by_rate: Array
    ) -> tuple[Array, Array]:
        """Return derivatives in the samples; those in the mesh points are 0: samples determine the series."""
        angle = self.frequency * (self.grid.left[index] + theta * self.grid.width[index])
        gradient = basis(self.harmonics, angle).T @ by_state
        gradient += self.frequency * basis_slope(self.harmonics, angle).T @ by_rate
        stages = transform(self.harmonics).analysis.T @ gradient
        return np.zeros_like(self.nodes), stages.reshape(self.stages.shape)

    def algebraic_guess(self, tau: Array) -> Array:
        """Unknowns at phases tau, interpolated linearly between samples, shape (len(tau), m)."""
        flat = self.algebraic.reshape(2 * self.mesh.ntst, self.algebraic.shape[2])
        place = np.mod(tau / self.mesh.period, 1.0) * len(flat)
        below = np.floor(place).astype(int)
        part = (place - below)[:, None]
        return (1 - part) * flat[(below - 1) % len(flat)] + part * flat[below % len(flat)]

    def collocated(self) -> Orbit:
        """The orbit as a piecewise polynomial on the same mesh points."""
        return transfer(self, Mesh(Scheme(), self.mesh.breaks, (), self.mesh.period), NO_PHASES)


def series(orbit: Orbit, mesh: Mesh) -> FourierOrbit:
    """Return any orbit as the Fourier series that a mesh carries, fitted to its values at the samples."""
    samples = transform(harmonics_of(mesh))
    count = len(samples.values)
    tau = float(mesh.period / count) * np.arange(1, count + 1).astype(float)
    coefficients = samples.analysis @ orbit.state(tau)
    return FourierOrbit(
        mesh,
        samples.nodes @ coefficients,
        (samples.values @ coefficients).reshape(mesh.ntst, 2, orbit.nodes.shape[1]),
        orbit.algebraic_guess(tau).reshape(mesh.ntst, 2, orbit.algebraic.shape[2]),
        NO_PHASES,
        orbit.parameter,
        layout=orbit.layout,
    )


def tail(orbit: FourierOrbit, least: float) -> float:
    """Largest peak to peak of a harmonic among the last quarter, over the orbit's or `least`."""
    last = max(orbit.harmonics // 4, min(2, orbit.harmonics))
    return float(2 * orbit.amplitudes[-last:].max() / max(orbit.span(), least))
