"""Friction dampers against closed forms: the loop of an elastic slider, and its spring while it sticks."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import periodic as per
import symbolic as sym

STIFFNESS, LIMIT, PLACE = 0.5, 0.1, 1.15


@cache
def slid() -> per.Branch:
    """The branch of the scene, from above its resonance down into it, where the slider slips."""
    return per.trace(sym.scene("jenkins-damper"), "Omega", (1.1, 1.3), start=1.3, at=PLACE)


def test_loop_is_coulombs() -> None:
    """Assert the work of a cycle, 4 F (X - F/k) of the exact slider, and its largest force, to the creep."""
    (point,) = slid().labelled(per.Label.USER)
    tau = np.linspace(0, 2 * np.pi, 20001)
    states = point.orbit.state(tau)
    x, force = states[:, 0], STIFFNESS * (states[:, 0] - states[:, 2])
    work = float(np.sum((force[1:] + force[:-1]) / 2 * np.diff(x)))
    assert work == pytest.approx(4 * LIMIT * (np.ptp(x) / 2 - LIMIT / STIFFNESS), rel=2e-2)
    assert np.abs(force).max() == pytest.approx(LIMIT, rel=4e-2)


def test_two_slips_in_a_cycle() -> None:
    """Assert four event nodes: each slip has one where it begins and one where it ends."""
    (point,) = slid().labelled(per.Label.USER)
    assert len(point.orbit.phases) == 4


def test_stuck_slider_is_a_spring() -> None:
    """Assert the linear response with the slider's spring where it never slips, to the leak of 1e-4."""
    system = sym.scene("jenkins-damper", {"limit": 100.0})
    first = per.trace(system, "Omega", (2.0, 2.1), start=2.0)[0]
    exact = 2 * 0.1 / abs(1 + STIFFNESS - 4 + 1j * 0.02 * 2)
    assert first.peak_to_peak("x") == pytest.approx(exact, rel=3e-4)


def test_equal_sliders_are_one() -> None:
    """Assert that sliders side by side of equal limits are one of their sum."""
    q = sym.coordinate("x", unit="")
    parts = [sym.Mass(q, 1.0), sym.Damper(q, 0.02), sym.Spring(q, 1.0), sym.HarmonicForce(q, 0.1, 1.3)]
    several = sym.compile(sym.combine([*parts, sym.Iwan(q, STIFFNESS, (LIMIT / 2, LIMIT / 2))]))
    first = per.trace(several, "Omega", (1.3, 1.4), start=1.3)[0]
    assert first.peak_to_peak("x") == pytest.approx(slid()[0].peak_to_peak("x"), rel=1e-12)
