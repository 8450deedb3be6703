"""Words of orbits: event nodes as transitions between modes, and what is no word."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.events.modes import completed, inconsistency, mode_after, sides, surface_of
from periodic.events.violations import Breach, violations
from periodic.orbit.mesh import EventNode
from periodic.system import STUCK

STOP = EventNode(0, -1, modes=((0, STUCK),))
UP, DOWN = EventNode(1, 1), EventNode(2, -1)


def dry() -> sym.CompiledSystem:
    """A mass on Coulomb friction: guard 0, releases 1 and 2."""
    x = sym.coordinate("x", unit="m")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 0.1) + sym.CoulombFriction(x, 0.5)
    return sym.compile(model + sym.HarmonicForce(x, 1.0))


@pytest.fixture(scope="module")
def sticking() -> per.Point:
    """It sticks twice in a period."""
    few = per.ArclengthControl(max_points=1)
    return per.trace(dry(), "Omega", (0.4, 0.5), start=0.4, control=few)[0]


@pytest.mark.parametrize(
    ("events", "word"),
    [
        ((STOP, DOWN, EventNode(0, 1)), True),
        ((STOP, UP), True),
        ((EventNode(0, 1), EventNode(0, -1)), True),
        ((STOP, STOP), False),
        ((EventNode(0, 1), UP), False),
        ((STOP, EventNode(0, 1)), False),
        ((EventNode(0, 1), EventNode(0, 1)), False),
        ((), True),
    ],
)
def test_each_transition_begins_where_the_one_before_ended(events: tuple[EventNode, ...], word: bool) -> None:
    """Assert what is a word of one surface along which motions stick."""
    assert (inconsistency(dry(), events) == "") is word


def test_modes_after_event_nodes() -> None:
    """Assert the modes that event nodes say, and that an impact takes a guard to its other side."""
    surface = surface_of(dry(), 0)
    assert [mode_after(surface, e) for e in (STOP, UP, DOWN, EventNode(0, 1))] == [STUCK, 1, -1, 1]
    assert mode_after(surface, EventNode(7, -1)) is None
    assert mode_after(surface, EventNode(7, -1, modes=((0, -1),))) == -1


def test_files_keep_modes(sticking: per.Point, tmp_path: Path) -> None:
    """Assert that a saved branch has the modes of its event nodes; else they follow from their order."""
    branch = per.trace(dry(), "Omega", (0.4, 0.5), control=per.ArclengthControl(max_points=2))
    branch.save(tmp_path / "dry.nc")
    found = per.Branch.load(tmp_path / "dry.nc")[0].orbit.mesh.events
    assert found == sticking.orbit.mesh.events
    assert completed(dry(), [replace(event, modes=()) for event in found]) == found


def test_violations_of_a_word(sticking: per.Point) -> None:
    """Assert that an orbit has none, and that without a stop, or with one, it has."""
    system, orbit = dry(), sticking.orbit
    assert violations(system, orbit) == []
    assert {*sides(system, orbit)[:, 0]} == {-1.0, 1.0, 2.0}
    plain = tuple(replace(event, modes=()) for event in orbit.mesh.events)
    slips = replace(orbit, mesh=replace(orbit.mesh, events=plain))
    assert {v.breach for v in violations(system, slips)} >= {Breach.MODE}


def test_node_that_passes_the_other_way(sticking: per.Point) -> None:
    """Assert that an event node is told that passes its level against its direction."""
    system, orbit = dry(), sticking.orbit
    first = orbit.mesh.events[0]
    turned = (replace(first, direction=-first.direction), *orbit.mesh.events[1:])
    found = violations(system, replace(orbit, mesh=replace(orbit.mesh, events=turned)))
    reversed_there = [v for v in found if v.breach is Breach.REVERSED]
    assert [v.at for v in reversed_there] == [0] and reversed_there[0].depth > 0
    assert np.isfinite(reversed_there[0].depth)
