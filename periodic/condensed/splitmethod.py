"""Common base of methods for systems with a linear part: systems they accept, guesses of first orbits."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Self

import numpy as np

from periodic.condensed.settling import settled
from periodic.correction.meanequilibrium import resting
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Family
from periodic.orbit.shallow import shallow
from periodic.system import Kind, System, jumps_of, linear_of, resets_of, slides_of, surfaces_of

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


class SplitMethod:
    """A method for systems with a linear part (`periodic.system.Split`), in the place of one for all states.

    The settings are the same.
    """

    @classmethod
    def like(cls, method: DataclassInstance, system: System) -> Self:
        """Return the method with those settings of a method for all states that are not defaults.

        Raises ValueError for a scheme other than Radau IIA, and for events that condensation does not cover.
        """
        _check_events(system)
        given, usual = shallow(method), shallow(type(method)())
        scheme = given.get("scheme")
        if scheme is not None and scheme.family is not Family.RADAU:
            raise ValueError(f"scheme is {scheme.family.value}; condensation takes Radau IIA")
        return cls(**{name: value for name, value in given.items() if value != usual[name]})

    def settled(self, system: System, start: Orbit) -> Iterator[Orbit]:
        """Yield the motion to which a system with sliding jumps settles: `periodic.condensed.settling`."""
        return settled(system, start) if slides_of(system) else iter(())

    def drifting(self, system: System, parameter: Array) -> list[str]:
        """Return none: whether a structure is held is checked where it is compiled."""
        return []

    def resting(self, system: System, start: Orbit) -> Orbit | None:
        """Return the equilibrium under the mean load, with the static flexibility of the linear part."""
        return resting(system, start, linear_of(system))


def _check_events(system: System) -> None:
    """Refuse resets, relays, and jumps at which sticking is not known. Raises ValueError."""
    if resets_of(system):
        raise ValueError(
            "the states at the places are reset; a structure must be compiled with condense=False for that"
        )
    if any(surface.kind == Kind.RELAY for surface in surfaces_of(system)):
        raise ValueError("the equations at the places have a relay; it must be compiled with condense=False")
    unknown = [k for k in jumps_of(system) if k not in slides_of(system)]
    state, _ = system.rest(system.nominal)
    slopes = system.switch_gradient(state[None], np.zeros(1), system.nominal)[0][0]
    if slopes[unknown].any():
        raise ValueError(
            "the equations at the places jump, and whether motion sticks there is known only of a "
            "structure with all its modes; it must be compiled with condense=False"
        )
