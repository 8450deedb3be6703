"""A branch of an atlas, with the shares of its stable stretches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.scheme import Array
from periodic.results.betweenpoints import smooth
from periodic.results.branch import Branch

FINER = 8
"""Samples of a curve from one point to the next."""


@dataclass(frozen=True, eq=False)
class Sheet:
    """A branch of an atlas.

    Parameters
    ----------
    branch : Branch
        The orbits.
    periods : int
        After how many excitation periods they come back.
    sections : list of list of (int, ndarray)
        At each of the atlas's values its orbits there: the number of the stable stretch, -1 where unstable,
        and the states once in each period.
    shares : ndarray, shape (stretches, K)
        The part of the box that leads to the orbits of each of its stable stretches, at each value.
    """

    branch: Branch
    periods: int
    sections: list[list[tuple[int, Array]]]
    shares: Array

    @property
    def name(self) -> str:
        """What its orbits are, in words."""
        return "one period" if self.periods == 1 else f"{self.periods} periods"

    def curve(self, heights: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Return a smooth curve of a height over the parameter, through the points, and where it is stable.

        Parameters
        ----------
        heights : ndarray
            The height at each point of the branch, (K,).

        Returns
        -------
        across, up : ndarray, shape (N,)
            The curve.
        stable : ndarray of bool, shape (N,)
            Whether it is stable from each sample to the next.
        """
        across, up = smooth(self.branch.values, heights, FINER)
        stable = np.repeat(self.branch.stable_between, FINER)
        return across, up, np.append(stable, stable[-1:]) if len(stable) else self.branch.stable
