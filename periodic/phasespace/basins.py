"""Basins: to which motion a system comes from where."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from periodic.checks import number, one_of, whole
from periodic.correction.tolerance import Accuracy
from periodic.display.meter import meter
from periodic.orbit.layout import layout_of
from periodic.orbit.scheme import Array
from periodic.phasespace.following.box import Box, ahead
from periodic.phasespace.motion import Motion, Motions, Sort, interval
from periodic.phasespace.partition import Basins
from periodic.phasespace.picture import Elsewhere
from periodic.phasespace.search.aperiodic import Attractors
from periodic.phasespace.search.search import Search, search_of
from periodic.phasespace.search.stages import SearchInterrupted
from periodic.system import System

AT_ONCE = 8192
"""Motions that are followed together."""


def basins(
    system: System,
    values: Mapping[str, float] | None = None,
    *,
    box: Mapping[str, tuple[float, float]] | None = None,
    plane: tuple[str, str] | None = None,
    grid: tuple[int, int] = (300, 300),
    at: Mapping[str, float] | None = None,
    starts: int = 4096,
    motions: Motions | None = None,
    periods: int = 6,
    settle: int = 2000,
    seed: int = 0,
    tol: float = Accuracy.STANDARD,
) -> Basins:
    """Return to which motion a system comes, from random starts in a box or from a plane of two states.

    Parameters
    ----------
    system : System
        The equations; one that integrates itself in time, as those of `symbolic.compile` do.
    values : mapping of str to float, optional
        Parameters (SI) that differ from their nominal values.
    box : mapping of str to (float, float), optional
        Ranges of states (SI), as in `motions`.
    plane : tuple of str, optional
        Two states, across and up: starts are the middles of the cells of a grid on their ranges.
    grid : tuple of int
        Cells across and up.
    at : mapping of str to float, optional
        The other states on a plane (SI); by default in the middle of their ranges.
    starts : int
        How many motions start at random, without a plane.
    motions : Motions, optional
        What is known of the system at these parameters; what is not among them is found.
    periods, settle, seed, tol
        As in `motions`.

    Returns
    -------
    Basins
        The motions with their shares of the starts.

    Raises
    ------
    ValueError
        For names, numbers, ranges and systems that are not allowed.
    SearchInterrupted
        For Ctrl-C: its `found` are the basins as far as they are known.
    """
    search = search_of(system, values, box, periods, whole("starts", starts), settle, 0, seed, tol)
    if plane is None:
        states = search.box.draw(starts, seed, system, search.crowd.parameter)
        shape: tuple[int, ...] = (starts,)
    else:
        states = _on_plane(search.box, plane, grid, {} if at is None else at)
        shape = (grid[1], grid[0])
    found = Sorted(search, motions, len(states))
    labels = found.labels(states)
    every = found.motions
    stable = [k for k, motion in enumerate(every) if motion.stable]
    order = sorted(stable, key=lambda k: -int((labels == k).sum()))
    moved = {k: place for place, k in enumerate(order)}
    labels = np.array([moved.get(int(k), int(k)) for k in labels])
    counted = int((labels != Elsewhere.BEHIND).sum())
    named = tuple(_counted(every[k], int((labels == place).sum()), counted) for place, k in enumerate(order))
    unit = search.box.unit
    made = Basins(
        named,
        labels.reshape(shape),
        states * unit,
        search.box.names,
        () if plane is None else tuple(plane),
        search.box.ranges,
        unit,
        {name: layout_of(system).column(name).unit for name in search.box.names},
    )
    if found.interrupted:
        raise SearchInterrupted(made, f"the {len(states)} starts, those not followed as open, are")
    return made


@dataclass(eq=False)
class Sorted:
    """Starts sorted by where they lead; what is known at first, and all that is found on the way."""

    search: Search
    known: Motions | None
    count: int
    interrupted: bool = field(default=False, init=False)

    def __post_init__(self) -> None:
        clock, unit = self.search.clock, self.search.box.width
        self._orbits = self.search.settling(np.zeros((0, 0))).orbits
        self._others = Attractors(self.search.crowd, clock, unit)
        for motion in () if self.known is None else self.known:
            if motion.sort in (Sort.PERIODIC, Sort.EQUILIBRIUM):
                self._orbits.each.append(clock.again(motion, unit))
            elif motion.stable:
                self._others.add(motion)

    @property
    def motions(self) -> list[Motion]:
        """All that starts may lead to."""
        orbits = [self.search.motion(one, self.count) for one in self._orbits.each]
        return orbits + [self._others.motion(k, 0, self.count) for k in range(len(self._others.found))]

    def labels(self, states: Array) -> NDArray[np.int_]:
        """Return where states (S, n) lead."""
        crowd = self.search.crowd
        found = np.full(len(states), Elsewhere.BEHIND)
        inside = np.flatnonzero(ahead(crowd.system, states, crowd.parameter))
        orbit, other = np.full(len(states), -1), np.full(len(states), -1)
        with meter("basins", "starts", len(inside)) as show:
            for first in range(0, len(inside), AT_ONCE):
                part = inside[first : first + AT_ONCE]
                found[part] = Elsewhere.OPEN
                if self.interrupted:
                    continue
                found[part], orbit[part], other[part] = self._part(states[part])
                show(len(part), f"{len(self._orbits)} orbits")
        found[orbit >= 0] = orbit[orbit >= 0]
        found[other >= 0] = other[other >= 0] + len(self._orbits)
        return found

    def _part(self, states: Array) -> tuple[Any, Any, Any]:
        """Of some states whether they diverge, at which orbit they end, on which other attractor they are."""
        settling = self.search.settling(self.search.crowd.begin(states))
        settling.orbits = self._orbits
        try:
            settling.run()
        except KeyboardInterrupt:
            self.interrupted = True
        other = np.full(len(states), -1)
        if not self.interrupted:
            other[settling.left] = self._others.sorted_of(settling)
        plain = np.full(len(states), Elsewhere.OPEN)
        plain[settling.gone] = Elsewhere.DIVERGED
        return plain, settling.label, other


def _counted(motion: Motion, count: int, of: int) -> Motion:
    """A motion with the share of these starts."""
    return replace(motion, starts=count, share=count / max(of, 1), interval=interval(count, of))


def _on_plane(box: Box, plane: Sequence[str], grid: Sequence[int], at: Mapping[str, float]) -> Array:
    """The states in the middles of the cells of a grid on a plane of a box, scaled, row by row."""
    if len(plane) != 2 or plane[0] == plane[1]:
        raise ValueError(f"plane is {plane!r}; it must be the names of two states")
    columns = [box.names.index(one_of("a state of plane", name, box.names)) for name in plane]
    if len(grid) != 2:
        raise ValueError(f"grid is {grid!r}; it must be two numbers of cells")
    counts = [whole("grid", count, 2) for count in grid]
    state = (box.low + box.high) / 2
    for name, value in at.items():
        k = box.names.index(one_of("a state in at", name, box.names))
        if k in columns:
            raise ValueError(f"at has {name!r}, which is a state of the plane; it must be another")
        state[k] = number(f"at[{name!r}]", value) / box.unit[k]
    middles = [
        box.low[k] + box.width[k] * (np.arange(count) + 0.5) / count
        for k, count in zip(columns, counts, strict=True)
    ]
    across, up = np.meshgrid(*middles)
    found = np.tile(state, (across.size, 1))
    found[:, columns[0]], found[:, columns[1]] = across.ravel(), up.ravel()
    return found
