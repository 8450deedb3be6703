"""Remarks on a curve of special points in two parameters: sentences for whoever reads it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from periodic.bifurcations.label import Label
from periodic.orbit.orbit import Orbit
from periodic.stability.multipliers import Complex

ON_CURVE = 1e-6
"""Error up to which, on a curve that holds it, a product of two multipliers is 1, a sum of eigenvalues 0."""

CONDENSED = ("CondensedCollocation", "SplitHarmonicBalance")


class Point(Protocol):
    """A point of a branch, as `periodic.results.point` has it."""

    @property
    def orbit(self) -> Orbit: ...
    @property
    def parameter(self) -> float: ...
    @property
    def label(self) -> Label: ...
    @property
    def multipliers(self) -> Complex: ...
    @property
    def trivial(self) -> float | None: ...
    @property
    def equilibrium(self) -> bool: ...


def noted(points: Sequence[Point], made: Mapping[str, Any], parameter: str) -> Iterator[str]:
    """Yield the remarks on a curve in two parameters; a branch in one parameter has none.

    Parameters
    ----------
    points : sequence of Point
        The curve.
    made : mapping
        What it is made with, as plain data.
    parameter : str
        The parameter along it.
    """
    held = {condition.get("is") for condition in made.get("determined", {}).values()}
    for condition, what in (("TorusCondition", "tori (NS)"), ("HopfCondition", "Hopf points (HB)")):
        if condition in held:
            yield _neutral(points, what, parameter)
    if "DoublingCondition" in held:
        yield _flips(points, made)


def _neutral(points: Sequence[Point], what: str, parameter: str) -> str:
    """Say which points hold two real multipliers whose product is 1, or real eigenvalues whose sum is 0."""
    found = [p.parameter for p in points if not _corner(p) and _real(_own(p), p.equilibrium)]
    if not found:
        return ""
    return (
        f"{len(found)} of {len(points)} points are neutral saddles, no {what}: the pair that is held is real "
        f"there, {parameter} = {min(found):.6g} to {max(found):.6g}"
    )


def _corner(point: Point) -> bool:
    """Whether the critical pair becomes real at a point."""
    return point.label in (Label.RESONANCE_1, Label.RESONANCE_2, Label.BOGDANOV_TAKENS)


def _own(point: Point) -> Complex:
    """The multipliers without the one that an autonomous orbit has at 1."""
    found = point.multipliers
    return found if point.trivial is None else np.delete(found, np.abs(found - 1).argmin())


def _real(found: Complex, equilibrium: bool) -> bool:
    first, second = np.triu_indices(len(found), 1)
    a, b = found[first], found[second]
    off = np.abs(a + b) / (np.abs(a) + np.abs(b)) if equilibrium else np.abs(a * b - 1)
    if not len(off):
        return False
    k = int(off.argmin())
    return bool(off[k] < ON_CURVE and a[k].imag == 0)


def _flips(points: Sequence[Point], made: Mapping[str, Any]) -> str:
    """Say for which orbits the cubic coefficient of the doubling is not computed."""
    kinked = sum(len(p.orbit.phases) > 0 for p in points)
    if made.get("method", {}).get("is") in CONDENSED:
        where = "of a condensed system"
    elif any(p.trivial is not None for p in points):
        where = "of an autonomous system"
    elif kinked:
        where = f"with kinks, {kinked} of {len(points)} points"
    else:
        return ""
    return f"generalised period doublings (GPD) are not looked for on orbits {where}"
