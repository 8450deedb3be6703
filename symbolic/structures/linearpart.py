"""The linear part of a condensed system: what `periodic.system.LinearPart` asks for, from modes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from symbolic.arrays import Array, Complex
from symbolic.checks import one_of, refusal
from symbolic.structures.matrices import RELATIVE_STEP, index
from symbolic.structures.modal import ModalForm
from symbolic.structures.modalslope import ModalSlope


class Modal(Protocol):
    """A structure that tells its modes."""

    name: str

    @property
    def varying(self) -> bool:
        """Whether the modes depend on the speed."""

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""

    def modal(self, speed: float) -> ModalForm:
        """Return the modes at a speed in rad/s."""

    def modal_slope(self, speed: float) -> ModalSlope | None:
        """Return the derivatives of the modes in the speed; None where only differences give them."""


@dataclass(frozen=True)
class Held:
    """A place of a structure: its degree of freedom, its states, its force, and their units in SI.

    coasting: where friction may stick there, the further state that is the acceleration which the place would
    have without forces at the places; coasting_scale: its unit in SI.
    """

    structure: Modal
    freedom: int
    position: int
    velocity: int
    force: int
    scale: float
    unit_force: float
    coasting: int | None = None
    coasting_scale: float = 1.0


@dataclass(frozen=True)
class Modes:
    """dz/dtau = exponents z + inputs f, x = Re outputs z + direct f + direct_rate df/dtau; all scaled.

    Parameters
    ----------
    exponents : ndarray of complex, shape (J,)
        Per rad.
    inputs : ndarray of complex, shape (J, k)
        How the k forces drive z.
    outputs : ndarray of complex, shape (2k, J)
        The 2k states in `LinearPart.states`.
    direct, direct_rate : ndarray, shape (2k, k)
        Feedthrough to these states from the forces and from the forces' rates.
    """

    exponents: Complex
    inputs: Complex
    outputs: Complex
    direct: Array
    direct_rate: Array


@dataclass(frozen=True)
class LinearPart:
    """The structures of a model, condensed at their places.

    Parameters
    ----------
    places : sequence of Held
        The places, those of one structure together.
    omega : callable
        Parameters (p,) to the speed Omega in rad/s.
    frequency : callable
        Parameters (p,) to the derivative of Omega in them, (p,).
    """

    places: Sequence[Held]
    omega: Callable[[Array], float]
    frequency: Callable[[Array], Array]
    _known: dict[float, Modes] = field(default_factory=dict, init=False, repr=False)

    @property
    def states(self) -> tuple[int, ...]:
        """Indices of the states that the structures give: position and velocity of each place.

        Then the acceleration without forces at the places, where friction asks for it.
        """
        both = tuple(k for place in self.places for k in (place.position, place.velocity))
        return both + tuple(place.coasting for place in self.places if place.coasting is not None)

    @property
    def velocities(self) -> tuple[int, ...]:
        """Those of them that are velocities."""
        return tuple(place.velocity for place in self.places) + self.states[2 * len(self.places) :]

    @property
    def forces(self) -> tuple[int, ...]:
        """Indices of the unknowns that are the forces on the structures."""
        return tuple(place.force for place in self.places)

    @property
    def size(self) -> int:
        """Number of states of the structures."""
        return sum(2 * structure.size for structure in self.structures)

    @property
    def structures(self) -> list[Modal]:
        """The structures, in order."""
        return list({id(place.structure): place.structure for place in self.places}.values())

    def modes(self, parameter: Array) -> Modes:
        """Return the modes at parameters (p,)."""
        return self._at(self.omega(parameter))

    def slope(self, parameter: Array, index: int) -> Modes | None:
        """Return the derivative of the modes in a parameter, None where they do not depend on it."""
        rate, omega = float(self.frequency(parameter)[index]), self.omega(parameter)
        if rate == 0.0:
            return None
        at = self._at(omega)
        scale = -rate / omega
        if self._varying:
            changes = [_change(structure, omega) for structure in self.structures]
            known = [change for change in changes if change is not None]
            if len(known) < len(changes):
                return self._difference(omega, rate)
            return self._product(omega, rate, known)
        zero = np.zeros_like(at.direct)
        return Modes(scale * at.exponents, scale * at.inputs, scale * self._orders * at.outputs, zero, zero)

    def observed(self, parameter: Array, freedoms: Sequence[int] | None, structure: str | None) -> Modes:
        """Return the modes with displacement and velocity (SI) of degrees of freedom in turn as outputs.

        Parameters
        ----------
        parameter : ndarray, shape (p,)
            Parameters in SI.
        freedoms : sequence of int, or None
            Indices of d degrees of freedom, counted from 0; None for all of them.
        structure : str, optional
            Name of the structure, where there are several.

        Returns
        -------
        Modes
            Outputs (2d, J) in SI.

        Raises
        ------
        ValueError
            For a name or an index that is none.
        """
        chosen = self._named(structure)
        wanted = range(chosen.size) if freedoms is None else freedoms
        at = [index(f"freedom {k}", freedom, chosen.size) for k, freedom in enumerate(wanted)]
        omega = self.omega(parameter)
        modes, count, k = self._at(omega), len(at), len(self.places)
        form = chosen.modal(omega)
        before = [s for s in self.structures[: self.structures.index(chosen)]]
        first = sum(len(s.modal(omega).exponents) for s in before)
        mine = [i for i, place in enumerate(self.places) if place.structure is chosen]
        outputs = np.zeros((2 * count, len(modes.exponents)), dtype=complex)
        own = slice(first, first + len(form.exponents))
        outputs[::2, own] = form.shapes[at]
        outputs[1::2, own] = form.shapes[at] * form.exponents
        forces = np.array([self.places[i].unit_force for i in mine])
        residual = form.residual([self.places[i].freedom for i in mine])[at] * forces
        direct, direct_rate = np.zeros((2 * count, k)), np.zeros((2 * count, k))
        direct[::2, mine], direct_rate[1::2, mine] = residual, residual * omega
        return Modes(modes.exponents, modes.inputs, outputs, direct, direct_rate)

    def _named(self, name: str | None) -> Modal:
        names = [structure.name for structure in self.structures]
        if name is None and len(names) == 1:
            return self.structures[0]
        if name is None:
            raise refusal("structure", name, f"one of {', '.join(names)}")
        return self.structures[names.index(one_of("structure", name, names))]

    def _product(self, omega: float, rate: float, changes: list[ModalSlope]) -> Modes:
        """The same from the derivatives of the structures' own modes by the product rule."""
        at, k, first = self._at(omega), len(self.places), 0
        exponents = np.concatenate([change.exponents for change in changes]) / omega - at.exponents / omega
        inputs, outputs = -at.inputs / omega, np.zeros_like(at.outputs)
        for structure, change in zip(self.structures, changes, strict=True):
            own = slice(first, first + len(change.exponents))
            first = own.stop
            for i, place in enumerate(self.places):
                if place.structure is structure:
                    inputs[own, i] += change.inputs[:, place.freedom] * place.unit_force / omega
                    outputs[2 * i, own] = change.shapes[place.freedom] / place.scale
        # velocities are exponents times displacements
        both, coasting = slice(0, 2 * k, 2), self._coasting
        slopes, shapes = outputs[both], at.outputs[both]
        outputs[1 : 2 * k : 2] = slopes * at.exponents + shapes * exponents
        accelerations = slopes * at.exponents**2 + 2 * shapes * at.exponents * exponents
        outputs[2 * k :] = accelerations[coasting] * self._coasting_scales
        zero = np.zeros_like(at.direct)
        return Modes(rate * exponents, rate * inputs, rate * outputs, zero, zero)

    @property
    def _coasting(self) -> list[int]:
        """The places whose acceleration without forces is a state."""
        return [i for i, place in enumerate(self.places) if place.coasting is not None]

    @property
    def _coasting_scales(self) -> Array:
        """Scales of the displacements there over those of the accelerations, shape (c, 1)."""
        places = [self.places[i] for i in self._coasting]
        return np.array([place.scale / place.coasting_scale for place in places]).reshape(-1, 1)

    def _difference(self, omega: float, rate: float) -> Modes:
        """The same by differences, the modes of the two sides matched and normalised alike."""
        middle = self._at(omega)
        step = RELATIVE_STEP * omega
        ends = [like(middle, self._at(omega + sign * step)) for sign in (-1, 1)]
        parts = [
            rate * (getattr(ends[1], name) - getattr(ends[0], name)) / (2 * step)
            for name in ("exponents", "inputs", "outputs", "direct", "direct_rate")
        ]
        return Modes(*parts)

    def _at(self, omega: float) -> Modes:
        if omega not in self._known:
            if len(self._known) > 8:
                self._known.clear()
            self._known[omega] = self._made(omega) if self._varying else self._timed(omega)
        return self._known[omega]

    @cached_property
    def _varying(self) -> bool:
        """Whether the matrices of a structure depend on Omega."""
        return any(structure.varying for structure in self.structures)

    @cached_property
    def _unit(self) -> Modes:
        """The modes at 1 rad/s."""
        return self._made(1.0)

    def _timed(self, omega: float) -> Modes:
        """The modes of matrices that do not depend on Omega: it only scales the time."""
        at = self._unit
        outputs = at.outputs / omega**self._orders
        return Modes(at.exponents / omega, at.inputs / omega, outputs, at.direct, at.direct_rate)

    @cached_property
    def _orders(self) -> Array:
        """How many derivatives in time the states are away from displacements, (s, 1)."""
        both = [0.0, 1.0] * len(self.places)
        return np.array([*both, *[2.0] * len(self._coasting)])[:, None]

    def _made(self, omega: float) -> Modes:
        exponents, inputs, outputs = [], [], []
        k = len(self.places)
        size, coasting = len(self.states), self._coasting
        direct, direct_rate = np.zeros((size, k)), np.zeros((size, k))
        for structure in self.structures:
            mine = [i for i, place in enumerate(self.places) if place.structure is structure]
            form = structure.modal(omega)
            at = [self.places[i].freedom for i in mine]
            forces = np.array([self.places[i].unit_force for i in mine])
            lengths = np.array([self.places[i].scale for i in mine])
            drive = np.zeros((len(form.exponents), k), dtype=complex)
            drive[:, mine] = form.inputs[:, at] * forces / omega
            shape = np.zeros((size, len(form.exponents)), dtype=complex)
            shape[[2 * i for i in mine]] = form.shapes[at] / lengths[:, None]
            shape[[2 * i + 1 for i in mine]] = form.shapes[at] * form.exponents / (lengths[:, None] * omega)
            held = shape[[2 * i for i in coasting if i in mine]] * (form.exponents / omega) ** 2
            rows = [2 * k + row for row, i in enumerate(coasting) if i in mine]
            shape[rows] = held * self._coasting_scales[[row - 2 * k for row in rows]]
            residual = form.residual(at)[at] * forces / lengths[:, None]
            direct[np.ix_([2 * i for i in mine], mine)] = residual
            direct_rate[np.ix_([2 * i + 1 for i in mine], mine)] = residual
            exponents.append(form.exponents / omega)
            inputs.append(drive)
            outputs.append(shape)
        return Modes(
            np.concatenate(exponents),
            np.concatenate(inputs),
            np.concatenate(outputs, axis=1),
            direct,
            direct_rate,
        )


def _change(structure: Modal, omega: float) -> ModalSlope | None:
    """Derivatives of a structure's modes in the speed: 0 where its matrices do not depend on it."""
    if structure.varying:
        return structure.modal_slope(omega)
    form = structure.modal(omega)
    return ModalSlope(*(np.zeros_like(a) for a in (form.exponents, form.shapes, form.inputs)))


def like(given: Modes, other: Modes) -> Modes:
    """Return `other` in the order and normalisation of the nearby modes `given`.

    Each mode is matched by its exponent, and scaled so that the largest input of the mode given is the same.
    Raises ArithmeticError where two modes match the same one.
    """
    order = [int(np.abs(other.exponents - value).argmin()) for value in given.exponents]
    if len(set(order)) < len(order):
        raise ArithmeticError("modes of the structure cannot be followed in the speed: two of them meet")
    largest = np.abs(given.inputs).argmax(axis=1)
    each = np.arange(len(order))
    inputs, outputs = other.inputs[order], other.outputs[:, order]
    here, there = given.inputs[each, largest], inputs[each, largest]
    factor = np.where(there == 0, 1.0, here / np.where(there == 0, 1.0, there))
    return Modes(
        other.exponents[order], inputs * factor[:, None], outputs / factor, other.direct, other.direct_rate
    )
