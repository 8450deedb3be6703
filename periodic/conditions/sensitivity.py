"""How functionals of an orbit change with every parameter, exactly, for the cost of one linear solve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from periodic.checks import named
from periodic.conditions.adjoint import polynomial
from periodic.conditions.functionals import Functional
from periodic.conditions.levels import smooth
from periodic.conditions.variations import equations
from periodic.correction.condition import Condition, side_conditions
from periodic.correction.newton import moved
from periodic.linear.unknowns import Increment
from periodic.orbit.construction import as_read_by
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.orbit.row import Row
from periodic.system import System, index_of
from periodic.system.precision import SMALLEST

FARTHEST_MOVE = 1e-3
"""How far Newton's step may lead from an orbit, in parts of its peak to peak and of what is determined."""


def sensitivities(
    system: System,
    orbit: Orbit,
    functionals: Mapping[str, Functional],
    *,
    determined: Mapping[str, Condition] | None = None,
) -> dict[str, dict[str, float]]:
    """Return the derivatives of functionals in every parameter that is not determined.

    The orbit's equations K(u, p) = 0, u its states and what else is determined (an angular frequency, the
    place of a fold), give

        df/dp = f_p - f_u K_u^-1 K_p.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        An orbit of Collocation or Shooting.
    functionals : mapping of str to Functional
        Functionals with a derivative, by name.
    determined : mapping of str to Condition, optional
        As in `trace`: with {"speed": FoldCondition()} the functional Value("speed") gives the derivatives of
        a fold's speed. Those of a fold whose place is not determined are without bound.

    Returns
    -------
    dict of str to dict of str to float
        df/dp in SI units, by the names of functional and parameter.

    Raises
    ------
    ValueError
        For a functional without derivative, an orbit that is a Fourier series, and one that does not fulfil
        its equations or what is determined.
    """
    named("functionals", functionals, "functionals")
    found = Changes.of(system, orbit, determined)
    return {label: found.rates(functional) for label, functional in functionals.items()}


@dataclass(frozen=True)
class Changes:
    """How an orbit changes with each parameter that is not determined, its equations still met.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        The orbit, in the system's scales.
    free : tuple of int
        Indices of all parameters, those that are determined first.
    ways : mapping of str to Increment
        The orbit's change per SI unit of a parameter, by its name.
    """

    system: System
    orbit: Orbit
    free: tuple[int, ...]
    ways: Mapping[str, Increment]

    @classmethod
    def of(cls, system: System, orbit: Orbit, determined: Mapping[str, Condition] | None = None) -> Self:
        """Return the changes of an orbit; arguments and refusals are those of `sensitivities`."""
        named("determined", determined or {}, "conditions")
        orbit = as_read_by(system, orbit)
        polynomial(orbit)
        names = [p.name for p in system.parameters]
        own = tuple(index_of(system, name) for name in determined or {})
        others = tuple(k for k in range(len(names)) if k not in own)
        free, first = (*own, *others), len(orbit.phases) + len(own)
        closing = side_conditions(list((determined or {}).values()), own, orbit)
        rows = [condition.linearise(system, orbit, free) for condition in closing]
        rows += [_held(orbit, first + i, len(free)) for i in range(len(others))]
        right = np.zeros((1 + len(rows), 1 + len(others)))
        right[0, 0] = 1.0
        right[1 + len(own) :, 1:] = np.eye(len(others))
        step, *ways = equations(system, orbit, free).solve(rows, right)
        _check_met(orbit, step, [names[k] for k in own])
        return cls(system, orbit, free, {names[k]: way for k, way in zip(others, ways, strict=True)})

    def rates(self, functional: Functional) -> dict[str, float]:
        """Return the derivatives of a functional in each parameter, SI. Raises ValueError if it has none."""
        slope = smooth(functional).linearise(self.system, self.orbit, self.free)
        return {name: way.rate_of(slope) for name, way in self.ways.items()}

    def predicted(self, values: Mapping[str, float]) -> Orbit:
        """Return the orbit moved along its changes to other parameters (SI), to first order in them."""
        found = self.orbit
        for name, value in values.items():
            step = value - float(self.orbit.parameter[index_of(self.system, name)])
            found = moved(self.system, self.free, found, self.ways[name], step)
        return found


def _check_met(orbit: Orbit, step: Increment, determined: Sequence[str]) -> None:
    """Refuse an orbit that Newton's step still moves: it fulfils its equations or conditions elsewhere."""
    for name, change in zip(determined, step.parameters, strict=False):
        value = orbit.parameters[name]
        if not abs(change) <= FARTHEST_MOVE * max(abs(value), SMALLEST):
            raise ValueError(
                f"{name} of the orbit is {value:.6g}, where its condition is not met; the orbit must be one "
                f"that trace found with it (a labelled point, or determined={{{name!r}: ...}})"
            )
    apart = float(np.abs(step.profile).max()) / max(orbit.span(), LEAST_SPAN)
    if not apart <= FARTHEST_MOVE:
        raise ValueError(
            f"orbit is {apart:.1e} peaks to peak from the one at its parameters; it must be one that trace "
            f"found there"
        )


def _held(orbit: Orbit, index: int, free: int) -> Row:
    """The row of one of the free numbers."""
    outer = np.zeros(len(orbit.phases) + free)
    outer[index] = 1.0
    return Row(0.0, np.zeros_like(orbit.nodes), outer)
