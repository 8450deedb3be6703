"""Impacts where inertia couples the coordinates: what a branch claims of its multipliers, point by point.

Two coordinates with a full mass matrix, one before a rigid wall. Beside grazing a multiplier of 5000
goes with the inverse of the impact's speed: rounding of the model's matrices alone would be 1e-4 in it,
as is that of an orbit followed in doubles. So these are such that M^-1 K, M^-1 C and M^-1 e have none.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import ArrayLike
from reference.closer import closer
from reference.contact import Contact, Period, Wall, periodic
from reference.judging import quiet
from support.kept import kept

import periodic as per
import symbolic as sym
from periodic import Label

GAP, RESTITUTION = 4.0, 0.75
MASS, INVERSE = np.array([[2.0, 1.0], [1.0, 1.0]]), np.array([[1.0, -1.0], [-1.0, 2.0]])
STIFFNESS = np.array([[3.0, -1.0], [-1.0, 2.0]])
DAMPING = STIFFNESS / 32


@kept
def branch() -> per.Branch:
    """From beyond the resonance down to grazing, and with one to three impacts, beside two more grazings."""
    structure = sym.Structure(MASS, DAMPING, STIFFNESS, at={"a": 0, "b": 1})
    struck = structure["b"]
    model = structure + sym.RigidStop(struck, GAP, RESTITUTION) + sym.HarmonicForce(struck, 1.0, 1.0)
    system = sym.compile(model, condense=False)
    control = per.ArclengthControl(max_points=45)
    return per.trace(system, "Omega", (0.75, 0.87), start=0.87, tol=1e-6, control=control)


def exact(point: per.Point) -> Period:
    """The orbit at the point's parameter in closed form, in extended precision."""
    still, unit = np.zeros((2, 2)), INVERSE[:, 1]
    matrix = np.block([[still, np.eye(2)], [-INVERSE @ STIFFNESS, -INVERSE @ DAMPING]])
    reset = np.eye(7)
    reset[2:4, 3] -= (1 + RESTITUTION) * unit / unit[1]
    wall = Wall(np.array([0.0, -1.0, 0.0, 0.0, GAP, 0.0, 0.0]), reset)
    system = Contact(matrix, np.zeros(4), np.concatenate([[0.0, 0.0], unit]), [wall])
    tau, begin = quiet(system, point.orbit, point.parameter, ["a", "b"])
    return closer(system, point.parameter, periodic(system, point.parameter, begin, tau), tau)


def apart(one: ArrayLike, two: ArrayLike) -> float:
    """Distance of multipliers as errors are told: in their sums and those of squares, over the largest."""
    size = max(1.0, float(np.abs(two).max()))
    powers = [(np.asarray(one) / size) ** k for k in (1, 2)], [(np.asarray(two) / size) ** k for k in (1, 2)]
    return float(max(abs(a.sum() - b.sum()) / k for k, a, b in zip((1, 2), *powers, strict=True)))


def beyond_doubt() -> list[per.Point]:
    """Points with impacts, but at grazing points, where multipliers have two values, and at folds.

    Beside a fold they are those of the orbit of the same parameter: 2e-7 from one that is 40 times as much as
    they are off on the branch itself.
    """
    grazings = {point.parameter for point in branch().labelled(Label.GRAZING)}
    folds = {point.parameter for point in branch().labelled(Label.FOLD)}
    return [p for p in branch() if len(p.orbit.phases) and p.parameter not in grazings | folds]


def test_multipliers_are_off_by_what_is_claimed() -> None:
    """Assert orbits and multipliers of all points, beside grazing too: errors are told to a fifth."""
    points = beyond_doubt()
    assert len(points) > 20
    assert max(np.abs(point.multipliers).max() for point in points) > 4000
    for point in points:
        found = exact(point)
        assert apart(point.multipliers, found.multipliers) < max(1.2 * point.error.multiplier, 1e-9)


def test_grazing_and_patterns() -> None:
    """Assert that there are up to three impacts; the first grazing is that of the linear orbit, |b| = gap."""
    assert {len(point.orbit.phases) for point in branch()} == {0, 1, 2, 3}
    first = branch().labelled(Label.GRAZING)[0].parameter
    dynamic = STIFFNESS + 1j * first * DAMPING - first**2 * MASS
    assert abs(np.linalg.solve(dynamic, [0.0, 1.0])[1]) == pytest.approx(GAP, rel=1e-8)
