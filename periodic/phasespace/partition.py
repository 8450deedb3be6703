"""Starts by the motions to which they lead: shares, integrity, a picture."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from periodic.checks import whole
from periodic.display.htmltables import with_unit
from periodic.orbit.scheme import Array
from periodic.phasespace.motion import Motion
from periodic.phasespace.picture import Elsewhere, drawn

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False, repr=False)
class Basins:
    """To which motion a system comes, from each of many starts.

    Parameters
    ----------
    motions : tuple of Motion
        Where it comes, the largest basin first; their shares are those of these starts.
    labels : ndarray of int
        The index of the motion for each start: shape (S,), or (rows, columns) on a plane; -1 where it grows
        beyond all bounds, -2 where its end is not known, -3 of places behind a wall.
    states : ndarray, shape (S, n)
        The starts (SI), in the order of the labels.
    names : tuple of str
        Names of the states.
    plane : tuple of str
        The two states of a plane, across and up; else empty.
    box : dict
        The ranges of states (SI), by name.
    unit : ndarray, shape (n,)
        SI values of one internal unit of each state.
    units : dict
        SI units of the states, by name; "" where they have none.
    """

    motions: tuple[Motion, ...]
    labels: NDArray[np.int_]
    states: Array = field(repr=False)
    names: tuple[str, ...]
    plane: tuple[str, ...]
    box: dict[str, tuple[float, float]]
    unit: Array = field(repr=False)
    units: dict[str, str] = field(repr=False)

    def __repr__(self) -> str:
        each = ", ".join(f"{100 * motion.share:.2f} % {motion.name}" for motion in self.motions)
        return f"Basins({self.labels.size} starts: {each})"

    @property
    def shares(self) -> dict[int, float]:
        """The part of the starts of each label, of those that are behind no wall."""
        counted = self.labels[self.labels != Elsewhere.BEHIND]
        found, counts = np.unique(counted, return_counts=True)
        return {int(k): float(count) / max(counted.size, 1) for k, count in zip(found, counts, strict=True)}

    def integrity(self, which: int = 0) -> float:
        """Return how far a motion is, at tau = 0, from the nearest start that leads elsewhere.

        Parameters
        ----------
        which : int
            The index of the motion.

        Returns
        -------
        float
            The distance in half widths of the box, of the states of the plane if there is one (the local
            integrity measure of Rega & Lenci, Nonlinear Analysis 63 (2005) 902). Infinite where all starts
            lead there.

        Raises
        ------
        ValueError
            For a motion that does not exist.
        """
        if not 0 <= whole("which", which, 0) < len(self.motions):
            raise ValueError(f"which is {which}; it must be below {len(self.motions)}, the number of motions")
        columns = [self.names.index(name) for name in self.plane] or list(range(len(self.names)))
        half = np.array([(self.box[self.names[k]][1] - self.box[self.names[k]][0]) / 2 for k in columns])
        flat = self.labels.ravel()
        others = self.states[(flat != which) & (flat != Elsewhere.BEHIND)][:, columns]
        if not len(others):
            return float("inf")
        own = (self.motions[which].sections * self.unit)[:, columns]
        away = np.linalg.norm((others[:, None] - own) / half, axis=2)
        return float(away.min())

    def plot(self, axes: Axes | None = None) -> Axes:
        """Plot the basins on their plane, with the motions at tau = 0.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Where to plot; by default in a figure of its own.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.

        Raises
        ------
        ValueError
            For starts that are on no plane.
        """
        if not self.plane:
            raise ValueError("the starts are on no plane; basins(plane=(...)) must give one for a picture")
        columns = [self.names.index(name) for name in self.plane]
        places = [(motion.sections * self.unit)[:, columns] for motion in self.motions]
        plane = [(with_unit(name, self.units[name]), self.box[name]) for name in self.plane]
        return drawn(self.labels, self.motions, places, plane, axes)
