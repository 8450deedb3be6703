"""What a map computes in each of its cells: a branch, and numbers of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property
from typing import Any, Protocol

from periodic.checks import named
from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.correction.problem import Problem
from periodic.correction.tolerance import Accuracy, Tolerance
from periodic.orbit.orbit import Orbit
from periodic.results.branch import Branch
from periodic.results.described import described
from periodic.results.identity import identity
from periodic.system import System
from periodic.tracing.resumption import made_with
from periodic.tracing.setup import Method, Setup, setup
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.trace import trace
from periodic.tracing.watch import Watch

Read = float | Sequence[float]
"""A number, or several in order along the branch."""


class Number(Protocol):
    """What a map reads off each branch: a function of (task, branch).

    A class may also have `places`, values of the parameter at which it needs a point of the branch on every
    sheet, and the method of `Measured`.
    """

    def __call__(self, task: Task, branch: Branch) -> Read | Mapping[str, Read]:
        """Return a number, a sequence of them in order along the branch, or a mapping of these by name.

        Parameters
        ----------
        task : Task
            What was traced.
        branch : Branch
            The branch, complete and with points.

        Returns
        -------
        float, sequence of float or mapping
            SI values; {"": 3.2, "at": 1.9} of a number called "peak" become "peak" and "peak at".
        """


class Measured(Protocol):
    """A number that says its units."""

    def units(self, task: Task) -> Mapping[str, str]:
        """Return SI units by the keys of its result, "" for one number or one sequence.

        Parameters
        ----------
        task : Task
            What is traced.

        Returns
        -------
        mapping of str to str
            Units, empty where there is none.
        """


@dataclass(frozen=True)
class Task:
    """A branch to be traced in each cell of a map, and the numbers that are read off it.

    Parameters
    ----------
    system : System
        The equations; they travel to other processes by pickle.
    parameter : str
        Name of the parameter that is continued in.
    bounds : tuple of float
        Its range (SI); the first is where branches start by default.
    numbers : mapping of str to Number
        {"peak": Highest(PeakToPeak("x")), "folds": Places("LP")}; any function of (task, branch) that gives
        a number, or several, is one.
    start, tol
        As in `trace`.
    guess : Orbit, optional
        As in `trace`; it begins the first branch of each chunk of neighbours.
    values, determined, method, control, watch
        As in `trace`.

    Raises
    ------
    ValueError
        In one sentence, for what `trace` would refuse, and for numbers that are no functions.
    """

    system: System = field(repr=False)
    parameter: str
    bounds: tuple[float, float]
    _: KW_ONLY
    numbers: Mapping[str, Number]
    start: float | None = None
    tol: float | Tolerance = Accuracy.STANDARD
    guess: Orbit | None = None
    values: Mapping[str, float] | None = None
    determined: Mapping[str, Condition] | None = None
    method: Discretisation | None = None
    control: ArclengthControl | None = None
    watch: Watch | None = None

    def __post_init__(self) -> None:
        self._check_numbers()
        if self.watch is not None and (self.watch.journal or self.watch.progress):
            raise ValueError("watch has a journal or progress, which a map has itself; it must have neither")
        self.ready()
        columns = [f"{name} {key}".strip() for name in self.numbers for key in self._keys(name) or ("",)]
        if twice := [column for column in columns if columns.count(column) > 1]:
            raise ValueError(f"numbers gives {twice[0]!r} twice; it must be the name of one")

    def _check_numbers(self) -> None:
        """Raise ValueError for what are no numbers of a branch by their names."""
        named("numbers", self.numbers, "functions of a branch")
        if not self.numbers:
            raise ValueError("numbers is empty; it must name what is read off each branch")
        for name, number in self.numbers.items():
            if isinstance(number, type) or not callable(number):
                raise ValueError(f"number {name} is {number!r}; it must be a function of (task, branch)")
            if hasattr(number, "linearise"):
                raise ValueError(
                    f"number {name} is {number!r}, of an orbit; it must be of a branch, as Highest is"
                )
            if not name.strip() or "/" in name:
                raise ValueError(f"numbers has {name!r}; names must not be empty and have no /")

    @cached_property
    def units(self) -> dict[str, str]:
        """Units of the numbers that say theirs, by the names that they have in the result."""
        return {
            f"{name} {key}".strip(): unit for name in self.numbers for key, unit in self._keys(name).items()
        }

    def _keys(self, name: str) -> Mapping[str, str]:
        """Units of a number by its own keys; none where it does not say them."""
        said = getattr(self.numbers[name], "units", None)
        units: Mapping[str, str] = said(self) if said else {}
        return units

    @cached_property
    def problem(self) -> Problem:
        """The problem that is continued."""
        return Problem(self.system, self.parameter, self.bounds, self.determined or {})

    @property
    def places(self) -> tuple[float, ...]:
        """Values of the parameter at which the numbers need points."""
        return tuple(place for n in self.numbers.values() for place in getattr(n, "places", ()))

    def ready(self, values: Mapping[str, float] | None = None) -> Setup:
        """Return what a cell begins with, everything checked and nothing traced.

        Parameters
        ----------
        values : mapping of str to float, optional
            The cell's parameters (SI).

        Returns
        -------
        Setup
            Problem, method and parameters.

        Raises
        ------
        ValueError
            For what is not allowed.
        """
        return setup(
            *Method.of(self.problem, self.tol, self.method, self.control, self.watch),
            start=self.start,
            at=self.places,
            guess=self.guess,
            values={**(self.values or {}), **(values or {})},
        )

    @cached_property
    def begin(self) -> float:
        """The parameter (SI) at which all branches begin."""
        return self.ready().begin

    def traced(self, values: Mapping[str, float], near: Orbit | None = None) -> Branch:
        """Return the branch of a cell.

        Parameters
        ----------
        values : mapping of str to float
            The cell's parameters (SI).
        near : Orbit, optional
            The first orbit of a neighbour's branch; without it as the task says.

        Returns
        -------
        Branch
            The branch, from the same start as all others.
        """
        return trace(
            self.system,
            self.parameter,
            self.bounds,
            start=self.start if near is None else self.begin,
            at=self.places,
            tol=self.tol,
            guess=self.guess if near is None else near,
            values={**(self.values or {}), **values},
            determined=self.determined,
            method=self.method,
            control=self.control,
            watch=self.watch or Watch(peaks={}),
        )

    def described(self) -> dict[str, Any]:
        """Return a description of all that affects the numbers.

        Returns
        -------
        dict
            Plain data, equal for equal tasks.
        """
        guess = None if self.guess is None else described(self.guess.parameter)
        return {
            "parameter": self.parameter,
            "guess": guess,
            "start": self.begin,
            **made_with(self.ready()),
            "numbers": described(self.numbers),
            "system": identity(self.system),
        }
