"""What is watched along a branch besides its stability: columns, events, limits, and when to stop."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from periodic.bifurcations.codimension2 import codim2
from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.checks import named
from periodic.conditions.extremes import PeakToPeak
from periodic.conditions.functionals import Functional, Value
from periodic.conditions.levels import Level
from periodic.correction.problem import Problem
from periodic.correction.solution import Solution
from periodic.orbit.layout import layout_of
from periodic.orbit.orbit import Orbit
from periodic.results.peaks import PEAK_OF, usual_peaks
from periodic.results.point import Point
from periodic.system import System, index_of
from periodic.tracing.steps.leveltest import called, finite, level_test
from periodic.tracing.steps.stationarytest import stationary_test


@dataclass(frozen=True, kw_only=True)
class Watch:
    """What is watched along a branch.

    Parameters
    ----------
    columns : mapping of str to functional
        Functionals of the orbit kept at each point, by the names of their columns.
    events : mapping of str to Level
        Levels of functionals, by name; where one is passed the branch gets a point (UZ).
    peaks : mapping of str to functional, optional
        Functionals, by name, as {"peak of x": PeakToPeak("x")}; where one is stationary along the branch, as
        at a resonance, the branch gets a point (PK), however long its steps are. By default the peak to peak
        of each coordinate; {} for none. Steps are so long that the curves of peak to peaks between the points
        are right to 1 % of their range.
    limits : mapping of str to (float, float)
        Ranges of further parameters (SI) that end the branch.
    stop : mapping of str to int
        Number of points of a label or event after which the branch ends, as {"LP": 2}, counted from the start
        in each direction.
    special : tuple of TestFunction
        Further kinds of special points.
    progress : callable, optional
        Called with each point.
    journal : str or Path, optional
        A file that keeps every step as it is done, for `recovered` if the process is killed.

    Raises
    ------
    ValueError
        For names that are not known and values that make no sense.
    """

    columns: Mapping[str, Functional] = field(default_factory=dict)
    events: Mapping[str, Level] = field(default_factory=dict)
    peaks: Mapping[str, Functional] | None = None
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    stop: Mapping[str, int] = field(default_factory=dict)
    special: tuple[TestFunction, ...] = ()
    progress: Callable[[Point], None] | None = None
    journal: str | Path | None = None

    def __post_init__(self) -> None:
        kinds = {"columns": "functionals", "events": "levels", "peaks": "functionals", "limits": "ranges"}
        for name, what in {**kinds, "stop": "counts"}.items():
            named(name, self.asked if name == "peaks" else getattr(self, name), what)
        known = [label.value for label in Label.known()]
        for what, name, functional in (
            *(("column", *each) for each in self.columns.items()),
            *(("peak", *each) for each in self.asked.items()),
        ):
            if isinstance(functional, type) or not callable(functional):
                raise ValueError(f"{what} {name} is {functional!r}; it must be a functional of an orbit")
        for name in self.asked:
            if name in (*known, *self.events):
                raise ValueError(f"peaks has {name!r}, which is a label or an event; it must be another name")
        for name, event in self.events.items():
            if not isinstance(event, Level):
                raise ValueError(f"event {name} is {event!r}; it must be a Level(functional, value)")
            if isinstance(event.value, str):
                raise ValueError(f"event {name} is {event!r}; its value must be a number")
            if name in known:
                raise ValueError(f"events has {name!r}, which is a label; it must be another name")
        for name, count in self.stop.items():
            if name not in (*known, *self.events, *self.asked) and not name.startswith(PEAK_OF):
                among = ", ".join((*known, *self.events, *self.asked))
                raise ValueError(f"stop has {name!r}; it must name a label or an event: {among}")
            if isinstance(count, bool) or not (isinstance(count, int) and count >= 1):
                raise ValueError(f"stop of {name} is {count!r}; it must be a whole number of at least 1")
        self._check_others()

    def _check_others(self) -> None:
        special: object = self.special
        if not isinstance(special, Sequence):
            raise ValueError(f"special is {special!r}; it must be a tuple of TestFunction(label=, value=)")
        for test in self.special:
            if not isinstance(test, TestFunction):
                raise ValueError(f"special has {test!r}; it must be a TestFunction(label=, value=)")
        for name, ends in self.limits.items():
            if not _rising(ends):
                raise ValueError(f"limits of {name} are {ends}; they must be two rising finite numbers")
        if self.progress is not None and not callable(self.progress):
            raise ValueError(f"progress is {self.progress!r}; it must be a function of a point")
        if self.journal is not None and not (isinstance(self.journal, str | Path) and str(self.journal)):
            raise ValueError(f"journal is {self.journal!r}; it must be the name of a file")

    @property
    def asked(self) -> Mapping[str, Functional]:
        """The peaks that were asked for."""
        return {} if self.peaks is None else self.peaks

    def swings(self, problem: Problem) -> dict[str, TestFunction]:
        """Return the peak to peaks that are watched: those asked for, by default those of all coordinates.

        Parameters
        ----------
        problem : Problem
            What is traced; of curves of special points none are watched unless asked for.

        Returns
        -------
        dict of str to TestFunction
            By output, that of its stationary points.
        """
        asked = {n: f.output for n, f in self.asked.items() if isinstance(f, PeakToPeak)}
        if self.peaks is None and codim2.picked(problem) is None:
            asked = usual_peaks(layout_of(problem.full))
        return {output: _checked(stationary_test(PeakToPeak(output), n)) for n, output in asked.items()}

    def tests(self) -> tuple[TestFunction, ...]:
        """Return the test functions of further special points, of events, peaks and limits.

        Returns
        -------
        tuple of TestFunction
            In this order.
        """
        events = [
            level_test(event.functional, float(event.value), Label.USER, n)
            for n, event in self.events.items()
        ]
        limits = [
            level_test(Value(name), value + side * slack(value), Label.END, f"{word} limit of {name}")
            for name, ends in self.limits.items()
            for side, word, value in zip((-1, 1), ("lower", "upper"), ends, strict=True)
        ]
        peaks = [
            _checked(stationary_test(functional, n))
            for n, functional in self.asked.items()
            if not isinstance(functional, PeakToPeak)
        ]
        return (*map(_checked, self.special), *events, *peaks, *limits)

    def measured(self, system: System, orbit: Orbit) -> dict[str, float]:
        """Return the columns of an orbit.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            The orbit.

        Returns
        -------
        dict of str to float
            Values of the functionals, by the names of their columns.
        """
        found = {}
        for name, functional in self.columns.items():
            value = called(f"column {name}", functional, system, orbit)
            if not isinstance(value, int | float | np.number):
                raise ValueError(f"column {name} gave {value!r}; it must give a number")
            found[name] = float(value)
        return found

    def check(self, system: System, orbit: Orbit) -> None:
        """Check that an orbit to start from lies within the limits, and that peaks to stop at are watched.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            The first orbit.

        Raises
        ------
        ValueError
            If it lies outside, and for a peak that is none.
        """
        for name in self.stop:
            if name in (*self.events, *self.asked) or not name.startswith(PEAK_OF):
                continue
            usual = usual_peaks(layout_of(system)) if self.peaks is None else {}
            if name not in usual:
                among = ", ".join(usual) or "none"
                raise ValueError(f"stop has {name!r}; the peaks that are watched are {among}")
        for name, (low, high) in self.limits.items():
            value = float(orbit.parameter[index_of(system, name)])
            if not low - slack(low) <= value <= high + slack(high):
                raise ValueError(f"{name} is {value} at the start; its limits are {low} to {high}")


def _rising(ends: object) -> bool:
    """Whether two values are finite numbers in rising order."""
    if not (isinstance(ends, Sequence | np.ndarray) and len(ends) == 2):
        return False
    numbers = all(isinstance(end, int | float | np.number) and math.isfinite(end) for end in ends)
    return bool(numbers and ends[0] < ends[1])


def slack(limit: float) -> float:
    """How far beyond a limit a parameter may lie: by rounding."""
    return 1e-12 * abs(limit)


def _checked(test: TestFunction) -> TestFunction:
    """The same test function; it raises ValueError where its value is no finite number."""
    name = f"special point {test.label.value or test.name}"

    def value(solution: Solution) -> float:
        found = test.value(solution)
        return finite(name, found, solution)

    return replace(test, value=value)
