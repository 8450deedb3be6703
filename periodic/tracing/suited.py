"""The method as it suits a system: condensed where the system's linear part is given by its modes."""

from __future__ import annotations

from dataclasses import fields

from periodic.collocation.method import Collocation
from periodic.condensed.method import CondensedCollocation
from periodic.correction.discretisation import Discretisation
from periodic.harmonic.method import HarmonicBalance
from periodic.harmonic.split import SplitHarmonicBalance
from periodic.orbit.scheme import Family
from periodic.system import System, jumps_of, linear_of, resets_of

SPLIT: dict[type[Discretisation], type[Discretisation]] = {
    Collocation: CondensedCollocation,
    HarmonicBalance: SplitHarmonicBalance,
}
"""Methods with one for split systems, whose rows are not all of their equations."""


def suited(method: Discretisation, system: System) -> Discretisation:
    """Return a method as it suits a system. Raises ValueError where it does not."""
    if linear_of(system) is None or type(method) in SPLIT.values():
        return method
    if type(method) not in SPLIT:
        raise ValueError(
            f"method is {type(method).__name__}, which takes all equations of a system; a structure must be "
            f"compiled with condense=False for it"
        )
    if jumps_of(system) or resets_of(system):
        raise ValueError(
            "the equations at the places jump or are reset; a structure must be compiled with condense=False "
            "for that"
        )
    scheme = getattr(method, "scheme", None)
    if scheme is not None and scheme.family is not Family.RADAU:
        raise ValueError(f"scheme is {scheme.family.value}; condensation takes Radau IIA")
    chosen = {field.name: getattr(method, field.name) for field in fields(method)}  # type: ignore[arg-type]
    usual = type(method)()
    return SPLIT[type(method)](**{k: value for k, value in chosen.items() if value != getattr(usual, k)})
