"""A torus of a family, and what is known of it."""

from __future__ import annotations

from dataclasses import dataclass

from periodic.orbit.scheme import Array
from periodic.tori.section import Section


@dataclass(frozen=True, eq=False, repr=False)
class TorusPoint:
    """A torus of a family.

    Parameters
    ----------
    torus : Section
        The torus.
    parameter : float
        The parameter (SI).
    multipliers : ndarray of complex, shape (n,)
        Its multipliers, the largest first; see `per.tori.torus_multipliers`.
    stable : bool
        Whether motions beside it come to it.
    label : str
        "LP" at a fold of the family, "BP", "PD" and "NS" where a multiplier at 1, one at -1 or a pair comes
        through the unit circle, "UZ" at a value asked for, "EP" at an end, else "".
    """

    torus: Section
    parameter: float
    multipliers: Array
    stable: bool
    label: str = ""

    def __repr__(self) -> str:
        kind = "stable" if self.stable else "unstable"
        return f"TorusPoint({self.parameter:.9g}, {self.label or 'torus'} {kind}, {self.torus!r})"
