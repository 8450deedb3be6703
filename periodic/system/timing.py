"""How the phase runs in time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, cast

from periodic.system.equations import System


class Timed(System, Protocol):
    """A system that tells how its phase runs in time, d/dt = Omega d/dtau."""

    @property
    def frequency(self) -> Sequence[str]:
        """Names of the parameters whose product is the angular frequency Omega (rad/s).

        A system may have `frequency_factor` too, by which that product is then multiplied. Where this
        factor depends on other parameters, `frequency_held` has their values by name, for which it holds.
        """


def frequency_of(system: System) -> tuple[str, ...]:
    """Return the names of the parameters whose product is Omega; none where the system does not tell."""
    return tuple(cast(Timed, system).frequency) if hasattr(system, "frequency") else ()


def frequency_factor_of(system: System) -> float:
    """Return Omega over the product of the parameters `frequency_of`."""
    return float(getattr(system, "frequency_factor", 1.0))


def frequency_held_of(system: System) -> dict[str, float]:
    """Return the values (SI) of parameters, by name, for which `frequency_factor_of` holds."""
    return dict(getattr(system, "frequency_held", {}))
