"""The section of a quasi-periodic motion, once in a period: what tori are known by."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from periodic.checks import one_of
from periodic.orbit.layout import Layout
from periodic.orbit.scheme import Array
from periodic.tori.grid import Grid


class TorusError(ArithmeticError):
    """A torus is not found; the sentence says where and why."""


@dataclass(frozen=True, eq=False)
class Section:
    """A quasi-periodic motion, by its section once in a period. See `Torus` for its members."""

    states: Array
    rotation: float
    parameter: Array
    period: float
    layout: Layout
    residual: float = np.inf
    tail: float = np.inf
    free: bool = False
    breaks: Array = field(default_factory=lambda: np.zeros(0))

    def __repr__(self) -> str:
        return f"{type(self).__name__}(rotation number {self.rotation_number:.9g}, {len(self.states)} angles)"

    @property
    def rotation_number(self) -> float:
        """Turns of the section in one period, rho / (2 pi), in [0, 1)."""
        return float(self.rotation / (2 * np.pi) % 1.0)

    @property
    def frequencies(self) -> tuple[float, float]:
        """Both angular frequencies (rad/s): 2 pi / period, and the rotation number times it.

        The second is known but for whole multiples of the first, and its sign.
        """
        omega = self.layout.omega(self.parameter) if self.layout.frequency else 1.0
        first = 2 * np.pi / self.period * omega
        return float(first), float(self.rotation_number * first)

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters in SI units, by name."""
        both = zip(self.layout.parameters, self.parameter, strict=True)
        return {q.name: q.scale * float(value) for q, value in both}

    @property
    def size(self) -> float:
        """How far the section is from its middle, root mean square of all scaled states; 0 at birth."""
        middle = self.grid.weights @ self.states
        return float(np.sqrt(self.grid.weights @ ((self.states - middle) ** 2).sum(axis=1)))

    @cached_property
    def grid(self) -> Grid:
        """The angles at which the section is known."""
        return Grid(len(self.states), self.breaks)

    def section(self, name: str, angles: Array | None = None) -> Array:
        """Return a state around the section at tau = 0.

        Parameters
        ----------
        name : str
            A state; its velocity x' is dx/dt.
        angles : ndarray, optional
            theta in rad; by default the M of the section.

        Returns
        -------
        ndarray
            SI values.

        Raises
        ------
        ValueError
            For a name that is no state.
        """
        one_of("section", name, [q.name for q in self.layout.states])
        values = self.states if angles is None else self.states_at(np.asarray(angles))
        return np.asarray(self.units[name] * values[:, self.layout.column(name).index])

    @property
    def units(self) -> Mapping[str, float]:
        """SI values of one internal unit of each state, by name."""
        return self.layout.units(self.parameter)

    def states_at(self, angles: Array) -> Array:
        """Return all scaled states of the section.

        Parameters
        ----------
        angles : ndarray, shape (K,)
            theta in rad.

        Returns
        -------
        ndarray, shape (K, n)
            The states.
        """
        return self.grid.interpolation(angles)[0] @ self.states


Function = Callable[[Mapping[str, Array]], Array]
"""Of states in SI by their names, each an array, as ``lambda s: s["x"] ** 2``."""
