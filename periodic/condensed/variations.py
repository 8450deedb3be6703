"""All linearised motions of a split system about an orbit: the leading multipliers and their derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.condensed.circle import Circle
from periodic.condensed.floquet import Leading, ModalFloquet
from periodic.condensed.linearised import SplitLinearisation
from periodic.condensed.modal.moments import Complex
from periodic.condensed.repeating import CondensedRepeating
from periodic.linear.variation import UnknownVariationsError
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System

CONJUGATE = 1e-9
"""Relative imaginary part of a product up to which two multipliers are a pair."""


@dataclass(frozen=True)
class CondensedVariations:
    """See `periodic.linear.variation.Variations`.

    Parameters
    ----------
    system : System
        The equations.
    given : SplitLinearisation
        The system about the orbit, with all modes.
    free : tuple of int
        Parameters that the motions may change.
    """

    system: System
    given: SplitLinearisation
    free: tuple[int, ...]

    @staticmethod
    def about(system: System, orbit: Orbit, free: tuple[int, ...]) -> CondensedVariations:
        """Linearise; `free` are the parameters that motions may change.

        Raises UnknownVariationsError where forces jump.
        """
        given = SplitLinearisation.about(system, orbit, free)
        if given.saltations:
            raise UnknownVariationsError(
                "forces at the places jump, as those of friction that sticks; curves in two parameters and "
                "derivatives of multipliers need a structure that is compiled with condense=False"
            )
        return CondensedVariations(system, given, free)

    def repeating(self, multiplier: complex) -> CondensedRepeating:
        """Return the equations of the motions that are multiplied by a number."""
        plain = complex(multiplier)
        return CondensedRepeating(self.system, self.given, self.free, plain if plain.imag else plain.real)

    @cached_property
    def multipliers(self) -> Complex:
        """The leading multipliers."""
        return np.linalg.eigvals(Leading(ModalFloquet(self.given)).fundamental[-1]).astype(np.complex128)

    def outside(self, radius: float) -> int:
        """Return how many multipliers have a modulus larger than `radius`, of all modes."""
        return Circle(self, radius).outside()

    def multiplier(self, which: int, factor: complex, free: tuple[int, ...]) -> Row:
        """Return the gradient of Re(factor mu), dmu = -w' dK v / w' K_mu v with w' K = 0, K v = 0."""
        repeating = self.repeating(self.multipliers[which])
        left, _, right = np.linalg.svd(repeating.matrix[:, : repeating.coupled.size])
        w, v = left[:, -1].conj(), right[-1].conj()
        return repeating.gradient(v, -factor * w / (w @ repeating.slope @ v), None, free)

    def pair(self, near: Array | None, free: tuple[int, ...]) -> tuple[Row, Array]:
        """Return the product of a pair of multipliers less 1, and the pair."""
        values = self.multipliers
        first, second = np.triu_indices(len(values), 1)
        products = values[first] * values[second]
        apart = np.abs(products - 1)
        if near is not None:
            both, known = np.stack([values[first], values[second]]), near[0] + 1j * near[1]
            ways = [np.abs(both - order[:, None]).sum(axis=0) for order in (known, known[::-1])]
            apart = np.minimum(*ways)
        apart = np.where(np.abs(products.imag) < CONJUGATE * np.abs(products), apart, np.inf)
        i, j = int(first[apart.argmin()]), int(second[apart.argmin()])
        row = self.multiplier(i, complex(values[j]), free) + self.multiplier(j, complex(values[i]), free)
        value = float((values[i] * values[j]).real) - 1
        found = values[[i, j]]
        parts = np.stack([found.real, found.imag])
        return Row(value + row.value, row.nodes, row.outer, row.stages), parts
