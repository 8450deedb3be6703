"""Everything over a parameter: branches joined, shares of basins, what is seen from many starts beneath."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from periodic.checks import one_of, two, whole
from periodic.correction.outcome import FAILURES
from periodic.correction.tolerance import Accuracy
from periodic.display.htmltables import with_unit
from periodic.display.meter import meter
from periodic.orbit.layout import layout_of
from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.box import box_of
from periodic.phasespace.charted import Atlas, Sheet, stretches
from periodic.phasespace.motion import Motion, Motions, Sort
from periodic.phasespace.search import Search, search_of
from periodic.phasespace.stages import Stages
from periodic.phasespace.traced import traced
from periodic.results.branch import Branch
from periodic.system import System, index_of
from periodic.tracing.steps.stepsize import ArclengthControl

NEAR = 1e-3
"""Distance of an orbit's states from a branch's, in widths of the box, where it is on it."""

FEW = 6
"""Starts at each value of the diagram."""

SETTLE = 1000
"""Most periods that a motion is followed."""

BRANCHES = 16
"""Most branches that are traced."""

POINTS = 2000
"""Most points of a branch in each direction."""

LOOKED = 48
"""Periods of each settled motion that the diagram beneath shows."""


def atlas(
    system: System,
    parameter: str,
    bounds: tuple[float, float],
    values: Mapping[str, float] | None = None,
    *,
    box: Mapping[str, tuple[float, float]] | None = None,
    state: str | None = None,
    count: int = 21,
    diagram: int = 200,
    periods: int = 4,
    starts: int = 64,
    places: int = 16,
    tol: float = Accuracy.STANDARD,
) -> Atlas:
    """Return what an excited system can do over a parameter.

    At `count` values all motions are looked for as `motions` does. The branch of each orbit that is on no
    known one is traced through the whole range. Shares of the box are those of the starts at each value.

    Parameters
    ----------
    system : System
        The equations; one that integrates itself in time, as those of `symbolic.compile` do.
    parameter : str
        The parameter.
    bounds : tuple of float
        Its range (SI).
    values : mapping of str to float, optional
        Other parameters (SI) that differ from their nominal values.
    box : mapping of str to (float, float), optional
        Ranges of states (SI) in which motions start, as in `motions`; by default that of the lower end.
    state : str, optional
        The state that the picture shows at tau = 0; by default the first.
    count : int
        Values at which motions are looked for.
    diagram : int
        Values of the diagram beneath, of motions from a few starts each.
    periods, starts, places, tol
        As in `motions`.

    Returns
    -------
    Atlas
        Branches, shares, diagram.

    Raises
    ------
    ValueError
        For what is not allowed.
    """
    place = index_of(system, parameter)
    low, high = two("bounds", bounds)
    if parameter in (values or {}):
        raise ValueError(f"values has {parameter!r}, over which the atlas is; it must be left out")
    whole("diagram", diagram, 2)
    names = [each.name for each in system.states]
    column = names.index(names[0] if state is None else one_of("state", state, names))
    at = np.linspace(low, high, whole("count", count, 2))
    first = search_of(
        system, {**(values or {}), parameter: low}, box, periods, starts, SETTLE, places, 0, tol
    )
    if first.frequency:
        raise ValueError("the system is not excited: its equations do not depend on the phase; they must")
    chart = Chart(first, parameter, at)
    with meter(f"atlas over {parameter}", "values", len(at) + diagram) as show:
        for k, value in enumerate(at):
            found = chart.look(k, float(value))
            show(1, f"{len(found)} motions at {value:.6g}, {len(chart.sheets)} branches")
        dots = [chart.dots(float(value), column, show) for value in np.linspace(low, high, diagram)]
    return Atlas(
        parameter,
        names[column],
        with_unit(parameter, system.parameters[place].unit),
        with_unit(f"{names[column]} at tau = 0", layout_of(system).column(names[column]).unit),
        at,
        tuple(chart.motions),
        tuple(chart.sheets),
        np.concatenate(dots),
        tuple(chart.remarks),
    )


@dataclass(frozen=True, eq=False)
class Chart:
    """What is known of a system over a parameter so far: branches with their orbits at the values `at`.

    first: the search at the first value. remarks: what could not be done.
    """

    first: Search
    parameter: str
    at: Array
    sheets: list[Sheet] = field(default_factory=list)
    motions: list[Motions] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)

    def look(self, k: int, value: float) -> Motions:
        """Look for all motions at one of the values, and trace branches of those on none that is known."""
        search = self._there(value)
        found = Stages(search, {}).run(lambda said: None)
        self.motions.append(found)
        for motion in found:
            if motion.point is None or motion.sort != Sort.PERIODIC:
                continue
            if self._on(search, k, motion) is None:
                self._trace(value, motion)
            if (on := self._on(search, k, motion)) is not None and on[1] >= 0:
                on[0].shares[on[1], k] += motion.share
        return found

    def dots(self, value: float, column: int, show: Callable[[int, str], None]) -> Array:
        """Return value and a state (K, 2) of settled motions from a few starts, at tau = 0."""
        search = self._there(value)
        crowd = search.crowd
        y = crowd.begin(search.box.draw(FEW, search.seed, crowd.system, crowd.parameter))
        settled = crowd.run(y, search.settle, FORCED)
        path = crowd.run(settled.ends, LOOKED, FORCED, modes=settled.modes, keep=True)
        assert path.sections is not None
        states = search.box.unit[column] * path.sections[:, :, column].ravel()
        states = states[np.isfinite(states)]
        show(1, f"at {value:.6g}")
        return np.column_stack([np.full(len(states), value), states])

    def _there(self, value: float) -> Search:
        """The search at a value of the parameter, in the same box (SI)."""
        crowd, ranges = self.first.crowd, self.first.box.ranges
        parameter = crowd.parameter.copy()
        parameter[index_of(crowd.system, self.parameter)] = value
        box = box_of(crowd.system, parameter, ranges, np.array([self.first.box.low, self.first.box.high]))
        return replace(self.first, crowd=replace(crowd, parameter=parameter), box=box)

    @staticmethod
    def _same(search: Search, one: Array, other: Array) -> bool:
        """Whether two orbits at the value of a search are one."""
        return search.clock.same(one, other, search.box.width, NEAR)

    def _on(self, search: Search, k: int, motion: Motion) -> tuple[Sheet, int] | None:
        """The branch on which an orbit at the k-th value is, and its stable stretch there, -1 for none."""
        for sheet in self.sheets:
            for stretch, states in sheet.sections[k]:
                if self._same(search, motion.sections, states):
                    return sheet, stretch
        return None

    def _trace(self, value: float, motion: Motion) -> None:
        """Add the branch of an orbit through the range, where it can be traced."""
        assert motion.point is not None
        what = f"the branch of the motion {motion.name}, at {value:.9g}, was not traced"
        if len(self.sheets) == BRANCHES:
            self.remarks.append(f"{what}: there are {BRANCHES} branches already")
            return
        try:
            branch = traced(
                self.first.crowd,
                self.parameter,
                (float(self.at[0]), float(self.at[-1])),
                start=value,
                at=[float(v) for v in self.at],
                guess=motion.point.orbit,
                tol=self.first.tol,
                control=ArclengthControl(max_points=POINTS),
            )
        except FAILURES as failed:
            self.remarks.append(f"{what}: {failed}")
            return
        shares = np.zeros((max(stretches(branch), default=-1) + 1, len(self.at)))
        sections = self._sections(branch, motion.periods)
        self.sheets.append(Sheet(branch, motion.periods, sections, shares))

    def _sections(self, branch: Branch, periods: int) -> list[list[tuple[int, Array]]]:
        """At each value the stretch and the states, once in each period, of a branch's orbits there."""
        found: list[list[tuple[int, Array]]] = [[] for _ in self.at]
        for point, stretch in zip(branch, stretches(branch), strict=True):
            k = int(np.argmin(np.abs(self.at - point.parameter)))
            if abs(point.parameter - self.at[k]) <= 1e-9 * max(1.0, abs(self.at[k])):
                found[k].append((stretch, point.orbit.state(FORCED * np.arange(float(periods)))))
        return found
