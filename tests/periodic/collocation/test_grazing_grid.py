"""A mass and a stop from soft to all but rigid, at any tolerance, both ways: no orbit, no multiplier wrong.

Each point is held against the exact orbit of its pattern of passages (reference/excursions.py).
"""

from __future__ import annotations

import itertools

import pytest
from support.grids import spread
from support.stops import exactly, judged, stopped

import periodic as per

STIFFNESSES = [2.0, 5.0, 10.0, 20.0, 50.0, 1e2, 1e3, 1e4, 1e6]
TOLERANCES = [1e-3, 1e-6, 1e-9]
WAYS = [(0.3, 0.8), (0.8, 0.3)]
CELLS = list(itertools.product(STIFFNESSES, TOLERANCES, WAYS))
SHORT = [(k, tol, way) for k, tol, way in CELLS if k in (2.0, 1e3, 1e6) and tol != 1e-6]

RESOLVED = 4e-13
"""Rounding of multipliers that no estimate claims to see."""


@pytest.mark.parametrize(("stiffness", "tol", "way"), spread(SHORT, 4))
def test_every_point_is_right(stiffness: float, tol: float, way: tuple[float, float]) -> None:
    """Assert that a branch comes to its bound through grazing, on small meshes, and what it claims."""
    confirmed(stiffness, tol, way)


@pytest.mark.long
@pytest.mark.parametrize(("stiffness", "tol", "way"), [cell for cell in CELLS if cell not in SHORT])
def test_every_point_of_the_grid_is_right(stiffness: float, tol: float, way: tuple[float, float]) -> None:
    """Assert the same of the other cells."""
    confirmed(stiffness, tol, way)


def confirmed(stiffness: float, tol: float, way: tuple[float, float]) -> None:
    """Assert that a branch passes grazing and that its points are as accurate as they claim."""
    branch, system = per.trace(stopped(stiffness), "Omega", way, tol=tol), exactly(stiffness)
    assert branch.stop.reason is per.Reason.BOUND
    grazings = {point.parameter for point in branch.labelled(per.Label.GRAZING)}
    assert len(grazings) == 1
    for point in branch:
        found = judged(system, point)
        assert point.orbit.mesh.ntst <= 200
        assert found.orbit < max(tol, 3 * point.error.orbit) * point.orbit.span()
        if point.parameter not in grazings:  # there multipliers have two values
            assert found.wrong < 1e-13
            assert found.multiplier < max(tol, 3 * point.error.multiplier)
            assert found.multiplier < 10 * max(point.error.multiplier, RESOLVED)
