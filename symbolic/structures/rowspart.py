"""The linear part of a model of any kind, from its own rows: E x' + A x + f = 0 with all its states in x."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from symbolic.arrays import Array, Complex
from symbolic.checks import refusal
from symbolic.structures.linearpart import Modes
from symbolic.structures.matrices import RELATIVE_STEP, index
from symbolic.structures.modal import DEFECTIVE

NOT_MIXED = 1e-9
"""Couplings of modes below this part of the largest count as 0, as between modes equal by symmetry."""

SAME_MATRIX = 16 * np.finfo(float).eps
"""Largest difference of equal matrices by rounding, as a part of the largest coefficient."""


@dataclass(frozen=True)
class Eigen:
    """x' = S x + B f with S vectors = vectors diag(values): values (n,), vectors, inverse (n, n), rates B."""

    values: Complex
    vectors: Complex
    inverse: Complex
    rates: Array

    def faster(self, times: float, scales: Array) -> Eigen:
        """Return the modes for rates `times` as large, in states that are `scales` (n,) as large."""
        vectors = scales[:, None] * self.vectors
        lengths = np.linalg.norm(vectors, axis=0)
        inverse = lengths[:, None] * self.inverse / scales
        return Eigen(times * self.values, vectors / lengths, inverse, times * scales[:, None] * self.rates)

    @cached_property
    def kept(self) -> NDArray[np.bool_]:
        """Which modes are kept: real ones, and one of each conjugate pair."""
        return self.values.imag >= 0

    @cached_property
    def twice(self) -> Array:
        """2 for a mode that stands for its conjugate too, 1 for a real one."""
        return np.where(self.values[self.kept].imag > 0, 2.0, 1.0)

    @cached_property
    def inputs(self) -> Complex:
        """Forces on the modes that are kept, by those of the system, (J, k)."""
        return self.inverse[self.kept] @ self.rates

    @cached_property
    def shapes(self) -> Complex:
        """States by these modes, of which the real part is taken, (n, J)."""
        return self.vectors[:, self.kept] * self.twice


@dataclass(frozen=True)
class RowsPart:
    """A `periodic.system.LinearPart` of n states.

    Parameters
    ----------
    matrices : callable
        Parameters (p,) to E and A, (n, n) each, scaled.
    loads : ndarray, shape (n, k)
        Coefficients of the k forces in each row.
    places : tuple of int
        States that are given.
    forces : tuple of int
        Indices of the forces among the unknowns of the split system.
    varying : tuple of int
        Parameters on which E and A depend.
    scales : ndarray, shape (n,)
        SI value of one internal unit of each state.
    rates : tuple of int
        Positions in `places` of velocities.
    moving : tuple of int
        Which of all states are velocities, dq/dtau in the phase: Omega scales them.
    omega : callable
        Parameters (p,) to Omega in rad/s.
    """

    matrices: Callable[[Array], tuple[Array, Array]]
    loads: Array
    places: tuple[int, ...]
    forces: tuple[int, ...]
    varying: tuple[int, ...]
    scales: Array
    rates: tuple[int, ...]
    moving: tuple[int, ...]
    omega: Callable[[Array], float]
    _known: dict[bytes, Eigen] = field(default_factory=dict, init=False, repr=False)
    _latest: list[tuple[float, tuple[Array, Array], Eigen]] = field(
        default_factory=list, init=False, repr=False
    )

    @property
    def states(self) -> tuple[int, ...]:
        """Indices of the states that it gives: all of the split system's."""
        return tuple(range(len(self.places)))

    @property
    def velocities(self) -> tuple[int, ...]:
        """Those of them that are velocities."""
        return self.rates

    @property
    def size(self) -> int:
        """Number of its states."""
        return len(self.scales)

    def modes(self, parameter: Array) -> Modes:
        """Return the modes at parameters (p,). Raises ArithmeticError where they do not span the motion."""
        at = self._solved(parameter)
        zero = np.zeros((len(self.places), self.loads.shape[1]))
        return Modes(at.values[at.kept], at.inputs, at.shapes[list(self.places)], zero, zero)

    def _solved(self, parameter: Array) -> Eigen:
        """The modes of all states."""
        chosen = parameter[list(self.varying)]
        key = chosen.tobytes()
        if key not in self._known:
            if len(self._known) > 16:
                self._known.clear()
            self._known[key] = self._beside(parameter)
        return self._known[key]

    def _beside(self, parameter: Array) -> Eigen:
        """The modes; where they are known and Omega alone is another, those with the time scaled."""
        given, omega = self._explicit(parameter), self.omega(parameter)
        for before, other, known in self._latest:
            slower = before / omega
            if _same(given, self._faster(other, slower)):
                return known.faster(slower, self._speeds(slower))
        found = _modes(*given)
        self._latest[:] = [(omega, given, found)]
        return found

    def _speeds(self, times: float) -> Array:
        """Factors of the states, (n,), where Omega is `times` smaller: velocities dq/dtau are larger."""
        found = np.ones(self.size)
        found[list(self.moving)] = times
        return found

    def _faster(self, given: tuple[Array, Array], times: float) -> tuple[Array, Array]:
        """The same equations where Omega is `times` smaller."""
        scales = self._speeds(times)[:, None]
        return times * scales * given[0] / scales[:, 0], times * scales * given[1]

    def _explicit(self, parameter: Array) -> tuple[Array, Array]:
        """x' = state x + rates f."""
        inertia, stiffness = self.matrices(parameter)
        try:
            found = -np.linalg.solve(inertia, np.concatenate([stiffness, self.loads], axis=1))
        except np.linalg.LinAlgError as error:
            raise ArithmeticError(f"the linear part has no modes: {error}") from None
        return found[:, : self.size], found[:, self.size :]

    def slope(self, parameter: Array, index: int) -> Modes | None:
        """Return the derivative of the modes in a parameter, None where they do not depend on it.

        With x' = S x + B f and S V = V diag(lambda): dV = V C, C_ij = (V^-1 dS V)_ij / (lambda_j - lambda_i).
        """
        if index not in self.varying:
            return None
        step, ends = RELATIVE_STEP * max(abs(float(parameter[index])), RELATIVE_STEP), []
        for sign in (1, -1):
            moved = parameter.copy()
            moved[index] += sign * step
            ends.append(self._explicit(moved))
        state, rates = ((after - before) / (2 * step) for after, before in zip(*ends, strict=True))
        at = self._solved(parameter)
        turned = at.inverse @ state @ at.vectors
        gaps = at.values - at.values[:, None]
        apart = np.abs(turned) > NOT_MIXED * np.abs(turned).max(initial=0.0)
        mixed = np.where(apart & (gaps != 0), turned / np.where(gaps == 0, 1.0, gaps), 0.0)
        np.fill_diagonal(mixed, 0.0)
        if not np.abs(mixed).max(initial=0.0) < 1 / DEFECTIVE:
            raise ArithmeticError("modes of the linear part cannot be followed: two of them meet")
        inputs = at.inverse @ rates - mixed @ (at.inverse @ at.rates)
        kept, twice = at.kept, at.twice
        zero = np.zeros((len(self.places), self.loads.shape[1]))
        shapes = (at.vectors @ mixed)[list(self.places)][:, kept] * twice
        return Modes(np.diag(turned)[kept], inputs[kept], shapes, zero, zero)

    def everything(self, parameter: Array) -> Modes:
        """Return the modes with all states (scaled) as outputs."""
        at = self._solved(parameter)
        nothing = np.zeros((self.size, self.loads.shape[1]))
        return Modes(at.values[at.kept], at.inputs, at.shapes, nothing, nothing)

    def observed(self, parameter: Array, freedoms: Sequence[int], structure: str | None) -> Modes:
        """Return the modes with the value and the time derivative (SI) of states in turn as outputs.

        Parameters
        ----------
        parameter : ndarray, shape (p,)
            Parameters in SI.
        freedoms : sequence of int
            Indices of d states of the model that was split, counted from 0.
        structure : str, optional
            Must be None: the model has no structures with names.

        Returns
        -------
        Modes
            Outputs (2d, J) in SI.

        Raises
        ------
        ValueError
            For an index out of range, and for the name of a structure.
        """
        if structure is not None:
            raise refusal("structure", structure, "left out: the model has none by name")
        at = [index(f"state {k}", freedom, self.size) for k, freedom in enumerate(freedoms)]
        found = self._solved(parameter)
        omega, scales, shapes = self.omega(parameter), self.scales[at, None], found.shapes[at]
        exponents = found.values[found.kept]
        outputs = np.zeros((2 * len(at), len(exponents)), dtype=complex)
        outputs[::2], outputs[1::2] = scales * shapes, scales * omega * shapes * exponents
        direct = np.zeros((2 * len(at), self.loads.shape[1]))
        direct[1::2] = scales * omega * found.rates[at]
        return Modes(exponents, found.inputs, outputs, direct, np.zeros_like(direct))


def _modes(state: Array, rates: Array) -> Eigen:
    """The modes of x' = state x + rates f."""
    try:
        values, vectors = np.linalg.eig(state)
        inverse = np.linalg.inv(vectors)
    except np.linalg.LinAlgError as error:
        raise ArithmeticError(f"the linear part has no modes: {error}") from None
    if not np.linalg.norm(vectors) * np.linalg.norm(inverse) < 1 / DEFECTIVE:
        raise ArithmeticError("the modes of the linear part do not span its motion")
    return Eigen(values + 0j, vectors + 0j, inverse + 0j, rates)


def _same(given: tuple[Array, Array], other: tuple[Array, Array]) -> bool:
    """Whether equations are the same but for rounding."""
    return all(
        bool((np.abs(a - b) <= SAME_MATRIX * np.abs(b).max(initial=0.0)).all())
        for a, b in zip(given, other, strict=True)
    )
