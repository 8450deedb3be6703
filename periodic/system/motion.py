"""Integration in time, which shooting and simulated starts ask for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from periodic.system.arrays import Array
from periodic.system.equations import System


class FlowLike(Protocol):
    """A trajectory at K phases: state (K, n), algebraic (K, m), and their derivatives in the first state and
    then in the free parameters, state_gradient (K, n, n+q), algebraic_gradient (K, m, n+q).
    """

    @property
    def state(self) -> Array: ...
    @property
    def algebraic(self) -> Array: ...
    @property
    def state_gradient(self) -> Array: ...
    @property
    def algebraic_gradient(self) -> Array: ...


class Flowing(System, Protocol):
    """A system that can also integrate itself in time, which shooting needs."""

    def flow(
        self,
        state: Array,
        algebraic: Array,
        parameter: Array,
        phase: Array,
        free: tuple[int, ...],
        tolerance: float,
    ) -> FlowLike:
        """Integrate from `state` (n,) at phase[0] to all of `phase` (K,), which rises.

        algebraic (m,) is a guess of the unknowns at phase[0]; `free` are the parameters to differentiate in;
        tolerance is relative and absolute. Raises ArithmeticError where the integration fails.
        """


class Happened(Protocol):
    """A change of mode of a surface, by its index, at a phase; an impact leaves its own mode as it is."""

    @property
    def surface(self) -> int: ...
    @property
    def before(self) -> int: ...
    @property
    def after(self) -> int: ...
    @property
    def phase(self) -> float: ...


class TrajectoryLike(Protocol):
    """A trajectory at K phases, phase (K,): state (K, n), algebraic (K, m).

    It tells what happened on its way, and the modes of all surfaces at its end.
    """

    @property
    def phase(self) -> Array: ...
    @property
    def state(self) -> Array: ...
    @property
    def algebraic(self) -> Array: ...
    @property
    def events(self) -> Sequence[Happened]: ...
    @property
    def modes(self) -> Sequence[int]: ...


class Moving(System, Protocol):
    """A system that can be followed in time, through impacts too."""

    def motion(
        self,
        state: Array,
        algebraic: Array,
        parameter: Array,
        phase: Array,
        tolerance: float,
        modes: Sequence[int] | None = None,
    ) -> TrajectoryLike:
        """Integrate from `state` (n,) at phase[0] to all of `phase` (K,), which rises.

        algebraic (m,) is a guess of the unknowns at phase[0]; tolerance is relative and absolute. modes: of
        all surfaces before, in which relays and what slides stay; only systems with these are given them. The
        trajectory has two points of one phase at each impact, with the states before and after it. Raises
        ArithmeticError where the integration fails.
        """
