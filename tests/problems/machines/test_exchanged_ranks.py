"""An element of a bearing that is loaded as another one is unloaded: their ranks are exchanged."""

from __future__ import annotations

from dataclasses import replace

import pytest
from support.drawn.machines.drawn import machine
from support.stops import stopped

import periodic as per
import symbolic as sym

TURNING = 982.936
"""rad/s at which the third-largest approach has a corner at 0, rising to it and falling again."""


def test_branch_goes_on_where_ranks_are_exchanged() -> None:
    """Assert that a 6204 with unbalance is traced down through that speed, to the bound, without a gap."""
    drawn = machine("ball bearings", 13)
    branch = per.trace(sym.compile(drawn.model), "speed", (975.0, drawn.bounds[1]), start=drawn.bounds[1])
    assert branch.stop.reason is per.Reason.BOUND and branch[-1].parameter == 975.0
    assert min(branch.values) < TURNING < max(branch.values)
    assert not branch.shortfall and not branch.unaccounted


def test_nodes_that_accuracy_alone_asks_for() -> None:
    """Assert that a mesh without them has at least as many intervals, and that others stay."""
    drawn = machine("ball bearings", 13)
    few = per.ArclengthControl(max_points=40)
    branch = per.trace(sym.compile(drawn.model), "speed", drawn.bounds, start=drawn.bounds[1], control=few)
    orbit = max(branch, key=lambda point: len(point.orbit.phases)).orbit
    assert len(orbit.phases) > 4 and {event.level for event in orbit.mesh.events} == {-1.0}
    choice = per.Collocation().eased(orbit)
    assert choice is not None
    mesh, phases = choice
    assert len(phases) == 0 and mesh.events == () and mesh.ntst >= orbit.mesh.ntst
    struck = per.trace(stopped(1e2), "Omega", (0.8, 0.9), start=0.8, control=few)[0].orbit
    assert len(struck.phases) == 2 and per.Collocation().eased(struck) is None
    with_both = per.Shooting().eased(struck)
    assert with_both is None


@pytest.mark.parametrize("levels", [(0.0, -1.0), (-1.0, 0.0)])
def test_nodes_where_the_equations_change_stay(levels: tuple[float, float]) -> None:
    """Assert it by an orbit with a node of either kind."""
    struck = per.trace(stopped(1e2), "Omega", (0.8, 0.9), start=0.8)[0].orbit
    events = tuple(
        replace(event, level=level) for event, level in zip(struck.mesh.events, levels, strict=True)
    )
    orbit = replace(struck, mesh=replace(struck.mesh, events=events))
    choice = per.Collocation().eased(orbit)
    assert choice is not None
    mesh, phases = choice
    kept = levels.index(0.0)
    assert mesh.events == (events[kept],) and phases.tolist() == [struck.phases[kept]]
