"""The linear part of a model of any kind, from its own rows: E x' + A x + f = 0 with all its states in x."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from symbolic.arrays import Array, Complex
from symbolic.checks import refusal
from symbolic.structures.linearpart import Modes, like
from symbolic.structures.matrices import index

STEP = 1e-6
"""Relative step of differences in a parameter."""

DEFECTIVE = 1e12
"""Condition of the eigenvectors above which they do not span the motion."""


@dataclass(frozen=True)
class RowsPart:
    """What `periodic.system.LinearPart` asks for, of n states.

    Parameters
    ----------
    matrices : callable
        Parameters (p,) to E and A, (n, n) each, scaled.
    rows : tuple of int
        Rows on which the forces act.
    places : tuple of int
        States that are given.
    forces : tuple of int
        Indices of the forces among the unknowns of the split system.
    varying : tuple of int
        Parameters on which E and A depend.
    scales : ndarray, shape (n,)
        SI value of one internal unit of each state.
    rates : tuple of int
        Which of `places`, by their order, are velocities.
    omega : callable
        Parameters (p,) to Omega in rad/s.
    """

    matrices: Callable[[Array], tuple[Array, Array]]
    rows: tuple[int, ...]
    places: tuple[int, ...]
    forces: tuple[int, ...]
    varying: tuple[int, ...]
    scales: Array
    rates: tuple[int, ...]
    omega: Callable[[Array], float]
    _known: dict[bytes, tuple[Modes, Complex, Array]] = field(default_factory=dict, init=False, repr=False)

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
        return self._solved(parameter)[0]

    def _solved(self, parameter: Array) -> tuple[Modes, Complex, Array]:
        """The modes, the eigenvectors (n, J) that they are of, and what forces do to the rates, (n, k)."""
        chosen = parameter[list(self.varying)]
        key = chosen.tobytes()
        if key not in self._known:
            if len(self._known) > 16:
                self._known.clear()
            self._known[key] = self._made(parameter)
        return self._known[key]

    def _made(self, parameter: Array) -> tuple[Modes, Complex, Array]:
        inertia, stiffness = self.matrices(parameter)
        try:
            loads = np.eye(self.size)[:, list(self.rows)]
            rates = -np.linalg.solve(inertia, loads).astype(float)
            values, vectors = np.linalg.eig(-np.linalg.solve(inertia, stiffness))
            condition = np.linalg.cond(vectors)
        except np.linalg.LinAlgError as error:
            raise ArithmeticError(f"the linear part has no modes: {error}") from None
        if not condition < DEFECTIVE:
            raise ArithmeticError("the modes of the linear part do not span its motion")
        inputs = np.linalg.solve(vectors, rates)
        kept = values.imag >= 0
        twice = np.where(values[kept].imag > 0, 2.0, 1.0)
        shapes, k = vectors[:, kept] * twice + 0j, len(self.rows)
        zero = np.zeros((len(self.places), k))
        outputs = shapes[list(self.places)]
        return Modes(values[kept] + 0j, inputs[kept] + 0j, outputs, zero, zero), shapes, rates

    def slope(self, parameter: Array, index: int) -> Modes | None:
        """Return the derivative of the modes in a parameter, None where they do not depend on it."""
        if index not in self.varying:
            return None
        middle, step = self.modes(parameter), STEP * max(abs(float(parameter[index])), STEP)
        ends = []
        for sign in (-1, 1):
            moved = parameter.copy()
            moved[index] += sign * step
            ends.append(like(middle, self.modes(moved)))
        names = ("exponents", "inputs", "outputs", "direct", "direct_rate")
        return Modes(*((getattr(ends[1], name) - getattr(ends[0], name)) / (2 * step) for name in names))

    def observed(self, parameter: Array, freedoms: Sequence[int], structure: str | None) -> Modes:
        """Return the modes with the value and the time derivative (SI) of states in turn as outputs.

        Parameters
        ----------
        parameter : ndarray, shape (p,)
            Parameters in SI.
        freedoms : sequence of int
            Indices of d states of the model that was split, counted from 0.
        structure : str, optional
            None: there is but one.

        Returns
        -------
        Modes
            Outputs (2d, J) in SI.

        Raises
        ------
        ValueError
            For an index that is none.
        """
        if structure is not None:
            raise refusal("structure", structure, "left out: the model has none by name")
        at = [index(f"state {k}", freedom, self.size) for k, freedom in enumerate(freedoms)]
        modes, shapes, rates = self._solved(parameter)
        omega, scales = self.omega(parameter), self.scales[at, None]
        outputs = np.zeros((2 * len(at), len(modes.exponents)), dtype=complex)
        outputs[::2] = scales * shapes[at]
        outputs[1::2] = scales * omega * shapes[at] * modes.exponents
        direct = np.zeros((2 * len(at), len(self.rows)))
        direct[1::2] = scales * omega * rates[at]
        return Modes(modes.exponents, modes.inputs, outputs, direct, np.zeros_like(direct))
