"""Branches that begin at grazing or a hair beside it; a fold so near to grazing that no step is as short."""

from __future__ import annotations

import numpy as np
import pytest
from support.stops import exactly, judged, stopped

import periodic as per
import symbolic as sym

FORCE, DAMPING = 0.5, 0.1
GRAZING = float(np.sqrt(np.roots([1.0, DAMPING**2 - 2.0, 1.0 - FORCE**2]).min()))
"""Where the free amplitude is the gap."""


@pytest.mark.parametrize("way", [0.05, -0.05], ids=["up", "down"])
@pytest.mark.parametrize("aside", [0.0, 1e-9, -1e-9])
def test_first_orbit_beside_grazing(aside: float, way: float) -> None:
    """Assert that a branch from there comes to its bound, through grazing where that is ahead."""
    begin, system = GRAZING + aside, exactly(1e2)
    branch = per.trace(stopped(1e2), "Omega", (begin, begin + way), tol=1e-9)
    assert branch.stop.reason is per.Reason.BOUND
    grazings = [point.parameter for point in branch.labelled(per.Label.GRAZING)]
    assert len(grazings) == (1 if aside * way < 0 or (aside == 0 and way > 0) else 0)
    for point in branch:
        if abs(point.parameter - GRAZING) > 1e-10:  # there multipliers have two values
            found = judged(system, point)
            assert found.wrong < 1e-13
            assert found.multiplier < max(1e-9, 3 * point.error.multiplier)


def test_fold_beside_grazing() -> None:
    """Assert that a stop that is met from above its resonance is passed, with the fold at grazing.

    There the amplitude that just reaches the gap is known; the fold lies so near that it has no other place.
    """
    q = sym.coordinate("q")
    model = sym.Mass(q, 1.0) + sym.Damper(q, 0.02) + sym.Spring(q, 1.0) + sym.HarmonicForce(q, 0.1)
    system = sym.compile(model + sym.Stop(q, sym.HertzLaw(1e4, 1.0), gap=1.0))
    branch = per.trace(system, "Omega", (1.3, 1.0), tol=1e-6)
    (grazing,) = branch.labelled(per.Label.GRAZING)
    assert 0.1 / abs(1 - grazing.parameter**2 + 0.02j * grazing.parameter) == pytest.approx(1.0, abs=1e-7)
    assert branch.stop.reason is per.Reason.BOUND
    fold = min(branch.labelled(per.Label.FOLD), key=lambda point: abs(point.parameter - grazing.parameter))
    assert fold.parameter == pytest.approx(grazing.parameter, abs=1e-5)
    assert fold.parameter <= grazing.parameter
