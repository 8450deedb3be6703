"""The way in to equilibria: trace a branch of them between two values of a parameter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from periodic.checks import number
from periodic.correction.condition import Condition
from periodic.correction.tolerance import Accuracy, Tolerance
from periodic.equilibrium.method import Equilibrium
from periodic.orbit.construction import constant
from periodic.orbit.layout import layout_of
from periodic.orbit.mesh import uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Scheme
from periodic.results.branch import Branch
from periodic.system import System, VariableLike, check_system
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.trace import trace
from periodic.tracing.watch import Watch


def equilibria(
    system: System,
    parameter: str,
    bounds: tuple[float, float],
    *,
    start: float | None = None,
    at: float | Sequence[float] = (),
    tol: float | Tolerance = Accuracy.STANDARD,
    guess: Orbit | Branch | Mapping[str, float] | None = None,
    values: Mapping[str, float] | None = None,
    determined: Mapping[str, Condition] | None = None,
    method: Equilibrium | None = None,
    control: ArclengthControl | None = None,
    watch: Watch | None = None,
) -> Branch:
    """Trace the branch of equilibria 0 = R(0, x, z, p) through `start` within `bounds`.

    Points are labelled LP, HB (Hopf) and BP; multipliers are the eigenvalues of small motion in 1/s.

    Parameters
    ----------
    system, parameter, bounds, start, at, tol
        As in `trace`.
    guess : Orbit, Branch or mapping of str to float, optional
        As in `trace`, or states (SI) and unknowns by name, the others being at rest.
    values, determined
        As in `trace`.
    method : Equilibrium, optional
        Names the parameter omega with d/dt = omega d/dtau, for the eigenvalues: default "omega".
    control, watch
        As in `trace`.

    Returns
    -------
    Branch
        The points in order, and why the branch ends.

    Raises
    ------
    ValueError
        As `trace` does, and for a system that is excited.
    """
    check_system(system)
    method = method or Equilibrium()
    if not isinstance(method, Equilibrium):
        raise ValueError(f"method is {method!r}; it must be Equilibrium(frequency=...)")
    names = [p.name for p in system.parameters]
    if method.frequency not in names:
        raise ValueError(
            f"frequency is {method.frequency!r}; it must be one of the parameters {', '.join(names)}"
        )
    if method.frequency == parameter:
        raise ValueError(f"parameter is {parameter!r}, the frequency; equilibria do not depend on it")
    if isinstance(guess, Mapping):
        guess, start = _named(system, guess), bounds[0] if start is None else start
    return trace(
        system,
        parameter,
        bounds,
        start=start,
        at=at,
        tol=tol,
        guess=guess,
        values=values,
        determined=determined,
        method=method,
        control=control,
        watch=watch,
    )


def _named(system: System, values: Mapping[str, float]) -> Orbit:
    """The equilibrium guess with some states (SI) and unknowns given by name, the others at rest."""
    parameter = np.array(system.nominal, dtype=float)
    rest = np.concatenate(system.rest(parameter))
    variables: list[VariableLike] = [*system.states, *system.algebraics]
    names = [variable.name for variable in variables]
    for name, value in values.items():
        if name not in names:
            raise ValueError(f"guess has {name!r}; it must be one of {', '.join(names)}")
        if not np.isfinite(number(f"guess of {name}", value)):
            raise ValueError(f"guess of {name} is {value}; it must be a finite number")
        rest[names.index(name)] = value / variables[names.index(name)].scale
    n = len(system.states)
    return constant(uniform(Scheme(), 1), rest[:n], rest[n:], parameter, layout_of(system))
