"""Harmonic balance by alternating frequency and time, linearised.

The residual R(x', x, z, tau, p) of a Fourier series x is sampled, z eliminated sample by sample, and its
Fourier coefficients up to H made zero (Cameron & Griffin 1989; Krack & Gross 2019, 2.2). The unknowns are
the coefficients c of x and the free parameters y:

    J dc + Y dy + r = 0,   J = projection of E d/dtau + A,   E = dR/dx',  A = dR/dx.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from periodic.collocation.residual import eliminate, evaluated, rows_of
from periodic.harmonic.series import NO_PHASES, FourierOrbit, transform
from periodic.linear import bordered
from periodic.linear.unknowns import Increment
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System


@dataclass(frozen=True)
class Samples:
    """Linearised rows at the S samples without z: columns (S, n, w) of residual, E, A, dy, w = 1+2n+q.

    algebraic (S, m, w) maps (1, d rate, d state, dy) to -dz; residual is the largest one.
    """

    columns: Array
    algebraic: Array
    residual: float

    @property
    def d_rate(self) -> Array:
        """E at the samples, shape (S, n, n)."""
        return self.columns[:, :, 1 : 1 + self.columns.shape[1]]

    @property
    def d_state(self) -> Array:
        """A at the samples, shape (S, n, n)."""
        n = self.columns.shape[1]
        return self.columns[:, :, 1 + n : 1 + 2 * n]


def sampled(system: System, orbit: FourierOrbit, free: tuple[int, ...]) -> Samples:
    """Linearise at the samples.

    Raises FloatingPointError where the equations are not finite, numpy.linalg.LinAlgError where z cannot be
    eliminated.
    """
    rows = rows_of(orbit, evaluated(system, orbit, free))
    columns, algebraic = eliminate(rows, orbit.nodes.shape[1])
    return Samples(columns, algebraic, rows.residual)


def projected(d_rate: Array, d_state: Array, frequency: float) -> Array:
    """Coefficients of E x' + A x from those of x: real matrix ((2H+1) rows, (2H+1) n), harmonic by harmonic.

    In complex coefficients its blocks are A_(k-l) + i l w E_(k-l).
    """
    count = len(d_rate)
    harmonics = count // 4 - 1
    E, A = (np.fft.fft(np.roll(a, 1, axis=0), axis=0) / count for a in (d_rate, d_state))
    column = np.arange(-harmonics, harmonics + 1)
    gap = np.arange(harmonics + 1)[:, None] - column
    blocks = A[gap] + 1j * frequency * column[:, None, None] * E[gap]
    plus, minus = blocks[:, harmonics + 1 :], blocks[:, :harmonics][:, ::-1]
    columns = np.concatenate(
        [blocks[:, harmonics : harmonics + 1], (plus + minus) / 2, (plus - minus) / 2j], axis=1
    )
    rows = np.concatenate([columns[:1].real, 2 * columns[1:].real, -2 * columns[1:].imag])
    height, width = ((2 * harmonics + 1) * each for each in d_rate.shape[1:])
    return np.ascontiguousarray(rows.transpose(0, 2, 1, 3)).reshape(height, width)


@dataclass(frozen=True)
class Balance:
    """The balanced equations of a Fourier series, see `periodic.linear.operator.Operator`."""

    orbit: FourierOrbit
    samples: Samples

    @property
    def residual(self) -> float:
        """The largest residual."""
        return self.samples.residual

    @property
    def fundamental(self) -> Array:
        """Unknown here (NaN): Hill's method computes them once the orbit is found."""
        n = self.orbit.nodes.shape[1]
        return np.full((1, n, n), np.nan)

    @property
    def effect(self) -> Array:
        """Approximate size of the change of states with each free parameter, shape (q,)."""
        first = 1 + 2 * self.orbit.nodes.shape[1]
        return np.asarray(np.abs(self.samples.columns[:, :, first:]).max(axis=(0, 1)))

    def solve(self, rows: Sequence[Row], right: Array) -> tuple[Increment, ...]:
        """Return an increment for each column of `right`, shape (1 + len(rows), columns).

        Raises numpy.linalg.LinAlgError where the bordered matrix is singular.
        """
        orbit, samples = self.orbit, self.samples
        n = orbit.nodes.shape[1]
        analysis = transform(orbit.harmonics).analysis
        matrix = projected(samples.d_rate, samples.d_state, orbit.frequency)
        size, q = len(matrix), samples.columns.shape[2] - 1 - 2 * n
        outer = np.tensordot(analysis, samples.columns[:, :, 1 + 2 * n :], 1).reshape(size, q)
        constant = (analysis @ samples.columns[:, :, 0]).reshape(size, 1)
        own = np.hstack([constant, matrix, outer])
        found = bordered.solve(np.vstack([own, *(on_coefficients(orbit, row) for row in rows)]), right)
        return tuple(self._recovered(*pair) for pair in zip(right[0], found.T, strict=True))

    def _recovered(self, constant: float, solution: Array) -> Increment:
        """The increment of samples and unknowns for that of (c, y) in each column."""
        orbit, samples = self.orbit, self.samples
        basis, n = transform(orbit.harmonics), orbit.nodes.shape[1]
        size = basis.values.shape[1] * n
        coefficients, outer = solution[:size].reshape(-1, n), solution[size:]
        states = basis.values @ coefficients
        rates = orbit.frequency * basis.slopes @ coefficients
        count = len(states)
        head = [np.full((count, 1), constant), rates, states, np.broadcast_to(outer, (count, len(outer)))]
        algebraic = -np.einsum("smw,sw->sm", samples.algebraic, np.concatenate(head, axis=1))
        nodes, shape = basis.nodes @ coefficients, orbit.stages.shape
        unknowns = algebraic.reshape(orbit.algebraic.shape)
        return Increment(nodes, states.reshape(shape), unknowns, NO_PHASES, outer, nodes)


def on_coefficients(orbit: FourierOrbit, row: Row) -> Array:
    """Return a row's value and its gradient in the coefficients and the free parameters, (1+(2H+1)n+q,)."""
    n, basis = orbit.nodes.shape[1], transform(orbit.harmonics)
    gradient = basis.nodes.T @ row.nodes
    if row.stages is not None:
        gradient += basis.values.T @ row.stages.reshape(-1, n)
    return np.concatenate([[row.value], gradient.ravel(), row.outer])
