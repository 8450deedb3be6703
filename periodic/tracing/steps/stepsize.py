"""Arclength step control: how long the next step is, and what a step may not exceed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from periodic.checks import at_least_0, between, positive, whole
from periodic.stability.winding import WindingLimits


@dataclass(frozen=True, kw_only=True)
class ArclengthControl:
    """Step control of a continuation. Lengths are parts of the parameter's range.

    Parameters
    ----------
    ds, ds_min, ds_max : float
        First, least and greatest step. A step is tried at 10 ln(ds_max / ds_min) lengths at most.
    turn : float
        Least cosine between the tangents at the ends of a step.
    bend : float
        Largest distance of a step's end from the arc that its two tangents make, as a part of the step.
    noise : float
        Allowance for discretisation error in that distance, in tolerances.
    winding : WindingLimits
        How far multipliers may turn past +1, so that no resonance is passed unseen.
    aim : float
        Part of the bounds on turning, bending and winding at which the next step aims.
    growth : tuple of (int, float)
        Factors on the next step by the Newton iterations of this one: up to 3, 4, 5, 6.
    slow : float
        The factor after more iterations than these.
    recovery : float
        Factor on steps shorter than `ds`, as after a grazing, as far as the bounds on a step allow it.
    patience : int
        Newton iterations that a step may take; one that takes more is too long.
    remesh_every : int
        The mesh is made anew every so many steps,
    remesh_above : float
        ... where the error estimate reaches this part of the tolerance,
    remesh_below, smaller : float
        ... where it falls below this part, and a mesh of `smaller` times as many intervals would do.
    meshes : int
        How many new meshes are tried for one step.
    max_points : int
        Bounds the steps in each direction.
    max_newton : int
        Bounds the Newton iterations of a branch up to one correction, those for rejected steps, for the first
        orbit and before an interruption included. One costs a linear solve on about ntst_max intervals at
        most.

    Raises
    ------
    ValueError
        For steps that are not in order, and counts that are none.
    """

    ds: float = 0.02
    ds_min: float = 1e-7
    ds_max: float = 0.2
    turn: float = 0.8
    bend: float = 0.1
    noise: float = 10.0
    winding: WindingLimits = field(default_factory=WindingLimits)
    aim: float = 0.8
    growth: tuple[tuple[int, float], ...] = ((3, 2.0), (4, 1.5), (5, 1.2), (6, 1.0))
    slow: float = 0.7
    recovery: float = 4.0
    patience: int = 9
    remesh_every: int = 20
    remesh_above: float = 0.7
    remesh_below: float = 1 / 50
    smaller: float = 0.8
    meshes: int = 5
    max_points: int = 5000
    max_newton: int = 1_000_000

    def __post_init__(self) -> None:
        for name in ("ds_min", "ds", "ds_max", "bend", "slow", "recovery", "remesh_above"):
            positive(name, getattr(self, name))
        if not self.ds_min <= self.ds <= self.ds_max:
            raise ValueError(
                f"ds is {self.ds}; it must lie from ds_min = {self.ds_min} to ds_max = {self.ds_max}"
            )
        for name in ("turn", "aim", "smaller"):
            between(name, getattr(self, name), 0, 1)
        for name in ("noise", "remesh_below"):
            at_least_0(name, getattr(self, name))
        if not isinstance(self.winding, WindingLimits):
            raise ValueError(f"winding is {self.winding!r}; it must be WindingLimits(...)")
        for name in ("max_points", "max_newton", "patience", "remesh_every", "meshes"):
            object.__setattr__(self, name, whole(name, getattr(self, name)))
        try:
            pairs = [(whole("count", count), positive("factor", factor)) for count, factor in self.growth]
        except (TypeError, ValueError):
            pairs = []
        if not pairs:
            raise ValueError(f"growth is {self.growth!r}; it must be pairs of a count and a positive factor")

    def down_to(self, least: float) -> ArclengthControl:
        """Return the control with another least step.

        Parameters
        ----------
        least : float
            The least step.

        Returns
        -------
        ArclengthControl
            Itself where it has that.
        """
        return self if least == self.ds_min else replace(self, ds_min=least)

    def next_size(self, ds: float, iterations: int, ratio: float) -> float:
        """Return the next step from the Newton iterations of the last and how near it came to its bounds.

        Parameters
        ----------
        ds : float
            Length of the last step.
        iterations : int
            Its Newton iterations.
        ratio : float
            Largest ratio of turning, bending and winding to its bound, expected of another step as long.

        Returns
        -------
        float
            Its length, from ds_min to ds_max.
        """
        factor = next((factor for most, factor in self.growth if iterations <= most), self.slow)
        if ds < self.ds and iterations <= self.growth[0][0]:
            factor = max(factor, min(self.recovery, self.ds / ds))
        factor = min(factor, self.aim / max(ratio, self.aim / max(self.recovery, 2)))
        return min(max(ds * rounded(factor), self.ds_min), self.ds_max)

    def shorter(self, ratio: float) -> float:
        """Return the part of a rejected step to be tried next.

        Parameters
        ----------
        ratio : float
            By what factor it exceeded a bound.

        Returns
        -------
        float
            The part, from 0.25 to 0.75.
        """
        return rounded(min(max(self.aim / ratio, 0.25), 0.75))


def rounded(factor: float) -> float:
    """Return a factor in whole hundredths, so that rounding in an orbit does not change later steps."""
    return float(np.floor(100 * factor)) / 100
