"""What is known of a system over a parameter so far: branches, and the motions at some values."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from periodic.correction.outcome import FAILURES
from periodic.display.meter import Advance
from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.atlases.sheet import Sheet
from periodic.phasespace.atlases.stretches import stretches
from periodic.phasespace.following.box import box_of
from periodic.phasespace.following.traced import traced
from periodic.phasespace.motion import Motion, Motions, Sort
from periodic.phasespace.search.search import Search
from periodic.phasespace.search.stages import Stages
from periodic.results.branch import Branch
from periodic.system import index_of
from periodic.tracing.steps.stepsize import ArclengthControl

NEAR = 1e-3
"""Distance of an orbit's states from a branch's, in widths of the box, where it is on it."""

FEW = 6
"""Starts at each value of the diagram."""

BRANCHES = 16
"""Most branches of stable motions; those of unstable ones are traced while there are fewer."""

POINTS = 2000
"""Most points of a branch in each direction."""

LOOKED = 48
"""Periods of each settled motion that the diagram beneath shows."""


@dataclass(frozen=True, eq=False)
class Chart:
    """Branches with their orbits at the values `at`, and all motions there.

    first: the search at the first value. dots: of the diagram beneath. lost: why branches were not traced.
    left: values at which there are motions whose branches were not.
    """

    first: Search
    parameter: str
    at: Array
    sheets: list[Sheet] = field(default_factory=list)
    motions: list[Motions] = field(default_factory=list)
    dots: list[Array] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    left: list[tuple[float, bool]] = field(default_factory=list)

    def run(self, diagram: Array, column: int, show: Advance) -> None:
        """Do all of it; a state's diagram at those values."""
        for value in self.at:
            self.motions.append(Stages(self._there(float(value)), {}).run(lambda said: None))
            show(1, f"{len(self.motions[-1])} motions at {value:.6g}")
        for stable in (True, False):
            for k, found in enumerate(self.motions):
                for motion in found:
                    if motion.stable == stable and motion.point is not None and motion.sort == Sort.PERIODIC:
                        self._placed(k, motion)
                show(stable, f"{len(self.sheets)} branches")
        for value in diagram:
            self.dots.append(self._dots(float(value), column))
            show(1, f"diagram at {value:.6g}")

    @property
    def remarks(self) -> tuple[str, ...]:
        """What could not be done, in words."""
        told = list(self.lost)
        for stable, name in ((True, "stable"), (False, "unstable")):
            at = [value for value, kind in self.left if kind == stable]
            if at:
                where = f"from {min(at):.6g} to {max(at):.6g}"
                told.append(
                    f"the branches of {len(at)} {name} motions {where} were not traced; there are others"
                )
        return tuple(told)

    def _placed(self, k: int, motion: Motion) -> None:
        """Put a motion at the k-th value on its branch, which is traced unless it is known."""
        search = self._there(float(self.at[k]))
        if self._on(search, k, motion) is None:
            self._trace(float(self.at[k]), motion)
        if (on := self._on(search, k, motion)) is not None and on[1] >= 0:
            on[0].shares[on[1], k] += motion.share

    def _dots(self, value: float, column: int) -> Array:
        """Return value and a state (K, 2) of settled motions from a few starts, at tau = 0."""
        search = self._there(value)
        crowd = search.crowd
        y = crowd.begin(search.box.draw(FEW, search.seed, crowd.system, crowd.parameter))
        settled = crowd.run(y, search.settle, FORCED)
        path = crowd.run(settled.ends, LOOKED, FORCED, modes=settled.modes, keep=True)
        assert path.sections is not None
        states = search.box.unit[column] * path.sections[:, :, column].ravel()
        states = states[np.isfinite(states)]
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
        if len(self.sheets) == BRANCHES:
            self.left.append((value, motion.stable))
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
            self.lost.append(
                f"the branch of the motion {motion.name}, at {value:.9g}, was not traced: {failed}"
            )
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
