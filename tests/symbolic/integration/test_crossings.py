"""Motions through short contacts and shallow impacts, which lie between an integrator's steps."""

from __future__ import annotations

import numpy as np
import pytest
from reference.bouncing import DAMPING, RESTITUTION, bouncing
from reference.piecewise import period
from support.stops import DAMPING as ZETA
from support.stops import FORCE, exactly, stopped

import symbolic as sym
from symbolic.arrays import Array
from symbolic.integration.flow import Flow

NONE = np.zeros(0)
TURN = 2 * np.pi


def at(system: sym.CompiledSystem, **values: float) -> Array:
    """The nominal parameters with some others."""
    names, parameter = [p.name for p in system.parameters], system.nominal.copy()
    for name, value in values.items():
        parameter[names.index(name)] = value
    return parameter


def without_contact(w: float) -> Array:
    """(q, dq/dt) at tau = 0 of the orbit that never meets the stop."""
    q = FORCE / (1 - w * w + 1j * ZETA * w)
    return np.array([q.real, -q.imag * w])


@pytest.mark.parametrize("stiffness", [5.0, 1e2, 1e4, 1e6])
@pytest.mark.parametrize("w", [0.7106877, 0.71069, 0.72])
def test_short_contacts_are_met(stiffness: float, w: float) -> None:
    """Assert a period that begins without contact and touches (deep 1e-9 to .3) in closed form, to 1e-7."""
    system, start = stopped(stiffness), without_contact(w)
    found = Flow(system, 1e-11).run(start / [1, w], NONE, at(system, Omega=w), np.array([0.0, TURN]))
    truth = period(exactly(stiffness), w, start)
    assert truth.passages
    assert found.state[-1] * [1, w] == pytest.approx(truth.end, abs=1e-7)


@pytest.mark.parametrize("w", [0.7106877, 0.72])
def test_derivatives_through_short_contacts(w: float) -> None:
    """Assert the fundamental matrix of such a period in closed form: it is known to what the length of the
    contact is, 2e-3 rad at the first one.
    """
    system, start = stopped(1e4), without_contact(w)
    flow = system.flow(start / [1, w], NONE, at(system, Omega=w), np.array([0.0, TURN]), (), 1e-12)
    truth = period(exactly(1e4), w, start)
    found = np.diag([1, w]) @ flow.state_gradient[-1] @ np.diag([1, 1 / w])
    assert np.abs(truth.monodromy).max() > 2
    assert found == pytest.approx(truth.monodromy, abs=2e-5 * np.abs(truth.monodromy).max())


@pytest.mark.parametrize("deep", [1e-6, 1e-5, 1e-4])
def test_shallow_impacts_are_met(deep: float) -> None:
    """Assert one impact of the speed that its depth gives, wherever the integration begins."""
    system, force = bouncing(), DAMPING * (1 + deep)
    for begin in np.linspace(0.0, 0.05, 5):
        start = (1 + deep) * np.array([np.sin(begin), np.cos(begin)])
        found = Flow(system, 1e-12).run(start, NONE, at(system, A=force), np.array([begin, begin + TURN]))
        (first,) = np.flatnonzero(np.diff(found.phase) == 0)
        before, after = found.state[first], found.state[first + 1]
        assert before == pytest.approx([1.0, np.sqrt(2 * deep)], rel=1e-3, abs=1e-10)
        assert after == pytest.approx([before[0], -RESTITUTION * before[1]], abs=1e-12)


def test_what_touches_without_passing_goes_on() -> None:
    """Assert that a motion that just does not reach its stop is the one without it."""
    w = 0.7106873
    system, start = stopped(1e6), without_contact(w)
    found = Flow(system, 1e-11).run(start / [1, w], NONE, at(system, Omega=w), np.linspace(0, TURN, 9))
    tau = np.linspace(0, TURN, 9)
    assert found.state[:, 0] == pytest.approx(np.real((start[0] - 1j * start[1] / w) * np.exp(1j * tau)))
