"""Simulation through dry friction: the motion sticks and slips, event by event."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from reference.contact import period
from support.drawn.contact import Drawn

import periodic as per
import symbolic as sym
from symbolic.integration import field

F = sym.functions


def rubbed() -> sym.CompiledSystem:
    """x'' + .1 x' + x + .1 sign(x') = F cos w t."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.1), sym.CoulombFriction(x, 0.1)]
    return sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 0.3, 0.5)]))


def test_settles_to_the_orbit_that_sticks_twice() -> None:
    """Assert the motion on the traced orbit to 1e-8, at rest for as long as its stops last."""
    system = rubbed()
    point = per.trace(system, "F", (0.29, 0.31), at=0.3, tol=1e-9).labelled(per.Label.USER)[0]
    assert len(point.orbit.mesh.events) == 4
    motion = sym.simulate(system, settle=20, tolerance=1e-11)
    exact = point.orbit.state(motion.phase)
    np.testing.assert_allclose(motion.state, exact, atol=1e-8)
    stopped = np.abs(motion.state[:, 1]) < 1e-10
    lengths = point.orbit.mesh.segment_lengths(point.orbit.phases)
    held = sum(length for length, e in zip(lengths, point.orbit.mesh.events, strict=True) if e.switch == 0)
    assert stopped.mean() == pytest.approx(held / (2 * np.pi), abs=0.01)


def test_holds_for_ever() -> None:
    """Assert that a force below the friction moves nothing."""
    motion = sym.simulate(rubbed(), {"F": 0.09}, settle=2)
    np.testing.assert_allclose(motion.state, 0.0, atol=1e-12)


def test_friction_and_a_wall() -> None:
    """Assert a motion through stops and impacts, event by event in closed form, to 1e-8."""
    model = Drawn(1)
    model.spring(0, None, 1.0, 0.1)
    model.friction(0, None, 0.1)
    model.wall(0, 0.2, 0.8, below=False)
    model.force[0] = 0.5
    system = model.compiled()
    motion = sym.simulate(system, {"Omega": 0.5}, settle=0, periods=3, tolerance=1e-11)
    assert len(motion.phase) > len(np.unique(motion.phase))  # impacts
    assert (motion.state[:, 0] < 0.2 + 1e-9).all()
    late = int(np.abs(motion["q0'"]).argmax())
    begin = np.array([motion["q0"][late], motion["q0'"][late]])
    end = int(np.abs(motion.phase - (motion.phase[late] + 2 * np.pi)).argmin())
    found = period(model.exact(), 0.5, begin, float(motion.phase[late]))
    np.testing.assert_allclose(found.end, [motion["q0"][end], motion["q0'"][end]], atol=1e-8)


def test_fast_modes_need_no_steps_of_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert a beam's tip on friction, ringing, to 1e-4 of one followed to 1e-10; by Radau."""
    structure = sym.Structure(
        sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=3), damping=0.02
    )
    tip, followed, asked = structure["tip"], field.followed, list[str]()
    parts = structure + sym.CoulombFriction(tip, 0.002) + sym.HarmonicForce(tip, 0.02, 2.0)
    system = sym.compile(parts, condense=False)

    def noted(*given: Any) -> Any:
        asked.append(given[5])
        return followed(*given)

    monkeypatch.setattr(field, "followed", noted)
    loose, by = sym.simulate(system, settle=0, periods=2, tolerance=1e-6), set(asked)
    tight = sym.simulate(system, settle=0, periods=2, tolerance=1e-10)
    assert by == {"Radau"} and set(asked) == by
    assert np.abs(loose["tip"] - tight["tip"]).max() < 1e-4 * np.ptp(tight["tip"])
