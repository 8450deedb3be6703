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

from periodic import collocation
from periodic.closure import Closure, Direction, Row
from periodic.fourier import NO_PHASES, FourierOrbit, transform
from periodic.newton import Outcome, Step, moved, sizes
from periodic.orbit import Orbit
from periodic.scheme import Array
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
    rows, residual = collocation.linearised(system, orbit, free)
    columns, algebraic = collocation.eliminate(rows, orbit.nodes.shape[1])
    return Samples(columns, algebraic, residual)


def projected(d_rate: Array, d_state: Array, frequency: float) -> Array:
    """Coefficients of E x' + A x from those of x: real matrix of size (2H+1) n, harmonic by harmonic.

    In complex coefficients its blocks are A_(k-l) + i l w E_(k-l).
    """
    count, n, _ = d_rate.shape
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
    size = (2 * harmonics + 1) * n
    return np.ascontiguousarray(rows.transpose(0, 2, 1, 3)).reshape(size, size)


def increment(
    system: System, orbit: Orbit, free: tuple[int, ...], closures: Sequence[Closure]
) -> Step | Outcome:
    """Return one Newton increment, or why there is none; its fundamental matrices are left out (NaN)."""
    assert isinstance(orbit, FourierOrbit)
    try:
        samples = sampled(system, orbit, free)
        both = _solve(orbit, samples, [c.linearise(system, orbit, free) for c in closures])
    except FloatingPointError:
        return Outcome.NOT_FINITE
    except np.linalg.LinAlgError:
        return Outcome.SINGULAR
    newton, kernel = (_recovered(orbit, samples, both[:, k], 1.0 - k) for k in (0, 1))
    change = moved(system, orbit.algebraic, newton.algebraic) - orbit.algebraic
    n = orbit.nodes.shape[1]
    effect = np.abs(samples.columns[:, :, 1 + 2 * n :]).max(axis=(0, 1))
    moves = (newton.nodes, newton.stages, change, newton.outer)
    size, length = sizes(orbit, *moves, free, effect, system.nominal)
    return Step(
        orbit,
        newton.nodes,
        newton.stages,
        newton.algebraic,
        newton.outer,
        size,
        length,
        samples.residual,
        np.full((1, n, n), np.nan),
        kernel.direction() if closures else None,
    )


def _solve(orbit: FourierOrbit, samples: Samples, rows: Sequence[Row]) -> Array:
    """Newton increment and kernel of (c, y), shape (size, 2). Raises LinAlgError where there is none."""
    n = orbit.nodes.shape[1]
    analysis = transform(orbit.harmonics).analysis
    matrix = projected(samples.d_rate, samples.d_state, orbit.frequency)
    size, q = len(matrix), samples.columns.shape[2] - 1 - 2 * n
    outer = np.tensordot(analysis, samples.columns[:, :, 1 + 2 * n :], 1).reshape(size, q)
    border = [on_coefficients(orbit, row) for row in rows]
    lower = np.array([np.append(row.nodes, row.outer) for row in border]).reshape(len(rows), size + q)
    right = np.zeros((size + len(rows), 2))
    right[:size, 0] = -(analysis @ samples.columns[:, :, 0]).ravel()
    right[size:, 0] = [-row.value for row in border]
    right[-1, 1] = 1.0
    both = np.linalg.solve(np.vstack([np.hstack([matrix, outer]), lower]), right)
    if not np.isfinite(both).all():
        raise np.linalg.LinAlgError("the bordered matrix is singular")
    return both


def on_coefficients(orbit: FourierOrbit, row: Row) -> Row:
    """Return a closure whose `nodes` are the gradient in the coefficients, (2H+1, n)."""
    n, basis = orbit.nodes.shape[1], transform(orbit.harmonics)
    gradient = basis.nodes.T @ row.nodes
    if row.stages is not None:
        gradient += basis.values.T @ row.stages.reshape(-1, n)
    return Row(row.value, gradient, row.outer)


@dataclass(frozen=True)
class _Increments:
    """Increments of an orbit's values that go with some of its coefficients and of the free parameters."""

    nodes: Array
    stages: Array
    algebraic: Array
    outer: Array

    def direction(self) -> Direction:
        """As a direction along the solution set; not yet of unit length."""
        return Direction(
            self.nodes, self.stages, self.algebraic, NO_PHASES, self.nodes, self.outer[0], self.outer[1:]
        )


def _recovered(orbit: FourierOrbit, samples: Samples, solution: Array, constant: float) -> _Increments:
    """Increments from a solution (c, y); constant is 1 for a Newton step, 0 for the kernel."""
    basis, n = transform(orbit.harmonics), orbit.nodes.shape[1]
    size = basis.values.shape[1] * n
    coefficients, outer = solution[:size].reshape(-1, n), solution[size:]
    states = basis.values @ coefficients
    rates = orbit.frequency * basis.slopes @ coefficients
    count = len(states)
    head = [np.full((count, 1), constant), rates, states, np.broadcast_to(outer, (count, len(outer)))]
    algebraic = -np.einsum("smw,sw->sm", samples.algebraic, np.concatenate(head, axis=1))
    return _Increments(
        basis.nodes @ coefficients,
        states.reshape(orbit.stages.shape),
        algebraic.reshape(orbit.algebraic.shape),
        outer,
    )
