"""A gear pair with backlash, varying stiffness and transmission error, against shooting with DOP853."""

from __future__ import annotations

import math

import numpy as np
import pytest
from reference.returning import Rates, Shot, shot
from support.kept import kept

import periodic as per
import symbolic as sym

FOLDS = (0.598153117, 0.835837679)
"""Known frequencies of folds (event-exact shooting of another author)."""

PLACES = (1.1, 0.9, 0.7, 0.62, 0.5)


@kept
def branch() -> per.Branch:
    """The branch from 1.2 down to 0.4."""
    return per.trace(sym.scene("gear-pair"), "Omega", (0.4, 1.2), start=1.2, at=PLACES)


def rates(w: float) -> Rates:
    """w^2 x'' = F_m + sum F_j (j w)^2 cos j tau - 2 zeta w x' - K B(x), as y' of (x, x')."""

    def found(tau: float, y: np.ndarray) -> list[float]:
        x, v = y
        waves = [math.cos(j * tau) for j in (1, 2, 3)]
        stiffness = 1 - np.dot((0.2, 0.1, 0.05), waves)
        play = max(x - 1, 0.0) + min(x + 1, 0.0)
        force = 0.1 + w**2 * np.dot((0.01, 0.016, 0.018), waves) - 0.1 * w * v - stiffness * play
        return [v, force / w**2]

    return found


def confirmed(point: per.Point) -> Shot:
    """The orbit of a point by shooting, begun a little beside it; tight, for its differences cross kinks."""
    beside = point.orbit.state(np.zeros(1))[0] * (1 + 1e-6)
    return shot(rates(point.parameter), beside, (1.0, 1.0), rtol=1e-13)


def test_folds() -> None:
    """Assert the known folds to nine digits, and that the branch gets to its end."""
    assert branch().stop.reason is per.Reason.BOUND
    found = [p.parameter for p in branch().labelled(per.Label.FOLD)]
    assert found[:2] == pytest.approx(FOLDS, abs=2e-9)


@pytest.mark.parametrize("place", PLACES)
def test_orbits(place: float) -> None:
    """Assert orbits and multipliers of every sheet at five frequencies by shooting, to 1e-7 and 1e-5."""
    points = [p for p in branch().labelled(per.Label.USER) if p.parameter == place]
    assert points
    for point in points:
        own = confirmed(point)
        assert point.orbit.state(np.zeros(1))[0] == pytest.approx(own.start, abs=1e-7)
        assert point.peak_to_peak("x") == pytest.approx(own.peak_to_peak(0), rel=1e-6)
        assert abs(point.multipliers[0]) == pytest.approx(abs(own.multipliers[0]), rel=1e-5)


def test_liouville() -> None:
    """Assert that the multipliers of every orbit have the product exp(-4 pi zeta/w), to 1e-7."""
    for point in branch():
        exact = math.exp(-4 * math.pi * 0.05 / point.parameter)
        assert np.prod(point.multipliers).real == pytest.approx(exact, rel=1e-7)


def test_rest_is_where_the_mesh_carries_the_load() -> None:
    """Assert where the search for a rest begins: in mesh, on the side of the load."""
    system = sym.scene("gear-pair")
    assert system.rest(system.nominal)[0] == pytest.approx([1.1, 0.0], abs=1e-15)
