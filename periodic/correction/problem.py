"""Problems: a system, its free parameters, and the conditions that determine all of them but one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from periodic.checks import named, number, shown
from periodic.correction.condition import Condition, SideCondition, side_conditions
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System, check_system, index_of
from periodic.system.precision import EXTREME


class Wider(Protocol):
    """A system whose orbits are given by those of the system that is solved."""

    @property
    def system(self) -> System:
        """The wider system."""

    def expanded(self, orbit: Orbit) -> Orbit:
        """Return an orbit of the system that is solved as one of the wider system.

        Parameters
        ----------
        orbit : Orbit
            The orbit.

        Returns
        -------
        Orbit
            The same with all states.
        """

    def restricted(self, orbit: Orbit) -> Orbit:
        """Return an orbit of the wider system as one of the system that is solved.

        Parameters
        ----------
        orbit : Orbit
            The orbit.

        Returns
        -------
        Orbit
            The same with fewer states.
        """


@dataclass(frozen=True)
class Problem:
    """A branch of periodic orbits, apart from the method that finds them.

    Parameters
    ----------
    system : System
        The equations R(x', x, z, tau, p) = 0.
    parameter : str
        Name of the parameter that the branch is continued in.
    bounds : tuple of float
        Its range (SI), the first where branches begin by default. The distance of the two is the unit of
        arclength in the parameter.
    determined : mapping of str to Condition, optional
        Further free parameters by name, and the conditions that determine them: {"omega": PhaseCondition()}
        of an autonomous system, {"F": FoldCondition()} for a curve of folds in two parameters.
    wider : Wider, optional
        The system that results are of, where another one is solved in its place.
    sizes : tuple of float, optional
        Sizes of the further free parameters (SI), used for those that are 0 in the system.

    Raises
    ------
    ValueError
        For names that are no parameters of the system, bounds that are no range, and a wrong condition.
    """

    system: System = field(repr=False)
    parameter: str
    bounds: tuple[float, float]
    determined: Mapping[str, Condition] = field(default_factory=dict)
    wider: Wider | None = field(default=None, repr=False)
    sizes: tuple[float, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        check_system(self.system)
        index_of(self.system, self.parameter)
        object.__setattr__(self, "bounds", _range(self.parameter, self.bounds))
        named("determined", self.determined, "conditions")
        for name, condition in self.determined.items():
            if isinstance(condition, type) or not hasattr(condition, "at"):
                raise ValueError(
                    f"determined has {condition!r} for {name}; it must be a condition, as FoldCondition() is"
                )
            if name == self.parameter:
                raise ValueError(
                    f"determined has {name!r}, which is also the parameter continued in; "
                    f"it must be one or the other"
                )
            index_of(self.system, name)

    @property
    def begin(self) -> float:
        """The bound where branches begin by default."""
        return self.bounds[0]

    @cached_property
    def low(self) -> float:
        """The lower bound."""
        return min(self.bounds)

    @cached_property
    def high(self) -> float:
        """The upper bound."""
        return max(self.bounds)

    @cached_property
    def index(self) -> int:
        """Index of the continuation parameter."""
        return index_of(self.system, self.parameter)

    @cached_property
    def others(self) -> tuple[int, ...]:
        """Indices of the further free parameters."""
        return tuple(index_of(self.system, name) for name in self.determined)

    @cached_property
    def conditions(self) -> tuple[Condition, ...]:
        """The conditions that determine the further free parameters, one for each."""
        return tuple(self.determined.values())

    @cached_property
    def free(self) -> tuple[int, ...]:
        """Indices of all free parameters, the continuation parameter first."""
        return (self.index, *self.others)

    @cached_property
    def scale(self) -> float:
        """The unit of arclength in the continuation parameter."""
        return self.high - self.low

    def units(self, orbit: Orbit) -> float | Array:
        """Return the units of arclength in the free parameters: the range, and of others their own size.

        Parameters
        ----------
        orbit : Orbit
            The orbit that lengths are measured from.

        Returns
        -------
        float or ndarray, shape (q,)
            In SI units; the range alone of a branch in one parameter. Infinite for parameters that an
            intrinsic condition determines, and for those that are 0 in the system and where the curve begins,
            which have no size.
        """
        if all(condition.intrinsic for condition in self.conditions):
            return self.scale
        units = np.array([self.scale, *(np.inf for _ in self.others)])
        for k, (index, condition) in enumerate(zip(self.others, self.conditions, strict=True), start=1):
            size = abs(float(self.system.nominal[index])) or (self.sizes[k - 1] if self.sizes else 0.0)
            if size > 0 and not condition.intrinsic:
                units[k] = max(size, abs(float(orbit.parameter[index])))
        return units

    def begun_at(self, parameter: Array) -> Problem:
        """Return the problem with the sizes that further free parameters have at the beginning.

        Parameters
        ----------
        parameter : ndarray, shape (p,)
            Parameters in SI units.

        Returns
        -------
        Problem
            The problem.
        """
        return replace(self, sizes=tuple(abs(float(parameter[k])) for k in self.others))

    @cached_property
    def trivial(self) -> int:
        """How many multipliers of the orbits are 1 whatever the parameters."""
        return max((condition.trivial for condition in self.conditions), default=0)

    @property
    def autonomous(self) -> bool:
        """Whether the orbits have a multiplier that is 1 whatever the parameters."""
        return self.trivial > 0

    def side_conditions(self, origin: Orbit) -> list[SideCondition]:
        """Return the side conditions of orbits near `origin`.

        Parameters
        ----------
        origin : Orbit
            An orbit on the same mesh.

        Returns
        -------
        list of SideCondition
            One for each of `determined`.
        """
        return side_conditions(self.conditions, self.others, origin)

    @property
    def full(self) -> System:
        """The full system: the one that results are of."""
        return self.system if self.wider is None else self.wider.system

    def expand(self, orbit: Orbit) -> Orbit:
        """Expand an orbit of the system that is solved to one of the full system.

        Parameters
        ----------
        orbit : Orbit
            An orbit of the system that is solved.

        Returns
        -------
        Orbit
            The orbit with all states.
        """
        return orbit if self.wider is None else self.wider.expanded(orbit)

    def restrict(self, orbit: Orbit) -> Orbit:
        """Restrict an orbit of the full system to one of the system that is solved.

        Parameters
        ----------
        orbit : Orbit
            The orbit with all states.

        Returns
        -------
        Orbit
            An orbit of the system that is solved.
        """
        return orbit if self.wider is None else self.wider.restricted(orbit)

    def value(self, orbit: Orbit) -> float:
        """Return the continuation parameter of an orbit.

        Parameters
        ----------
        orbit : Orbit
            The orbit.

        Returns
        -------
        float
            The parameter in SI units.
        """
        return float(orbit.parameter[self.index])


def _range(parameter: str, bounds: tuple[float, float]) -> tuple[float, float]:
    given = shown(bounds) if not isinstance(bounds, str) else bounds
    try:
        first, second = (number("bound", end) for end in bounds)
    except (TypeError, ValueError):
        first = second = np.nan
    if not (np.isfinite(first) and np.isfinite(second) and first != second):
        raise ValueError(f"bounds of {parameter} are {given}; they must be two different finite numbers")
    for size in (abs(first), abs(second), abs(first - second)):
        if size != 0 and not 1 / EXTREME <= size <= EXTREME:
            allowed = f"each 0 or of a magnitude from {1 / EXTREME:g} to {EXTREME:g}, and so their difference"
            raise ValueError(f"bounds of {parameter} are {given}; they must be {allowed}")
    return first, second
