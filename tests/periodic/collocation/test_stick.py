"""How long a mass sticks, where the rest of the motion is known."""

from __future__ import annotations

import numpy as np
import pytest

import symbolic as sym
from periodic.events.rewrites import first
from periodic.events.violations import Breach, Violation
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import uniform
from periodic.orbit.scheme import Scheme
from periodic.system import STUCK, index_of
from symbolic.arrays import Array


def released(system: sym.CompiledSystem, state: Array, begin: float) -> list[float]:
    """Where a motion that begins at rest on friction comes off, within a period."""
    parameter = system.nominal
    parameter[index_of(system, "Omega")] = 1.0
    phase = np.array([begin, begin + 2 * np.pi])
    events = system.motion(state, np.zeros(0), parameter, phase, 1e-8).events
    return [event.phase for event in events if event.before == STUCK]


@pytest.mark.parametrize("begin", [0.0, 0.5])
@pytest.mark.parametrize("side", [1, -1])
def test_release_of_a_mass_that_another_pulls(side: int, begin: float) -> None:
    """Assert where a spring pulls a mass off, to 1e-4.

    A mass at x = 0 on friction F = 1, joined by a spring 1 to a mass 1 that begins at y = 0, y' = 1.5 beside
    it; while x sticks y = 1.5 sin(tau - begin), and x comes off where that is 1.
    """
    x, y = sym.coordinate("x"), sym.coordinate("y")
    model = sym.Mass(x, 1.0) + sym.Mass(y, 1.0) + sym.Spring(x, 1.0, to=y) + sym.CoulombFriction(x, 1.0)
    system = sym.compile(model + sym.HarmonicForce(x, 0.0))
    names = [state.name for state in system.states]
    state = np.zeros(len(names))
    state[names.index("y'")] = side * 1.5
    assert released(system, state, begin)[0] == pytest.approx(begin + np.arcsin(1 / 1.5), abs=1e-4)


def test_release_beside_a_fast_mode() -> None:
    """Assert the same where a part of y rings within a hundredth of a step, and shifts it by 5e-7."""
    x, y, z = (sym.coordinate(name) for name in "xyz")
    model = sym.Mass(x, 1.0) + sym.Mass(y, 1.0) + sym.Spring(x, 1.0, to=y) + sym.CoulombFriction(x, 1.0)
    fast = sym.Mass(z, 1e-6) + sym.Spring(z, 100.0, to=y)
    system = sym.compile(model + fast + sym.HarmonicForce(x, 0.0))
    names = [state.name for state in system.states]
    state = np.zeros(len(names))
    state[names.index("y'")] = 1.5
    assert released(system, state, 0.0)[0] == pytest.approx(np.arcsin(1 / 1.5), abs=1e-4)


def test_stretch_without_end() -> None:
    """Assert that a mass which is pulled less than friction holds is not released within a period."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    model = sym.Mass(x, 1.0) + sym.Mass(y, 1.0) + sym.Spring(x, 1.0, to=y) + sym.CoulombFriction(x, 1.0)
    system = sym.compile(model + sym.HarmonicForce(x, 0.0))
    names = [state.name for state in system.states]
    state = np.zeros(len(names))
    state[names.index("y'")] = 0.9
    assert released(system, state, 0.0) == []


@pytest.mark.parametrize(("node", "share"), [(1, 0.75), (4, 0.25)])
def test_part_of_the_way_to_a_limit(monkeypatch: pytest.MonkeyPatch, node: int, share: float) -> None:
    """Assert that a limit lies where its own value, not another's, is 0 on a line between two orbits."""
    known = {1: 0.3, 4: 0.1 / 3, 5: 2.0}
    limits = [Violation(Breach.MODE, 0, at, 1, -value) for at, value in known.items()]
    monkeypatch.setattr(first, "limits", lambda system, orbit, surface: limits)
    system = sym.scene("jenkins-damper")
    orbit = at_rest(system, uniform(Scheme(), 8), system.nominal)
    past = Violation(Breach.MODE, 0, node, 1, 0.1)
    assert first._share(system, orbit, past) == pytest.approx(share)
