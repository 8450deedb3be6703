"""A branch: the points of one continuation, and ways to read, show and keep them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from periodic.bifurcations.codimension2.remarks import noted
from periodic.bifurcations.label import Label
from periodic.bifurcations.ledger import Entry, Gap, counts, gaps
from periodic.checks import one_of
from periodic.correction.error import shortfall
from periodic.orbit.scheme import Array
from periodic.results import frames, netcdf
from periodic.results.atvalue import points_at_value
from periodic.results.betweenpoints import PER_SEGMENT, curve, slopes_of, smooth
from periodic.results.branchoverview import branch_html
from periodic.results.peaks import PEAK_OF, labelled_corners, usual_peaks
from periodic.results.point import Point
from periodic.results.record import Record
from periodic.results.stop import Stop

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


INTRINSIC = ("PhaseCondition", "Conservative")
"""Conditions that every orbit meets. With others a branch is a curve, whose folds have no label."""


class Branch(Record):
    """The points of one continuation, a sequence in order along the branch.

    Parameters
    ----------
    parameter : str
        Name of the parameter that was continued in.
    layout : Layout
        Names, units and scales of the system's quantities.
    points : tuple of Point
        The points, in order along the branch.
    stop : Stop
        Why the branch ended.
    stop_backwards : Stop, optional
        Why its first part ended, of a branch that was traced both ways from its start.
    newton_iterations : int
        Newton iterations, those of rejected steps included.
    elapsed : float
        Time in s.
    versions : dict
        Versions of the packages that made it, by name.
    checkpoints : tuple of Checkpoint
        The state of each of its one or two runs, from which `trace` goes on with it.
    backwards : int
        Number of points at its begin that the first of two runs computed.
    made : dict
        The settings that it was computed with, by value: see `periodic.results.described`.
    onwards : callable, optional
        How it was traced, for `at`; a file does not keep it.
    """

    def __repr__(self) -> str:
        return f"Branch({self.parameter}, {len(self)} points, {self.ending})"

    @property
    def stops(self) -> tuple[Stop, ...]:
        """Why it ends, at both ends of a branch that was traced both ways, the first one first."""
        return (self.stop,) if self.stop_backwards is None else (self.stop_backwards, self.stop)

    @property
    def ending(self) -> str:
        """The reason why it ends, in words; both reasons where they differ between its ends."""
        back = self.stop_backwards
        if back is None or back.reason is self.stop.reason:
            return str(self.stop)
        return f"{self.stop}; the other way {back}"

    def _repr_html_(self) -> str:
        return branch_html(self, self.stable_between, (repr(self), *self.remarks))

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, index: int) -> Point:
        if not self.points:
            raise IndexError(f"branch has no points; it ended with: {self.stop}")
        try:
            return self.points[index]
        except IndexError:
            raise IndexError(f"index is {index}; the branch has {len(self)} points") from None

    def __iter__(self) -> Iterator[Point]:
        return iter(self.points)

    @property
    def special_points(self) -> tuple[Point, ...]:
        """The labelled points, in order along the branch, without peaks (see `peaks`)."""
        return tuple(p for p in self.points if p.label not in (Label.NONE, Label.PEAK))

    def labelled(self, label: str) -> tuple[Point, ...]:
        """Return the points with a label, or of one of the user's events or peaks by its name.

        Parameters
        ----------
        label : Label or str
            `Label.FOLD` or "LP", or the name of an event or a peak.

        Returns
        -------
        tuple of Point
            In order along the branch.

        Raises
        ------
        ValueError
            For a text that is neither; it says which there are.
        """
        asked = [*self.made.get("events", {}), *self._peak_names]
        events = dict.fromkeys((*asked, *(p.event for p in self.points if p.event)))
        known = [*(known.value for known in Label.known()), *events]
        if label and label not in known:
            raise ValueError(f"label is {str(label)!r}; it must be one of {', '.join(known)}")
        return tuple(p for p in self.points if label == p.label or (label and label == p.event))

    def at(self, **value: float) -> tuple[Point, ...]:
        """Return the points at a value of the parameter, also between those that it has.

        Parameters
        ----------
        **value : float
            The parameter by its name, SI, as ``branch.at(Omega=2.0)``.

        Returns
        -------
        tuple of Point
            One for each time that the branch passes the value, in order along the branch, solved at the value
            itself to the tolerance.

        Raises
        ------
        ValueError
            For another name, a value that the branch does not pass, and a branch from a file, which does not
            know its system.
        ArithmeticError
            Where the value is not reached from the points beside it.
        """
        if list(value) != [self.parameter]:
            given = ", ".join(value) or "nothing"
            raise ValueError(f"at is given {given}; it takes {self.parameter}, as at({self.parameter}=1.0)")
        if self.onwards is None:
            raise ValueError(
                f"the branch is from a file, which does not know its system; "
                f"points_at(system, branch, {value[self.parameter]:g}) does"
            )
        return points_at_value(self, self.onwards, value[self.parameter])

    @property
    def peaks(self) -> dict[str, tuple[Point, ...]]:
        """The points at which each measure is greatest or least along the branch, by the name of the peak.

        By default the peak to peak of each coordinate x, as "peak of x", at corners too that have labels of
        their own, as GR or BP; else those of `Watch(peaks=)`.
        """
        usual = usual_peaks(self.layout)
        found = {}
        for name in self._peak_names:
            corners = labelled_corners(self.points, usual[name]) if name in usual else ()
            own = {id(point) for point in (*self.labelled(name), *corners)}
            found[name] = tuple(point for point in self.points if id(point) in own)
        return found

    @property
    def _peak_names(self) -> tuple[str, ...]:
        return tuple(self.made.get("peaks", usual_peaks(self.layout)))

    @property
    def _entries(self) -> list[Entry]:
        low, high = self.made.get("bounds", (0.0, 1.0))
        return [point.entry(high - low) for point in self.points]

    @property
    def unaccounted(self) -> tuple[Gap, ...]:
        """Where the number of unstable multipliers or the direction of the parameter changes between
        neighbouring points, and no labelled point explains it. On curves directions are not looked at.
        """
        picks = [d for d in self.made.get("determined", {}).values() if d.get("is") not in INTRINSIC]
        return tuple(gaps(self._entries, folds=not picks))

    @property
    def shortfall(self) -> str:
        """Which points miss the tolerance, by how much and where, in a sentence; empty if none does."""
        tolerance = self.made.get("tolerance", {}).get("orbit", np.inf)
        return shortfall([(p.parameter, p.error) for p in self.points], tolerance, self.parameter)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a reader of the branch should know, in sentences.

        Which points miss the tolerance, which changes no labelled point explains, which values of `at` the
        branch does not reach; of a curve, where its points are no special ones and what was not searched for.
        """
        curve = noted(self.points, self.made, self.parameter)
        return tuple(filter(None, (self.shortfall, *map(str, self.unaccounted), self._missed, *curve)))

    @property
    def _missed(self) -> str:
        values = self.values
        missed = [v for v in self.made.get("at", ()) if not np.isclose(values, v, rtol=1e-9, atol=0).any()]
        listed = ", ".join(f"{value:.10g}" for value in missed)
        return f"no point at {self.parameter} = {listed}: the branch does not pass there" if listed else ""

    @property
    def values(self) -> Array:
        """The continuation parameter along the branch (SI), shape (points,)."""
        return np.array([p.parameter for p in self.points])

    @property
    def stable(self) -> np.ndarray:
        """Whether each point is stable, shape (points,)."""
        return np.array([p.stable for p in self.points], dtype=bool)

    @property
    def stable_between(self) -> np.ndarray:
        """Whether the branch is stable between neighbouring points, shape (points - 1,).

        Between two special points, each with a multiplier on the unit circle, the ledger's count decides.
        """
        between = []
        known = counts(self._entries)
        for (a, b), after in zip(pairwise(self.points), known, strict=False):
            plain = [point.stable for point in (a, b) if not point.label.critical]
            between.append(all(plain) if plain else after == {0})
        return np.array(between, dtype=bool)

    def peak_to_peak(self, output: str) -> Array:
        """Return maximum minus minimum of an output along the branch.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        Array
            SI values, shape (points,).

        Raises
        ------
        ValueError
            For a name that is none; it says which there are.
        """
        one_of("output", output, [q.name for q in self.layout.outputs])
        return np.array([p.peak_to_peak(output) for p in self.points])

    def column(self, name: str) -> Array:
        """Return a column of numbers along the branch.

        Parameters
        ----------
        name : str
            A parameter, a functional that was asked for, or another column of `to_pandas`: "x p-p".

        Returns
        -------
        Array
            SI values, shape (points,).

        Raises
        ------
        ValueError
            For a name that is none; it says which there are.
        """
        one_of("column", name, frames.units(self))
        return np.array([frames.row(self, p)[name] for p in self.points])

    def curve(self, name: str, each: int = PER_SEGMENT) -> tuple[Array, Array]:
        """Return the curve of a column over the parameter, between the points too.

        Least and greatest values and peak to peaks of outputs are cubics from the tangents; the steps of a
        branch are so long that the peak to peaks that it watches are right to 1 % of their range, and mostly
        to far less. Other columns are monotone between the points.

        Parameters
        ----------
        name : str
            The column: "x p-p", "x min", "x max"; or another of `to_pandas`.
        each : int
            Values from each point, which is the first of them, to the next.

        Returns
        -------
        tuple of Array
            The parameter and the column (SI), shape ((points - 1) each + 1,); each empty of no points.

        Raises
        ------
        ValueError
            For a name that is none; it says which there are.
        """
        heights, values = self.column(name), self.values
        slopes = slopes_of(self.points, name)
        return smooth(values, heights, each) if slopes is None else curve(values, heights, *slopes, each)

    def to_xarray(self) -> xr.Dataset:
        """Return the branch as a Dataset with one entry a point, units in the variables' attributes.

        Returns
        -------
        xarray.Dataset
            Over the dimension point: parameters (SI), "x min", "x max" and "x p-p" of each output x (of
            equilibria x itself), the functionals asked for, errors, residual and iterations, `multipliers`
            (point, multiplier), complex; the coordinates label, event and stable.
        """
        return frames.to_xarray(self)

    def to_pandas(self) -> pd.DataFrame:
        """Return the branch as a table with one row a point, units in `attrs["units"]`.

        Returns
        -------
        pandas.DataFrame
            The columns are those of `to_xarray`, the multipliers in "multiplier 1" and so on.
        """
        return frames.to_pandas(self)

    def table(self) -> str:
        """Return one line per point: label, parameter, peak to peak of each output, largest multiplier.

        A peak's label has the output that it is of.

        Of equilibria the outputs themselves and the largest real part of the eigenvalues (1/s).

        Returns
        -------
        str
            A heading and the lines, all of one width; then the remarks, if there are any.
        """
        names = [q.name for q in self.layout.outputs]
        measured, largest = (" p-p", "|mu| max")
        if any(p.equilibrium for p in self.points):
            measured, largest = ("", "Re lambda max")
        head = ["label", self.parameter, *(n + measured for n in names), largest, "stable", "error"]
        rows = [head, *([*_cells(p, names)] for p in self.points)]
        widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
        lines = ["  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in rows]
        return "\n".join([*lines, *self.remarks])

    def save(self, path: str | Path) -> None:
        """Write the branch, its orbits included, to a NetCDF file, replacing it in one move.

        Parameters
        ----------
        path : str or Path
            The file.

        Raises
        ------
        BranchFileError
            Where there is something that is no ordinary file.
        OSError
            Where it cannot be written.
        """
        netcdf.save(self, Path(path))

    @staticmethod
    def load(path: str | Path) -> Branch:
        """Read a branch from a NetCDF file.

        Parameters
        ----------
        path : str or Path
            The file.

        Returns
        -------
        Branch
            The branch, bit for bit.

        Raises
        ------
        BranchFileError
            In one sentence, if it is missing, damaged or no branch.
        """
        return Branch(**vars(netcdf.load(Path(path))))


def _cells(point: Point, names: list[str]) -> list[str]:
    take = point.maximum.__getitem__ if point.equilibrium else point.peak_to_peak
    ripple = [f"{take(name):.9g}" for name in names]
    largest = point.multipliers.real if point.equilibrium else np.abs(point.multipliers)
    size = f"{largest.max():.9f}"
    stable = "yes" if point.stable else "no"
    label = point.label.value
    if point.label is Label.PEAK:
        label += f" {point.event.removeprefix(PEAK_OF)}"
    return [label, f"{point.parameter:.12g}", *ripple, size, stable, f"{point.error.worst:.1e}"]
