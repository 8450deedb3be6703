"""Branches that begin at grazing or a hair beside it; a fold so near to grazing that no step is as short."""

from __future__ import annotations

from typing import Any

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


@pytest.mark.parametrize(("stiffness", "beyond"), [(1e2, 2.326e-6), (3e2, 2.576e-7)])
def test_doubling_beyond_grazing(stiffness: float, beyond: float) -> None:
    """Assert a PD at its own place, alike from both sides, where the closed form has a multiplier of -1.

    Behind the stop multipliers change fast, but do not jump: it is not at the grazing. The depth at which
    they have changed as much is as stiffness^-2.
    """
    places = []
    for way in ((0.6, 0.9), (0.9, 0.6)):
        branch = per.trace(stopped(stiffness), "Omega", way, tol=1e-6)
        (doubling,) = branch.labelled(per.Label.DOUBLING)
        assert abs(doubling.multipliers + 1).min() < 1e-6
        assert judged(exactly(stiffness), doubling).multiplier < 1e-6
        places.append(doubling.parameter)
    assert places[0] == pytest.approx(places[1], abs=1e-10)
    assert places[0] - GRAZING == pytest.approx(beyond, rel=1e-3)


@pytest.mark.parametrize("stiffness", [1e3, 1e4, 1e6])
def test_doubling_that_is_not_told_from_grazing(stiffness: float) -> None:
    """Assert that its error says how far from the grazing it may lie: by stiffness^-2, as measured above."""
    for way in ((0.6, 0.9), (0.9, 0.6)):
        branch = per.trace(stopped(stiffness), "Omega", way, tol=1e-6)
        (doubling,) = branch.labelled(per.Label.DOUBLING)
        (grazing,) = branch.labelled(per.Label.GRAZING)
        blur = sum(point.error.parameter for point in (doubling, grazing)) + 2e-9  # of the free orbit's mesh
        assert abs(doubling.parameter - GRAZING - 2.32e-6 * (1e2 / stiffness) ** 2) < blur
        assert branch.stop.reason is per.Reason.BOUND


def test_tori_beyond_grazing() -> None:
    """Assert NS of two masses, one before a stop, at their own places, alike from both sides."""

    def rates(x: Any, p: Any, w: Any) -> dict[str, Any]:
        stop = 200.0 * sym.functions.fmax(x.r - 1.0, 0.0)
        first = -0.05 * x.v - x.q - 0.5 * (x.q - x.r) + 0.9 * w.cos
        return {"q": x.v, "r": x.u, "v": first, "u": -0.05 * x.u - x.r - 0.5 * (x.r - x.q) - stop}

    states = dict.fromkeys(("q", "r", "v", "u"), 0.0)
    system = sym.compile(sym.Equations(rates, states, {"Omega": 1.0}, frequency="Omega"))
    found = []
    for way in ((0.6, 1.1), (1.1, 0.6)):
        branch = per.trace(system, "Omega", way, tol=1e-6)
        found.append(sorted(point.parameter for point in branch.labelled(per.Label.TORUS)))
        (grazing,) = branch.labelled(per.Label.GRAZING)
        assert 1e-8 < found[-1][0] - grazing.parameter < 1e-6
        for point in branch.labelled(per.Label.TORUS):
            assert abs(abs(point.multipliers) - 1).min() < 1e-6
    assert len(found[0]) == 4 and found[0] == pytest.approx(found[1], abs=1e-9)
