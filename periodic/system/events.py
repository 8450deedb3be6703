"""Surfaces of a system: what happens where one of its switches vanishes, and the modes beside it.

The mode of a surface is a number: PLUS on the side s > 0 of its guard, MINUS on the other, STUCK where the
motion is held to it, HELD where that lasts all along, at a place that the motion does not determine and a
parameter says; 0 leaves it to the state.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol, cast

import numpy as np

from periodic.system.arrays import Array
from periodic.system.equations import LinearisationLike, System

MINUS, PLUS, STUCK, HELD = -1, 1, 2, 3


class Kind(StrEnum):
    """What happens where the guard of a surface vanishes. Kinds are compared by ``==``.

    KINK: the equations are bent. JUMP: they jump. SLIDING: they jump, and a motion may slide along it, as dry
    friction sticks. SLIDER: an elastic slider is held or carried. RELAY: a jump with hysteresis. IMPACT: the
    state is mapped. MARKER: nothing, but meshes should know.
    """

    KINK = "kink"
    JUMP = "jump"
    SLIDING = "sliding"
    SLIDER = "slider"
    RELAY = "relay"
    IMPACT = "impact"
    MARKER = "marker"


class SurfaceLike(Protocol):
    """A surface s(x, tau, p) = 0 of a system; every switch belongs to one of them.

    switch: index of its guard s. releases: indices of two further switches (up, down), or None; what is
    STUCK is held where up < 0 < down, goes on as PLUS where up rises to 0, as MINUS where down falls to 0.
    column: its column in the `side` of `Jumping`, None of a surface that is in none. place: of what may be
    HELD the index of the parameter that says where, and the weights (n,) of states in its deflection (SI).
    alone: whether it may be HELD without one, as the equations determine the motion then.
    leaves: of an impact on whose wall the motion may rest, STUCK, the switch at whose rise to 0 it leaves.
    """

    @property
    def kind(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def switch(self) -> int: ...
    @property
    def releases(self) -> tuple[int, int] | None: ...
    @property
    def column(self) -> int | None: ...
    @property
    def place(self) -> tuple[int, tuple[float, ...]] | None: ...
    @property
    def alone(self) -> bool: ...
    @property
    def leaves(self) -> int | None: ...


@dataclass(frozen=True)
class Surface:
    """A surface of a system that stores none: see `SurfaceLike`."""

    kind: Kind
    name: str
    switch: int
    releases: tuple[int, int] | None = None
    column: int | None = None
    place: tuple[int, tuple[float, ...]] | None = None
    alone: bool = False
    leaves: int | None = None


class EventLike(Protocol):
    """A change of mode along a motion in time: `events` of a trajectory has them in order.

    surface: index among the surfaces. before, after: its modes, the same at an impact. phase: tau. modes:
    those of all surfaces afterwards, 0 of those that have none.
    """

    @property
    def surface(self) -> int: ...
    @property
    def before(self) -> int: ...
    @property
    def after(self) -> int: ...
    @property
    def phase(self) -> float: ...
    @property
    def modes(self) -> tuple[int, ...]: ...


class Resetting(System, Protocol):
    """A system with impacts: the state is mapped, x+ = r(x-, tau, p), where some switches pass their level.

    Of these switches the level is 0 and the direction -1 or 1. Between events they keep to the side that they
    come from; r leads back to it.
    """

    @property
    def resets(self) -> Sequence[int]:
        """Indices of these switches."""

    def reset(self, switch: int, state: Array, phase: Array, parameter: Array) -> Array:
        """Return the states after the event.

        Parameters
        ----------
        switch : int
            Index of the switch.
        state : ndarray, shape (N, n)
            x-, before the event.
        phase, parameter : ndarray
            As in `linearise`.

        Returns
        -------
        ndarray, shape (N, n)
            x+, scaled.
        """

    def reset_gradient(
        self, switch: int, state: Array, phase: Array, parameter: Array
    ) -> tuple[Array, Array, Array]:
        """Return the derivatives of `reset`.

        Parameters
        ----------
        switch, state, phase, parameter
            As in `reset`.

        Returns
        -------
        d_state : ndarray, shape (N, n, n)
            In the states before the event.
        d_phase : ndarray, shape (N, n)
            In tau.
        d_parameter : ndarray, shape (N, n, p)
            In all parameters.
        """


class Jumping(System, Protocol):
    """A system whose equations jump where some of its switches vanish, as dry friction does.

    Their level is 0 and their direction 0. It may have `slides` too: of those jumps along which a motion can
    slide (stick, for friction) the indices of two further switches: ds/dtau by the equations of its positive
    side, and by those of its negative side. It slides where the first is negative and the second positive;
    a rise of the first ends that with a positive switch s, a fall of the second with a negative one.

    Where jumps know of each other, as joints on one mass do, these depend on the modes of the others. Then it
    has `guards_depend`, which is True, and its `switch` and `switch_gradient` take `side` as a last argument.
    """

    @property
    def jumps(self) -> Sequence[int]:
        """Indices of these switches."""

    def linearise_beside(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        side: Array,
        free: tuple[int, ...] = (),
    ) -> LinearisationLike:
        """Return what `linearise` does, on given sides of the jumps.

        Parameters
        ----------
        rate, state, algebraic, phase, parameter, free
            As in `linearise`.
        side : ndarray, shape (N, jumps)
            1 for the equations of a positive switch, -1 for those of a negative one, continued beyond its
            zero; 0 where the state decides; 2 for those of sliding.

        Returns
        -------
        LinearisationLike
            Residual and its derivatives.
        """


class Guarded(Jumping, Protocol):
    """A system whose switches may depend on the sides of its jumps."""

    @property
    def guards_depend(self) -> bool:
        """Whether they do."""

    def switch(self, state: Array, phase: Array, parameter: Array, side: Array | None = None) -> Array:
        """Return the switch functions.

        Parameters
        ----------
        state, phase, parameter
            As of any system.
        side : ndarray, shape (N, jumps), optional
            As in `linearise_beside`; by default the state decides everywhere.

        Returns
        -------
        ndarray, shape (N, switches)
            s.
        """

    def switch_gradient(
        self, state: Array, phase: Array, parameter: Array, side: Array | None = None
    ) -> tuple[Array, Array, Array]:
        """Return the derivatives of `switch` in state, phase and parameters.

        Parameters
        ----------
        state, phase, parameter, side
            As of `switch`.

        Returns
        -------
        tuple of ndarray
            As of any system.
        """


def guards(system: System, state: Array, phase: Array, parameter: Array, side: Array) -> Array:
    """Return the switch functions (N, switches), on sides (N, jumps) where they depend on these."""
    if getattr(system, "guards_depend", False):
        return cast(Guarded, system).switch(state, phase, parameter, side)
    return system.switch(state, phase, parameter)


def guards_gradient(
    system: System, state: Array, phase: Array, parameter: Array, side: Array
) -> tuple[Array, Array, Array]:
    """Return the derivatives of `guards` in state, phase and parameters."""
    if getattr(system, "guards_depend", False):
        return cast(Guarded, system).switch_gradient(state, phase, parameter, side)
    return system.switch_gradient(state, phase, parameter)


def surfaces_of(system: System) -> tuple[SurfaceLike, ...]:
    """Return the surfaces of a system, by its jumps, slides, resets and switches where it stores none."""
    if hasattr(system, "surfaces"):
        return tuple(system.surfaces)
    jumps, slides, resets = jumps_of(system), slides_of(system), resets_of(system)
    released = {k for pair in slides.values() for k in pair}

    def kind(k: int) -> Kind:
        if k in resets:
            return Kind.IMPACT
        if k in jumps:
            return Kind.SLIDING if k in slides else Kind.JUMP
        switch = system.switches[k]
        return Kind.KINK if tuple(switch.levels) == (0.0,) and switch.direction == 0 else Kind.MARKER

    return tuple(
        Surface(kind(k), switch.name, k, slides.get(k), jumps.index(k) if k in jumps else None)
        for k, switch in enumerate(system.switches)
        if k not in released
    )


def jumps_of(system: System) -> tuple[int, ...]:
    """Return the indices of the switches at which the equations jump; none of most systems."""
    return tuple(getattr(system, "jumps", ()))


def slides_of(system: System) -> dict[int, tuple[int, int]]:
    """Return the switches of both releases of each jump along which motions can slide."""
    return dict(getattr(system, "slides", {}))


def resets_of(system: System) -> tuple[int, ...]:
    """Return the indices of the switches at which the state is mapped; none of most systems."""
    return tuple(getattr(system, "resets", ()))


def check_continuous(method: str, system: System) -> None:
    """Refuse a system whose motions jump, or are bent by equations that jump, for a method blind to both.

    A jump at given phases, of a square wave, bends all motions alike. Raises ValueError.
    """
    what = "with impacts" if resets_of(system) else ""
    if any(surface.kind == Kind.RELAY for surface in surfaces_of(system)):
        what = what or "with relays"
    state, jumps = system.rest(system.nominal)[0], list(jumps_of(system))
    if jumps:
        phase = np.arange(4.0)
        states = state + np.arange(4.0)[:, None] * np.ones_like(state)
        slope = system.switch_gradient(states, phase, system.nominal)[0][:, jumps]
        what = what or ("whose equations jump" if slope.any() else "")
    if what:
        raise ValueError(f"method is {method}; for a system {what} it must be Collocation()")
