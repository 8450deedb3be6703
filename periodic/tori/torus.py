"""A torus: a quasi-periodic motion, which `trace` follows over a parameter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from periodic.results.interactive.pictures import Shown
from periodic.system import System
from periodic.tori.pages import torus_shown
from periodic.tori.section import Section
from periodic.tori.torusbranch import TorusBranch
from periodic.tori.trace import traced


@dataclass(frozen=True, eq=False, repr=False)
class Torus(Section):
    """A quasi-periodic motion, by its section once in a period.

    Parameters
    ----------
    states : ndarray, shape (M, n)
        Scaled states at tau = 0 and M angles theta: equispaced, or Gauss' points between breaks.
    rotation : float
        rho in rad: by how much theta grows in one period.
    parameter : ndarray, shape (p,)
        The system's parameters.
    period : float
        Of the map, in tau: that of the excitation, or one that the torus determines.
    layout : Layout
        Names, units and scales.
    residual : float
        Largest residual of the invariance, scaled.
    tail : float
        Largest of the two highest harmonics of the curve, relative to its largest: an estimate of the error.
    free : bool
        Whether the system is not excited, so that the period is determined with the torus.
    breaks : ndarray, shape (B,)
        Angles at which the section crosses a surface, as of a contact; none where it does not.
    """

    def shown(self, system: System | None = None) -> Shown:
        """Return what the page of it shows: see `per.page`."""
        return torus_shown(self, system)

    def traced(
        self,
        system: System,
        parameter: str,
        bounds: tuple[float, float],
        *,
        start: float | None = None,
        at: float | Sequence[float] = (),
        values: Mapping[str, float] | None = None,
        released: str = "",
    ) -> TorusBranch:
        """Return the family of tori through this one: see `periodic.trace`, which takes it as a guess.

        With `released`, another parameter, those of the same rotation number: it is what it must be for them.
        """
        return traced(system, self, parameter, bounds, start=start, at=at, values=values, released=released)
