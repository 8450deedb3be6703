"""A response: the branch over one parameter that decisions are about, and quantities read off it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Any

from periodic.checks import named, number, shown, whole
from periodic.conditions.functionals import Functional, output_index
from periodic.conditions.levels import smooth
from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.correction.tolerance import Accuracy, Tolerance
from periodic.decisions.responses.feature import Count, Way
from periodic.decisions.responses.quantity import AtValue, Extreme, SpecialPoint
from periodic.orbit.orbit import Orbit
from periodic.results.branch import Branch
from periodic.system import System
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.trace import trace
from periodic.tracing.watch import Watch


@dataclass(frozen=True, eq=False)
class Response:
    """The branch of a system over one parameter, traced wherever a decision needs it.

    Parameters
    ----------
    parameter : str
        Name of the parameter that is continued in, as the excitation's frequency.
    bounds : tuple of float
        Its range (SI); the first is where the branch starts by default.
    values : mapping of str to float, optional
        Other parameters (SI) by name, such as the force of a test, but none that are free.
    start, tol, guess, determined, method, control
        As in `trace`.

    Raises
    ------
    ValueError
        For bounds that are no two numbers and values that are no numbers by name.
    """

    parameter: str
    bounds: tuple[float, float]
    _: KW_ONLY
    values: Mapping[str, float] = field(default_factory=dict)
    start: float | None = None
    tol: float | Tolerance = Accuracy.STANDARD
    guess: Orbit | None = None
    determined: Mapping[str, Condition] = field(default_factory=dict)
    method: Discretisation | None = None
    control: ArclengthControl | None = None

    def __post_init__(self) -> None:
        given: Any = self.bounds
        if not (isinstance(given, Sequence) and len(given) == 2):
            raise ValueError(f"bounds of {self.parameter} are {shown(given)}; they must be two numbers")
        for name, value in named("values", self.values, "numbers").items():
            number(f"value of {name}", value)

    def highest(self, functional: Functional, *, stable: bool = False) -> Extreme:
        """Return the highest value of a functional along the branch: over all of its peaks and both ends.

        Parameters
        ----------
        functional : Functional
            As PeakToPeak("x"); it must have a derivative.
        stable : bool
            Whether only stable motions count, and the ends of their ranges.

        Returns
        -------
        Extreme
            The quantity.
        """
        return Extreme(self, smooth(functional), 1.0, stable)

    def lowest(self, functional: Functional, *, stable: bool = False) -> Extreme:
        """Return the lowest value of a functional along the branch.

        Parameters
        ----------
        functional : Functional
            As Minimum("load"); it must have a derivative.
        stable : bool
            Whether only stable motions count, and the ends of their ranges.

        Returns
        -------
        Extreme
            The quantity.
        """
        return Extreme(self, smooth(functional), -1.0, stable)

    def place(self, label: str, functional: Functional | None = None, *, which: int = 0) -> SpecialPoint:
        """Return where the branch has a special point: its parameter, or a functional there.

        Parameters
        ----------
        label : str
            "LP" for folds, "PD", "NS", "GR".
        functional : Functional, optional
            What is read there; by default the branch's parameter.
        which : int
            Which of the points with this label, counted from 0 along the branch.

        Returns
        -------
        SpecialPoint
            The quantity.
        """
        return SpecialPoint(
            self, str(label), whole("which", which, 0), None if functional is None else smooth(functional)
        )

    def at(self, value: float, functional: Functional, *, sheet: int = 0) -> AtValue:
        """Return a functional of a motion at a value of the parameter.

        Parameters
        ----------
        value : float
            The parameter (SI), within the bounds.
        functional : Functional
            What is read there; it must have a derivative.
        sheet : int
            Which of the motions there, counted from 0 along the branch.

        Returns
        -------
        AtValue
            The quantity.
        """
        low, high = sorted(self.bounds)
        if not low <= number("value", value) <= high:
            raise ValueError(f"value is {value:g}; it must lie within the bounds {low:g} to {high:g}")
        return AtValue(self, float(value), smooth(functional), whole("sheet", sheet, 0))

    def way(self, system: System, count: Count) -> Way:
        """Return how its orbits are found.

        Parameters
        ----------
        system : System
            The equations.
        count : Count
            Counts the orbits.

        Returns
        -------
        Way
            What features are followed with.
        """
        return Way(system=system, determined=self.determined, tol=self.tol, method=self.method, count=count)

    def traced(
        self,
        system: System,
        values: Mapping[str, float],
        peaks: Mapping[str, Functional] | None = None,
        at: Sequence[float] = (),
    ) -> Branch:
        """Return the branch at given values of further parameters (SI).

        Parameters
        ----------
        system : System
            The equations.
        values : mapping of str to float
            Parameters by name, besides those of the response.
        peaks : mapping of str to Functional, optional
            Functionals whose stationary places get points, by name.
        at : sequence of float
            Values of the parameter that get points.

        Returns
        -------
        Branch
            The branch.

        Raises
        ------
        ValueError
            Where a parameter is both free and given, and for what `trace` refuses.
        """
        for functional in (peaks or {}).values():
            if isinstance(output := getattr(functional, "output", None), str):
                output_index(system, output)
        for name in set(values) & {*self.values, self.parameter}:
            raise ValueError(f"{name} is free, and also given by the response; it must be one or the other")
        return trace(
            system,
            self.parameter,
            self.bounds,
            start=self.start,
            tol=self.tol,
            guess=self.guess,
            values={**self.values, **values},
            determined=self.determined,
            method=self.method,
            control=self.control,
            at=at,
            watch=Watch(peaks=peaks or {}),
        )
