"""Condensed orbits interval by interval, against all of their equations at once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
import pytest
from support.cantilevers import cantilever

import periodic as per
import symbolic as sym
from periodic.condensed import floquet, operator
from periodic.condensed.linearised import SplitLinearisation
from periodic.condensed.operator import CondensedOperator
from periodic.events.eventrows import event_rows

ELEMENTS, RANGE = 2, (2.8, 2.95)


def stop(tip: Any) -> Sequence[sym.Part]:
    """A stop."""
    return [sym.OneSidedSpring(tip, 300.0, 0.03)]


def joint(tip: Any) -> Sequence[sym.Part]:
    """A joint that slips, with a state of its own, and a stop."""
    return [sym.Jenkins(tip, 0.3, 0.004, creep=1e-2), sym.OneSidedSpring(tip, 30.0, 0.02)]


@cache
def branch(at_tip: Any) -> per.Branch:
    """A few points in contact."""
    system = cantilever(ELEMENTS, at_tip, force=0.03, damping=0.02)
    return per.trace(system, "Omega", RANGE, tol=1e-5)


@pytest.mark.parametrize("at_tip", [stop, joint])
def test_is_the_same_as_all_equations_at_once(at_tip: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert increments, multipliers and motion along the orbit to 10 digits."""
    system, orbit = cantilever(ELEMENTS, at_tip, force=0.03, damping=0.02), branch(at_tip).points[-1].orbit
    assert orbit.mesh.events
    found = []
    for chained in (True, False):
        for module in (floquet, operator):
            monkeypatch.setattr(module, "pays", lambda *_, chained=chained: chained)
        equations = CondensedOperator(
            SplitLinearisation.about(system, orbit, ()), event_rows(system, orbit, ())
        )
        increment, kernel = equations.solve([], np.array([[1.0, 0.0]]))
        values = np.linalg.eigvals(equations.fundamental[-1])
        found.append((increment.nodes, increment.phases, np.sort_complex(values), equations.fundamental))
        assert not np.any(kernel.nodes) and (equations.leading.floquet.chain is not None) == chained
    for ours, other in zip(*found, strict=True):
        assert np.abs(ours - other).max() < 1e-10 * max(1.0, float(np.abs(other).max()))


@pytest.mark.long
def test_joint_is_that_of_all_states() -> None:
    """Assert the tip and the leading multiplier of a beam with a joint and a stop, to 5 digits."""
    whole = cantilever(ELEMENTS, joint, condense=False, force=0.03, damping=0.02)
    full = per.trace(whole, "Omega", RANGE, tol=1e-5).points[-1]
    ours = branch(joint).points[-1]
    assert ours.parameter == full.parameter == RANGE[1]
    assert ours.peak_to_peak("tip") == pytest.approx(full.peak_to_peak("tip"), rel=1e-5)
    assert np.abs(ours.multipliers[0]) == pytest.approx(np.abs(full.multipliers[0]), abs=1e-5)
