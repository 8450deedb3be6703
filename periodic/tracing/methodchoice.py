"""Choice of method: condensed where the system's linear part is given by its modes, else as asked."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import cast

import numpy as np

from periodic.collocation.meshed import MeshMethod
from periodic.collocation.method import Collocation
from periodic.condensed.method import CondensedCollocation
from periodic.condensed.whole.wider import WholeSystem
from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.correction.problem import Problem
from periodic.harmonic.method import HarmonicBalance
from periodic.harmonic.split import SplitHarmonicBalance
from periodic.orbit.scheme import Family
from periodic.system import (
    Condensable,
    Kind,
    System,
    Within,
    jumps_of,
    linear_of,
    resets_of,
    slides_of,
    surfaces_of,
)

SPLIT: tuple[tuple[type[Discretisation], type[Discretisation]], ...] = (
    (Collocation, CondensedCollocation),
    (HarmonicBalance, SplitHarmonicBalance),
)
"""Methods with one for split systems, whose rows are not all of their equations."""


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
    if isinstance(method, tuple(condensed for _, condensed in SPLIT)):
        return method
    found = next((condensed for whole, condensed in SPLIT if isinstance(method, whole)), None)
    if found is None:
        raise ValueError(
            f"method is {type(method).__name__}, which takes all equations of a system; a structure must be "
            f"compiled with condense=False for it"
        )
    _check_events(system)
    scheme = getattr(method, "scheme", None)
    if scheme is not None and scheme.family is not Family.RADAU:
        raise ValueError(f"scheme is {scheme.family.value}; condensation takes Radau IIA")
    chosen = {field.name: getattr(method, field.name) for field in fields(method)}  # type: ignore[arg-type]
    usual = type(method)()
    return found(**{k: value for k, value in chosen.items() if value != getattr(usual, k)})


def _check_events(system: System) -> None:
    """Refuse states that are reset, and jumps of a motion whose sticking is not known. Raises ValueError."""
    if resets_of(system):
        raise ValueError(
            "the states at the places are reset; a structure must be compiled with condense=False for that"
        )
    if any(surface.kind == Kind.RELAY for surface in surfaces_of(system)):
        raise ValueError("the equations at the places have a relay; it must be compiled with condense=False")
    unknown = [k for k in jumps_of(system) if k not in slides_of(system)]
    state, _ = system.rest(system.nominal)
    slopes = system.switch_gradient(state[None], np.zeros(1), system.nominal)[0][0]
    if slopes[unknown].any():
        raise ValueError(
            "the equations at the places jump, and whether motion sticks there is known only of a "
            "structure with all its modes; it must be compiled with condense=False"
        )
