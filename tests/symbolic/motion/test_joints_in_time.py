"""Simulation of several joints and of exact sliders, against time stepping of Moreau, which knows no events.

Friction impulses are solved for in every step, forces of sliders mapped back to their limit: of first order,
and right whatever sticks and slips.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from dataclasses import dataclass

import numpy as np
import pytest

import symbolic as sym
from symbolic.arrays import Array
from symbolic.equations.surfaces import MINUS, PLUS, STUCK, Kind
from symbolic.integration.flow import Flow

OMEGA, STEPS = 0.8, 3_000


@dataclass(frozen=True)
class Chain:
    """Masses on springs, the last one driven; rows of `ways` are the sliding speeds of joints."""

    masses: tuple[float, ...]
    ground: float
    link: float
    force: float
    ways: Array
    limits: tuple[float, ...]
    sliders: tuple[tuple[float, float], ...] = ()

    def parts(self) -> list[sym.Part]:
        """The same in parts; the sliders are on the last mass."""
        q = sym.coordinates("q", len(self.masses))
        parts: list[sym.Part] = [sym.HarmonicForce(q[-1], self.force, sym.parameter("Omega", OMEGA, "rad/s"))]
        for k, mass in enumerate(self.masses):
            parts += [sym.Mass(q[k], mass), sym.Spring(q[k], self.ground), sym.Damper(q[k], 0.1)]
            parts += [sym.Spring(q[k], self.link, to=q[k - 1])] if k else []
        for way, limit in zip(self.ways, self.limits, strict=True):
            own, other = int(way.argmax()), (way < 0).nonzero()[0]
            parts.append(sym.CoulombFriction(q[own], limit, to=q[other[0]] if len(other) else None))
        return parts + [sym.Jenkins(q[-1], k, limit, creep=None) for k, limit in self.sliders]

    def stepped(self, periods: int) -> tuple[Array, Array]:
        """Positions and speeds at the end, from rest."""
        n, inverse = len(self.masses), np.diag(1 / np.array(self.masses))
        stiffness = self.ground * np.eye(n)
        for k in range(1, n):
            apart = np.eye(n)[k] - np.eye(n)[k - 1]
            stiffness += self.link * np.outer(apart, apart)
        q, v, held = np.zeros(n), np.zeros(n), np.zeros(len(self.sliders))
        dt, unit = 2 * np.pi / OMEGA / STEPS, np.eye(n)[-1]
        answer = self.ways @ inverse @ self.ways.T
        impulse, most = np.zeros(len(self.limits)), dt * np.array(self.limits)
        for step in range(periods * STEPS):
            middle = q + dt / 2 * v
            held = np.array(
                [np.clip(f + k * dt * v[-1], -F, F) for f, (k, F) in zip(held, self.sliders, strict=True)]
            )
            load = -stiffness @ middle - 0.1 * v + unit * self.force * np.cos((step + 0.5) * dt * OMEGA)
            free = v + dt * inverse @ (load - unit * held.sum())
            for _ in range(10):
                for i in range(len(impulse)):
                    slip = self.ways[i] @ free - answer[i] @ impulse
                    impulse[i] = np.clip(impulse[i] + slip / answer[i, i], -most[i], most[i])
            v = free - inverse @ self.ways.T @ impulse
            q = middle + dt / 2 * v
        return q, v


TWO = np.array([[1.0, 0.0], [-1.0, 1.0]])
THREE = np.array([[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, 1.0]])
CHAINS = {
    "two joints": Chain((1.0, 0.6), 1.0, 0.5, 0.8, TWO, (0.25, 0.3)),
    "four joints": Chain((1.0, 0.6, 0.8), 1.0, 0.5, 1.0, THREE, (0.2, 0.15, 0.25, 0.1)),
    "two sliders": Chain((1.0, 0.6), 1.0, 0.5, 0.8, TWO[:0], (), ((2.0, 0.3), (1.0, 0.1))),
    "joint and slider": Chain((1.0, 0.6), 1.0, 0.5, 0.8, TWO[1:], (0.2,), ((2.0, 0.3),)),
}


@pytest.mark.parametrize("name", CHAINS)
def test_like_time_stepping(name: str) -> None:
    """Assert positions and speeds after two periods, to the error of the stepping."""
    chain, periods = CHAINS[name], 2
    motion = sym.simulate(sym.compile(sym.combine(chain.parts())), settle=0, periods=periods)
    q, v = chain.stepped(periods)
    for k in range(len(chain.masses)):
        assert motion[f"q{k + 1}"][-1] == pytest.approx(q[k], abs=4e-3)
        assert motion[f"q{k + 1}'"][-1] == pytest.approx(v[k], abs=4e-3)


def test_events_and_modes() -> None:
    """Assert that the events tell the modes all along, from which friction and sliders follow."""
    system = sym.compile(sym.combine(CHAINS["joint and slider"].parts()))
    kinds = [surface.kind for surface in system.surfaces]
    assert kinds == [Kind.SLIDING, Kind.SLIDER]
    rest = system.rest(system.nominal)
    found = Flow(system).run(*rest, system.nominal, np.linspace(0, 4 * np.pi, 801))
    changes = found.events
    assert {(e.before, e.after) for e in changes if e.surface == 0} >= {(STUCK, PLUS), (MINUS, STUCK)}
    assert {(e.before, e.after) for e in changes if e.surface == 1} == {
        (STUCK, PLUS),
        (PLUS, STUCK),
        (STUCK, MINUS),
        (MINUS, STUCK),
    }
    assert found.modes == changes[-1].modes
    values = system.switch(found.state, found.phase, system.nominal)
    for before, after in zip(changes, changes[1:], strict=False):
        inside = (found.phase > before.phase + 1e-6) & (found.phase < after.phase - 1e-6)
        slip, slider = before.modes
        rate, up, down = values[inside][
            :, [system.surfaces[1].switch, *(system.surfaces[1].releases or ())]
        ].T
        speed = values[inside, system.surfaces[0].switch]
        assert (np.abs(speed) < 1e-9).all() if slip == STUCK else (speed * slip > 0).all()
        carried = {PLUS: up, MINUS: down}
        assert (
            ((up < 0) & (down > 0)).all()
            if slider == STUCK
            else (np.abs(carried[slider]) < 1e-9).all() and (rate * slider > 0).all()
        )


def test_motion_goes_on_in_its_modes() -> None:
    """Assert that a motion in two parts, the second begun in the modes of the first, is that in one."""
    system = sym.compile(sym.combine(CHAINS["joint and slider"].parts()))
    flow, p = Flow(system, 1e-10), system.nominal
    whole = flow.run(*system.rest(p), p, np.array([0.0, 5.0, 9.0]))
    first = flow.run(*system.rest(p), p, np.array([0.0, 5.0]))
    second = flow.run(first.state[-1], first.algebraic[-1], p, np.array([5.0, 9.0]), first.modes)
    np.testing.assert_allclose(second.state[-1], whole.state[-1], atol=1e-8)
    assert first.modes == [e for e in whole.events if e.phase <= 5.0][-1].modes


def test_loop_of_an_exact_slider() -> None:
    """Assert the work of a cycle, 4 F (X - F/k), and the largest force, both to 1e-7."""
    x, k, limit = sym.coordinate("x"), 0.5, 0.1
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.02), sym.HarmonicForce(x, 0.1, 1.15)]
    system = sym.compile(sym.combine([*parts, sym.Jenkins(x, k, limit, creep=None)]))
    motion = sym.simulate(system, settle=60, samples=20000, tolerance=1e-10)
    force, u = motion["force of z of x"], motion["x"]
    work = float(np.sum((force[1:] + force[:-1]) / 2 * np.diff(u)))
    assert work == pytest.approx(4 * limit * (np.ptp(u) / 2 - limit / k), rel=1e-6)
    assert np.abs(force).max() == pytest.approx(limit, rel=1e-8)


def test_interrupt() -> None:
    """Assert that an interrupt ends a long motion of friction at once."""
    system = sym.compile(sym.combine(CHAINS["two joints"].parts()))
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        sym.simulate(system, settle=100_000)
    assert time.monotonic() - begin < 10


def test_events_of_kinks_and_impacts() -> None:
    """Assert that motions without friction tell their events too: sides of a stop in turn, and impacts."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.1), sym.HarmonicForce(x, 1.0, OMEGA)]
    wall = [sym.OneSidedSpring(x, 2.0, gap=0.2), sym.RigidStop(x, 0.5, 0.8, below=True)]
    motion = sym.simulate(sym.compile(sym.combine([*parts, *wall])), settle=0, periods=2)
    kinks, impacts = ([e for e in motion.events if e.surface == i] for i in (0, 1))
    assert len(kinks) > 1 and len(impacts) == len(motion.phase) - len(np.unique(motion.phase)) > 0
    assert all(a.after == b.before for a, b in zip(kinks, kinks[1:], strict=False))
    assert {(e.before, e.after) for e in impacts} == {(PLUS, PLUS)}
    assert [e.phase for e in motion.events] == sorted(e.phase for e in motion.events)
    for event in kinks:
        assert np.interp(event.phase, motion.phase, motion.state[:, 0]) == pytest.approx(0.2, abs=1e-3)


@pytest.mark.parametrize("depth", [1e-4, 1e-6])
def test_short_excursion(depth: float) -> None:
    """Assert that a stop that is touched for a moment only is passed into and out of, beside friction."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.1), sym.HarmonicForce(x, 1.0, 2.0)]
    free = [*parts, sym.CoulombFriction(x, 0.1)]
    motion = sym.simulate(sym.compile(sym.combine(free)), settle=0, periods=2, samples=10_000)
    largest = motion["x"].max()
    assert 0 < motion["x"].argmax() < len(motion.phase) - 1
    system = sym.compile(sym.combine([*free, sym.OneSidedSpring(x, 5.0, gap=largest - depth)]))
    (stop,) = (i for i, s in enumerate(system.surfaces) if s.kind == Kind.KINK)
    events = [e for e in sym.simulate(system, settle=0, periods=2).events if e.surface == stop]
    assert [e.after for e in events] == [PLUS, MINUS]
    assert 0 < events[1].phase - events[0].phase < 0.05
