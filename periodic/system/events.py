"""Events at which the state is mapped or the equations jump."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from periodic.system.arrays import Array
from periodic.system.equations import LinearisationLike, System


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
    state, jumps = system.rest(system.nominal)[0], list(jumps_of(system))
    if jumps:
        phase = np.arange(4.0)
        states = state + np.arange(4.0)[:, None] * np.ones_like(state)
        slope = system.switch_gradient(states, phase, system.nominal)[0][:, jumps]
        what = what or ("whose equations jump" if slope.any() else "")
    if what:
        raise ValueError(f"method is {method}; for a system {what} it must be Collocation()")
