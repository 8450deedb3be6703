"""Orbits that are refused beyond a change of the pattern of events."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.joints import dry_friction

import periodic as per
from periodic.correction.solution import Solution
from periodic.tracing.steps.patternchange import undetermined


@pytest.fixture(scope="module")
def solution() -> Solution:
    """An orbit of a mass that friction holds for a while, with its tangent."""
    few = per.ArclengthControl(max_points=2)
    run = per.continuation(per.Problem(dry_friction(), "Omega", (0.6, 0.7)), tol=1e-6, control=few)
    assert len(list(run)) and run.state is not None
    return run.state.last


def test_an_orbit_along_which_event_nodes_alone_move_is_undetermined(solution: Solution) -> None:
    """Assert it of a tangent whose states and parameter are rounding, however long it is."""
    tangent = solution.tangent
    rounding = 1e-13 * tangent.profile, 1e-13 * tangent.parameters
    loose = replace(tangent, profile=rounding[0], parameters=rounding[1], phases=np.ones_like(tangent.phases))
    for factor in (1e-4, 1.0, 1e13):
        assert undetermined(replace(solution, tangent=loose.scaled(factor)))
    assert not undetermined(solution)
    brief = replace(tangent, profile=1e-9 * tangent.profile, parameters=0 * tangent.parameters)
    assert not undetermined(replace(solution, tangent=brief))
