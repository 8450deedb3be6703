"""The way in to equilibria: trace a branch of them between two values of a parameter."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from periodic.branch import Branch
from periodic.conditions import Level
from periodic.functionals import Functional
from periodic.mesh import uniform
from periodic.methods.equilibrium import Equilibrium
from periodic.orbit import Orbit, constant
from periodic.point import Point
from periodic.scheme import Scheme
from periodic.settings import Accuracy, Settings
from periodic.system import System, VariableLike
from periodic.tracing import trace


def equilibria(
    system: System,
    parameter: str,
    bounds: tuple[float, float],
    *,
    start: float | None = None,
    at: float | Sequence[float] = (),
    accuracy: Accuracy = Accuracy.STANDARD,
    settings: Settings | None = None,
    values: Mapping[str, float] | None = None,
    guess: Orbit | Mapping[str, float] | None = None,
    frequency: str = "omega",
    columns: Mapping[str, Functional] | None = None,
    events: Mapping[str, Level] | None = None,
    stop: Mapping[str, int] | None = None,
    resume: Branch | None = None,
    progress: Callable[[Point], None] | None = None,
) -> Branch:
    """Trace the branch of equilibria 0 = R(0, x, z, p) through `start` within `bounds`.

    Arguments as in `trace`; `guess` may also give states (SI) and unknowns by name, the others being at
    rest. `frequency` names the parameter omega with d/dt = omega d/dtau, for the eigenvalues in 1/s. Points
    are labelled LP, HB (Hopf) and BP. Raises ValueError as `trace` does, and for a system that is excited.
    """
    names = [p.name for p in system.parameters]
    if frequency not in names:
        raise ValueError(f"frequency is {frequency!r}; it must be one of the parameters {', '.join(names)}")
    if frequency == parameter:
        raise ValueError(f"parameter is {parameter!r}, the frequency; equilibria do not depend on it")
    if isinstance(guess, Mapping):
        guess, start = _named(system, guess), bounds[0] if start is None else start
    return trace(
        system,
        parameter,
        bounds,
        start=start,
        at=at,
        accuracy=accuracy,
        settings=settings,
        method=Equilibrium(names.index(frequency)),
        values=values,
        guess=guess,
        columns=columns,
        events=events,
        stop=stop,
        resume=resume,
        progress=progress,
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
        if not np.isfinite(value):
            raise ValueError(f"guess of {name} is {value}; it must be a finite number")
        rest[names.index(name)] = value / variables[names.index(name)].scale
    n = len(system.states)
    return constant(uniform(Scheme(), 1), rest[:n], rest[n:], parameter)
