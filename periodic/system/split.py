"""A linear part that is given by its modes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, cast

from periodic.system.arrays import Array, Complex
from periodic.system.equations import System


class ModesLike(Protocol):
    """Modes: dz/dtau = exponents z + inputs f, x = Re outputs z + direct f + direct_rate df/dtau.

    J modes, k forces f, s states x: exponents (J,), inputs (J, k), outputs (s, J), complex; one of each
    conjugate pair stands for both. direct, direct_rate (s, k). All scaled.
    """

    @property
    def exponents(self) -> Complex: ...
    @property
    def inputs(self) -> Complex: ...
    @property
    def outputs(self) -> Complex: ...
    @property
    def direct(self) -> Array: ...
    @property
    def direct_rate(self) -> Array: ...


class LinearPart(Protocol):
    """The linear part of a system that is split, x_L = L f: any number of states behind a few places.

    `states` are the indices of the states that it gives, `forces` those of the unknowns that act on it. The
    system's own rows say nothing of these states: as many of its n differential rows are empty. `velocities`
    are those of them to which all modes contribute.
    """

    @property
    def states(self) -> tuple[int, ...]: ...
    @property
    def velocities(self) -> tuple[int, ...]: ...
    @property
    def forces(self) -> tuple[int, ...]: ...
    @property
    def size(self) -> int:
        """Number of its states."""

    def modes(self, parameter: Array) -> ModesLike:
        """Its modes at parameters (p,). Raises ArithmeticError where they do not span its motion."""

    def slope(self, parameter: Array, index: int) -> ModesLike | None:
        """Their derivative in a parameter; None where they do not depend on it."""

    def observed(self, parameter: Array, freedoms: Sequence[int] | None, structure: str | None) -> ModesLike:
        """Its modes with displacement and velocity (SI) of degrees of freedom (None: all) as `outputs`."""


class Split(System, Protocol):
    """A system whose linear part is given by its modes."""

    @property
    def linear(self) -> LinearPart | None:
        """The linear part; None of a system that is not split."""


class Within(Split, Protocol):
    """A split system that was found in the equations of another: its states are some of that one's."""

    @property
    def whole(self) -> System:
        """The other system, with all states."""

    @property
    def kept(self) -> tuple[int, ...]:
        """Which of the whole system's states it has. Of the unknowns it has these first, then its forces."""

    def everything(self, parameter: Array) -> ModesLike:
        """The modes with all states of the whole system as outputs."""


class Condensable(System, Protocol):
    """A system whose linear part may be found in its equations."""

    def condensed(self, *, always: bool = False) -> Within | None:
        """Return the system of its nonlinear places alone, None where that does not pay.

        With `always` also where it does not pay. Raises ValueError then, in one sentence, where it cannot be.
        """


def linear_of(system: System) -> LinearPart | None:
    """Return the linear part of a system that is split, None of any other."""
    return cast(Split, system).linear if hasattr(system, "linear") else None
