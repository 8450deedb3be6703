"""A joint that holds all along and reaches one of its limits: the branch goes on with it at another place."""

from __future__ import annotations

import numpy as np
import pytest
from reference.joints.judging import judged
from survey.rows import TOL, drawn

import periodic as per
from periodic.tracing import heldplaces

pytestmark = pytest.mark.drawn

RANGE = (0.3535, 0.385)


def test_a_branch_in_the_place_leads_away_from_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that friction is moved again and again as the branch goes on, and that no point is wrong.

    Newton's iteration does not find the orbit with the friction midway, where other events come and go.
    Before, the branch ended at Omega = .3571.
    """
    led: list[bool] = []
    followed = heldplaces._followed

    def noted(*given: object) -> object:
        found = followed(*given)  # type: ignore[arg-type]
        led.append(found is not None)
        return found

    monkeypatch.setattr(heldplaces, "_followed", noted)
    case = drawn("joints", 152)
    branch = per.trace(case.system, "Omega", RANGE, start=RANGE[0], tol=TOL)
    assert branch[-1].parameter == RANGE[1]
    assert sum(led) > 1
    index = [p.name for p in case.system.parameters].index("place of q2")
    places = [float(point.orbit.parameter[index]) for point in branch]
    assert np.ptp(places) > 0.01
    for k in (0, len(branch) // 2, len(branch) - 1):
        assert judged(case.exact, branch[k], case.states).wrong(branch[k], TOL) == ""
