"""Choice of method: condensed where the system's linear part is given by its modes, else as asked."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

from periodic.collocation.collocation import Collocation
from periodic.collocation.meshmethod import MeshMethod
from periodic.condensed.condensedcollocation import CondensedCollocation
from periodic.condensed.splitmethod import SplitMethod
from periodic.condensed.whole.wider import WholeSystem
from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.correction.problem import Problem
from periodic.harmonic.harmonicbalance import HarmonicBalance
from periodic.harmonic.splitbalance import SplitHarmonicBalance
from periodic.system import Condensable, System, Within, linear_of


def chosen_method(method: Discretisation, problem: Problem) -> tuple[Problem, Discretisation]:
    """Return the problem that is solved and the method for it. Raises ValueError where none fits."""
    system = problem.system
    asked = method.condense if isinstance(method, MeshMethod) else None
    if linear_of(system) is not None:
        if asked is False:
            raise ValueError(
                "condense is False, but the system has its places alone; compile its structures with "
                "condense=False"
            )
        return problem, _split(method, system)
    if not isinstance(method, Collocation) or asked is False:
        return problem, method
    found = _found(system, problem, always=bool(asked))
    if found is None:
        return problem, method
    restricted = replace(problem, system=found, wider=WholeSystem(found))
    return restricted, _split(method, found)


def _found(system: System, problem: Problem, *, always: bool) -> Within | None:
    """The system of the nonlinear places alone, where its linear part is to be condensed."""
    if not hasattr(system, "condensed"):
        if always:
            raise ValueError(
                f"condense is True, but system is a {type(system).__name__} whose linear part is not told; "
                f"symbolic.compile makes one that tells it"
            )
        return None
    found = cast(Condensable, system).condensed(always=always)
    if found is None:
        return None
    names = [output.name for output in found.outputs]
    asked = [name for name in map(_output, problem.conditions) if name is not None and name not in names]
    if asked and always:
        raise ValueError(
            f"condense is True, but a condition is on {asked[0]!r}, which the nonlinear places do not have"
        )
    return None if asked else found


def _output(condition: Condition) -> str | None:
    """The output that a condition is on, if any."""
    return getattr(getattr(condition, "functional", None), "output", None)


def _split(method: Discretisation, system: System) -> Discretisation:
    """The method for a system whose linear part is given by its modes."""
    if isinstance(method, SplitMethod):
        return method
    if isinstance(method, Collocation):
        return CondensedCollocation.like(method, system)
    if isinstance(method, HarmonicBalance):
        return SplitHarmonicBalance.like(method, system)
    raise ValueError(
        f"method is {type(method).__name__}, which takes all equations of a system; a structure must be "
        f"compiled with condense=False for it"
    )
