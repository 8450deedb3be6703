"""Orbits that slip where they should stick, by less than their own error: a finer mesh may mend it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.collocation import collocation, meshmethod
from periodic.collocation.collocation import Collocation
from periodic.correction.error import ErrorEstimate
from periodic.events.violations import Breach, Violation

FINE, COARSE = 1e-2, 1e-10
"""Tolerances that the orbit meets, and that it misses."""


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch) -> tuple[Any, ...]:
    """What the error of a motion that sticks and slips is estimated from: method, problem, correction, ..."""
    q, asked, error = sym.coordinate("q"), list[tuple[Any, ...]](), Collocation.error

    def estimated(*given: Any) -> ErrorEstimate:
        asked.append(given)
        return error(*given)

    monkeypatch.setattr(Collocation, "error", estimated)
    model = sym.Mass(q, 1.0) + sym.Spring(q, 1.0) + sym.Damper(q, 0.1) + sym.CoulombFriction(q, 0.5)
    system = sym.compile(model + sym.HarmonicForce(q, 1.0))
    per.trace(system, "Omega", (0.4, 0.5), start=0.4, control=per.ArclengthControl(max_points=1))
    return asked[-1]


@pytest.mark.parametrize(
    ("part", "tolerance", "refined"), [(0.5, COARSE, True), (2, COARSE, False), (0.5, FINE, False)]
)
def test_slip_by_less_than_the_error(
    part: float, tolerance: float, refined: bool, given: tuple[Any, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that the mesh is refined there if it may be to blame; else the orbit is not believed."""
    method, problem, correction, tangent, spectrum = given
    method, orbit = replace(method, tolerance=tolerance), correction.orbit
    own = method.error(problem, correction, tangent, spectrum)
    assert orbit.mesh.events and COARSE < 3 * own.orbit < FINE
    place = Violation(Breach.MODE, 0, 0, 1, part * own.orbit)
    for module in (collocation, meshmethod):
        monkeypatch.setattr(module, "mode_violations", lambda system, orbit: [place])
    found = method.error(problem, correction, tangent, spectrum)
    assert np.isfinite(found.orbit) == refined
    refinement = method.refine(problem.system, orbit, found)
    assert (refinement.refined().ntst > 1.5 * orbit.mesh.ntst) == refined
    assert ("too short a while" in refinement.shortfall) != refined
