"""Damping of a structure that is given mode by mode or by Rayleigh's two numbers."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from symbolic.arrays import Array
from symbolic.checks import refusal
from symbolic.structures.matrices import Matrices, dense, modes


@dataclass(frozen=True)
class ModalDamping:
    """Damping that leaves undamped modes uncoupled: 2 zeta omega = 2 ratio omega + a + b omega^2.

    Parameters
    ----------
    ratio : float or sequence of float
        Damping ratio of every mode, or of the lowest ones, the last counting for all above.
    mass, stiffness : float
        Rayleigh's a (1/s) and b (s): C = a M + b K.

    Raises
    ------
    ValueError
        For numbers that are negative or not finite.
    """

    ratio: float | tuple[float, ...] = 0.0
    mass: float = 0.0
    stiffness: float = 0.0
    _known: dict[str, tuple[Any, Any, Array]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def __post_init__(self) -> None:
        given = (("damping", self.ratio), ("rayleigh", (self.mass, self.stiffness)))
        for name, value in given:
            try:
                numbers = np.asarray(value, dtype=float)
            except (TypeError, ValueError):
                numbers = np.array([np.nan])
            if numbers.ndim > 1 or not numbers.size or not (np.isfinite(numbers) & (numbers >= 0)).all():
                raise refusal(name, value, "a finite number of at least 0, or a sequence of such")

    @property
    def none(self) -> bool:
        """Whether it is no damping at all."""
        return not (np.any(self.ratio) or self.mass or self.stiffness)

    def rates(self, frequencies: Array) -> Array:
        """Return 2 zeta_j omega_j in 1/s of modes with natural frequencies omega_j (rad/s), both (k,)."""
        given = np.atleast_1d(np.asarray(self.ratio, dtype=float))
        ratio = given[np.minimum(np.arange(len(frequencies)), len(given) - 1)]
        return 2 * ratio * frequencies + self.mass + self.stiffness * frequencies**2

    def matrix(self, matrices: Matrices) -> Array:
        """Return the damping matrix C = M Phi diag(2 zeta omega) Phi' M, shape (n, n)."""
        known = self._known.get("last")
        if known is None or known[0] is not matrices.M or known[1] is not matrices.K:
            squares, shapes = modes(matrices.K, matrices.M, matrices.size)
            weighted = dense(matrices.M) @ shapes
            found = (weighted * self.rates(np.sqrt(np.maximum(squares, 0.0)))) @ weighted.T
            known = self._known["last"] = (matrices.M, matrices.K, found)
        return known[2]
