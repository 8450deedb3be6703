"""Side conditions: scalar equations that determine an orbit besides its own, one for each free parameter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System


class SideCondition(Protocol):
    """A scalar equation c(orbit) = 0 beside those of the orbit, for one free parameter."""

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient of c at an orbit.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            Where c is linearised.
        free : tuple of int
            Indices of the free parameters.

        Returns
        -------
        Row
            Value and gradient; its y holds the event nodes' phases, then the free parameters.
        """


@dataclass(frozen=True)
class Given:
    """The further free parameters of an orbit and as many side conditions.

    Parameters
    ----------
    own : int
        Index of the free parameter that a condition is given for.
    free : tuple of int
        Indices of the further free parameters.
    conditions : tuple of SideCondition
        The side conditions, one for each of `free`.
    """

    own: int
    free: tuple[int, ...] = ()
    conditions: tuple[SideCondition, ...] = ()


class Condition(Protocol):
    """What determines a further free parameter: a side condition that may refer to an earlier orbit.

    One that is `intrinsic` belongs to every orbit of the system (a phase condition); others pick points of a
    branch (its folds, a level of an output), and are told the intrinsic ones. `trivial` is the number of
    Floquet multipliers that are 1 whatever the parameters where it holds.
    """

    intrinsic: ClassVar[bool] = False
    trivial: ClassVar[int] = 0

    def check(self, system: System, parameter: Array) -> None:
        """Refuse a system for which the condition makes no sense; by default none.

        Parameters
        ----------
        system : System
            The equations.
        parameter : ndarray, shape (p,)
            Parameters in SI units where a branch begins.

        Raises
        ------
        ValueError
            For such a system, with the reason in one sentence.
        """
        return

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition for orbits near `origin`.

        Parameters
        ----------
        origin : Orbit
            An orbit on the same mesh, to which the side condition may refer.
        given : Given
            The free parameter that it is for, and the intrinsic side conditions.

        Returns
        -------
        SideCondition
            One scalar equation.
        """


def side_conditions(
    conditions: Sequence[Condition], free: Sequence[int], origin: Orbit
) -> list[SideCondition]:
    """Return the side conditions for the parameters `free`, one for each, near an orbit."""
    both = list(zip(free, conditions, strict=True))
    own = tuple(k for k, condition in both if condition.intrinsic)
    basic = tuple(condition.at(origin, Given(k)) for k, condition in both if condition.intrinsic)
    return [
        basic[own.index(k)] if condition.intrinsic else condition.at(origin, Given(k, own, basic))
        for k, condition in both
    ]
