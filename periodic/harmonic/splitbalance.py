"""Harmonic balance of a split system: its linear part by its dynamic flexibility, harmonic by harmonic.

With F_k the coefficient of the forces on the linear part and X_k that of its states,

    X_k = L(i k w) F_k,
    L(s) = sum_j output_j input_j / (s - lambda_j) / 2 + conjugates + direct + s direct_rate,

so that the unknowns are the Fourier coefficients of the states at the places and of the system's own states,
however many states the structures have.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.floquet import Leading, LeadingSpectrum, ModalFloquet
from periodic.condensed.linearised import Local, SplitLinearisation, local_rows
from periodic.condensed.modal.response import Response
from periodic.condensed.splitmethod import SplitMethod
from periodic.correction.error import UNKNOWN, ErrorEstimate
from periodic.correction.newton import Correction
from periodic.correction.outcome import FAILURES, outcome_of
from periodic.correction.problem import Problem
from periodic.harmonic.balance import on_coefficients, projected
from periodic.harmonic.harmonicbalance import HarmonicBalance, finer, with_unknowns
from periodic.harmonic.series import (
    NO_PHASES,
    FourierOrbit,
    basis,
    harmonics_of,
    mesh_for,
    series,
    transform,
)
from periodic.linear import bordered
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment
from periodic.orbit.algebraic import algebraic_at
from periodic.orbit.construction import transfer
from periodic.orbit.mesh import uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array, Family, Scheme
from periodic.orbit.shallow import shallow
from periodic.stability.multipliers import Spectrum
from periodic.system import LinearPart, ModesLike, System, linear_of

Complex = NDArray[np.complex128]

SCHEME = Scheme(Family.RADAU, 5)
"""Scheme by which multipliers are computed, on as many intervals as the series' mesh has, but at least 16."""


def flexibility(modes: ModesLike, frequency: Array) -> Complex:
    """Return L(i w) at frequencies (H,), shape (H, s, k)."""
    s = 1j * frequency[:, None]
    one = (modes.outputs / (s - modes.exponents)[:, None]) @ modes.inputs
    other = (modes.outputs.conj() / (s - modes.exponents.conj())[:, None]) @ modes.inputs.conj()
    return np.asarray((one + other) / 2 + modes.direct + s[:, :, None] * modes.direct_rate)


def flexibility_slope(modes: ModesLike, change: ModesLike, frequency: Array) -> Complex:
    """Return the derivative of L(i w) along a change of the modes, (H, s, k)."""
    s, found = 1j * frequency[:, None], np.zeros((len(frequency), *modes.direct.shape), dtype=complex)
    for turn in (np.asarray, np.conj):
        gap = (s - turn(modes.exponents))[:, None]
        outputs, inputs = turn(modes.outputs), turn(modes.inputs)
        found += (turn(change.outputs) / gap) @ inputs + (outputs / gap) @ turn(change.inputs)
        found += (outputs * turn(change.exponents) / gap**2) @ inputs
    return np.asarray(found / 2 + change.direct + s[:, :, None] * change.direct_rate)


def on_harmonics(factors: Complex) -> Array:
    """Complex factors of the harmonics 0..H as a real map of a_0, a_k, b_k, (2H+1, s, 2H+1, k)."""
    count, s, k = factors.shape
    cosine = np.arange(1, count)
    sine = cosine + count - 1
    found = np.zeros((2 * count - 1, s, 2 * count - 1, k))
    found[0, :, 0] = factors[0].real
    found[cosine, :, cosine] = found[sine, :, sine] = factors[1:].real
    found[cosine, :, sine], found[sine, :, cosine] = factors[1:].imag, -factors[1:].imag
    return found


@dataclass(frozen=True)
class SplitBalance:
    """The balanced equations of a split system, see `periodic.linear.operator.Operator`."""

    orbit: FourierOrbit
    part: LinearPart
    local: Local
    free: tuple[int, ...]

    @property
    def residual(self) -> float:
        """The largest residual."""
        return self.local.residual

    @property
    def fundamental(self) -> Array:
        """NaN: the fundamental matrices are computed once the orbit is found, by `accepted`."""
        return np.full((1, 1, 1), np.nan)

    @property
    def effect(self) -> Array:
        """Approximate size of the change of states with each free parameter, shape (q,)."""
        outer = self._assembled[1][:, 1:]
        return np.asarray(np.abs(outer).sum(axis=0))

    @property
    def _assembled(self) -> tuple[Array, Array]:
        """Rows in the coefficients, ((2H+1) n, (2H+1) n), and in (1, dy)."""
        orbit, part, local = self.orbit, self.part, self.local
        n, harmonics = orbit.nodes.shape[1], orbit.harmonics
        analysis, size = transform(harmonics).analysis, 2 * harmonics + 1
        modes = part.modes(orbit.parameter)
        frequency = orbit.frequency * np.arange(harmonics + 1.0)
        states, k = list(part.states), len(part.forces)
        others = np.setdiff1d(np.arange(n), states)
        factors = on_harmonics(flexibility(modes, frequency)).reshape(size * len(states), size * k)

        def balanced(rows: Array) -> tuple[Array, Array]:
            inner = projected(rows[:, :, 1 : 1 + n], rows[:, :, 1 + n : 1 + 2 * n], orbit.frequency)
            columns = rows[:, :, [0, *range(1 + 2 * n, rows.shape[2])]]
            return inner, np.tensordot(analysis, columns, 1).reshape(len(inner), -1)

        inner, outer = balanced(local.forces)
        width = outer.shape[1]
        forces = (
            analysis @ orbit.algebraic.reshape(-1, orbit.algebraic.shape[2])[:, list(part.forces)]
        ).ravel()
        constant = np.zeros((size * k, width))
        constant[:, 0] = forces
        right = factors @ (outer + constant)
        for i, index in enumerate(self.free):
            change = part.slope(orbit.parameter, index)
            if change is not None:
                slope = on_harmonics(flexibility_slope(modes, change, frequency)).reshape(factors.shape)
                right[:, 1 + i] += slope @ forces
        matrix = np.zeros((size, n, size, n))
        matrix[:, states] = -(factors @ inner).reshape(size, len(states), size, n)
        each = np.arange(size)
        for state in states:
            matrix[each, state, each, state] += 1.0
        full = np.zeros((size, n, width))
        full[:, states] = -right.reshape(size, len(states), width)
        full[:, states, 0] += orbit.coefficients[:, states]
        if len(others):
            inner, outer = balanced(local.own)
            matrix[:, others] = inner.reshape(size, len(others), size, n)
            full[:, others] = outer.reshape(size, len(others), width)
        return matrix.reshape(size * n, size * n), full.reshape(size * n, width)

    def solve(self, rows: Sequence[Row], right: Array) -> tuple[Increment, ...]:
        """Return an increment for each column of `right`, shape (1 + len(rows), columns)."""
        orbit = self.orbit
        matrix, full = self._assembled
        own = np.hstack([full[:, :1], matrix, full[:, 1:]])
        found = bordered.solve(np.vstack([own, *(on_coefficients(orbit, row) for row in rows)]), right)
        return tuple(self._recovered(*pair) for pair in zip(right[0], found.T, strict=True))

    def _recovered(self, constant: float, solution: Array) -> Increment:
        orbit, way, n = self.orbit, transform(self.orbit.harmonics), self.orbit.nodes.shape[1]
        size = way.values.shape[1] * n
        coefficients, outer = solution[:size].reshape(-1, n), solution[size:]
        states = way.values @ coefficients
        rates = orbit.frequency * way.slopes @ coefficients
        count = len(states)
        head = [np.full((count, 1), constant), rates, states, np.broadcast_to(outer, (count, len(outer)))]
        unknowns = np.einsum("smw,sw->sm", self.local.unknowns, np.concatenate(head, axis=1))
        nodes, shape = way.nodes @ coefficients, orbit.stages.shape
        given = states.reshape(shape), unknowns.reshape(orbit.algebraic.shape)
        return Increment(nodes, *given, NO_PHASES, outer, nodes)


@dataclass(frozen=True)
class SplitCorrection(Correction):
    """A corrected orbit with its leading multipliers. leading: their invariant subspace."""

    leading: Leading | None = None


@dataclass(frozen=True, kw_only=True)
class SplitHarmonicBalance(SplitMethod, HarmonicBalance):
    """`HarmonicBalance` for a system with a linear part (`periodic.system.Split`)."""

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
        """Return the balanced equations."""
        part = linear_of(system)
        assert part is not None and isinstance(orbit, FourierOrbit)
        return SplitBalance(orbit, part, local_rows(system, part, orbit, free), free)

    def accepted(self, system: System, correction: Correction) -> Correction:
        """Return it with its leading multipliers, or as failed where there are none."""
        try:
            leading = _leading(system, correction)
            fundamental = leading.fundamental
        except FAILURES as error:
            return replace(correction, outcome=outcome_of(error))
        return SplitCorrection(**{**shallow(correction), "fundamental": fundamental, "leading": leading})

    def spectrum(self, correction: Correction, trivial: int) -> Spectrum:
        """Return the leading Floquet multipliers."""
        leading = correction.leading if isinstance(correction, SplitCorrection) else None
        return LeadingSpectrum(correction.fundamental, trivial, leading)

    def error(
        self, problem: Problem, correction: Correction, tangent: Increment, spectrum: Spectrum
    ) -> ErrorEstimate:
        """Estimate the errors by a Newton step with half as many harmonics again (deferred correction)."""
        system, orbit = problem.system, correction.orbit
        present = harmonics_of(orbit.mesh)
        more = mesh_for(present + max(4, present // 2), orbit.mesh.period)
        fine = with_unknowns(system, series(orbit, more))
        try:
            error, better = finer(self.linearise, problem, orbit, fine, tangent)
            multiplier = spectrum.apart(_leading(system, replace(correction, orbit=better)).fundamental[-1])
        except FAILURES:
            return UNKNOWN
        return ErrorEstimate(error, multiplier)


@dataclass(frozen=True)
class SeriesLeading(Leading):
    """The leading multipliers of a series, computed about it as a piecewise polynomial."""

    def start(self, change: Increment) -> Array:
        """Return the change of state at the beginning of the period for a change of the series, (r,)."""
        pieces = self.floquet.given.orbit
        samples = change.algebraic.reshape(-1, change.algebraic.shape[2])
        harmonics = len(samples) // 4 - 1
        angle = 2 * np.pi / pieces.mesh.period * pieces.stage_phases.ravel()
        unknowns = basis(harmonics, angle) @ (transform(harmonics).analysis @ samples)
        return super().start(replace(change, algebraic=unknowns.reshape(pieces.algebraic.shape)))


def _leading(system: System, correction: Correction) -> SeriesLeading:
    """The leading multipliers of a series."""
    part, orbit = linear_of(system), correction.orbit
    assert part is not None
    free = correction.operator.free if isinstance(correction.operator, SplitBalance) else ()
    mesh = uniform(SCHEME, max(orbit.mesh.ntst, 16), orbit.mesh.period)
    pieces = transfer(orbit, mesh, NO_PHASES)
    pieces = replace(
        pieces,
        algebraic=algebraic_at(system, pieces, pieces.stage_phases.ravel()).reshape(pieces.algebraic.shape),
    )
    changes = [part.slope(orbit.parameter, index) for index in free]
    response = Response(part.modes(orbit.parameter), SCHEME, pieces.grid, mesh.period)
    local = local_rows(system, part, pieces, free)
    return SeriesLeading(ModalFloquet(SplitLinearisation(pieces, part, response, changes, local, system)))
