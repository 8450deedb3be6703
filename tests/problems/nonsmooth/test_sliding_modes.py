"""Sliding along a jump of position and speed, as variable structure control has it, against exponentials."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
from reference.shooting import in_order
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

import periodic as per
import symbolic as sym
from periodic.system import STUCK, Kind

F = sym.functions
LOOKS, W = np.linspace(0.0, 2 * np.pi, 2001), 0.8


@dataclass(frozen=True)
class Exact:
    """x'' + c x' + k x = F cos t - (up where s = x' + lam x > 0, else down), and x' = -lam x where it slides.

    In each mode the motion is the sum of a harmonic one and exponentials; events are zeros of s, of its
    rates on either side.
    """

    force: float
    lam: float
    up: float
    down: float
    c: float = 0.0
    k: float = 0.0

    def free(self, t: Any, y: Any, mode: int) -> Any:
        """x'' on a side."""
        push = self.up if mode > 0 else self.down
        return self.force * np.cos(t) - push - self.c * y[1] - self.k * y[0]

    def rate(self, t: Any, y: Any, mode: int) -> Any:
        """s' on a side."""
        return self.free(t, y, mode) + self.lam * y[1]

    def flow(self, t: float, y: Any, mode: int) -> Any:
        """The motion after t, a function of the time since; of many times at once."""
        if mode == 0:
            along = np.array([1.0, -self.lam])[:, None] * y[0]
            return lambda since: along * np.exp(-self.lam * np.atleast_1d(since))
        push = self.up if mode > 0 else self.down
        full = np.zeros((5, 5))  # x, v, cos, sin, 1
        full[0, 1], full[1, :2] = 1.0, (-self.k, -self.c)
        full[1, 2], full[1, 4], full[2, 3], full[3, 2] = self.force, -push, -1.0, 1.0
        begin = np.array([*y, np.cos(t), np.sin(t), 1.0])
        return lambda since: np.array([(expm(full * s) @ begin)[:2] for s in np.atleast_1d(since)]).T

    def guards(self, mode: int) -> list[Any]:
        """What is positive in a mode."""
        if mode:
            return [lambda t, y: mode * (y[1] + self.lam * y[0])]
        return [lambda t, y: -self.rate(t, y, 1), lambda t, y: self.rate(t, y, -1)]

    def after(self, t: float, y: Any) -> int:
        """The mode in which the motion goes on from s = 0."""
        up, down = self.rate(t, y, 1), self.rate(t, y, -1)
        return 0 if up < 0 < down else 1 if up >= 0 else -1

    def field(self, t: float, y: Any, mode: int) -> Any:
        """(x', v')."""
        return np.array([y[1], -self.lam * y[1] if mode == 0 else self.free(t, y, mode)])

    def carried(self, since: float, mode: int) -> Any:
        """What is made of small changes in a mode, (2, 2)."""
        if mode:
            return expm(np.array([[0.0, 1.0], [-self.k, -self.c]]) * since)
        return np.array([[1.0, 0.0], [-self.lam, 0.0]]) * np.exp(-self.lam * since)

    def period(self, t: float, y: Any, mode: int) -> tuple[Any, Any, int]:
        """The state 2 pi later, what is made of small changes, and how often it began to slide."""
        left, slid, monodromy, slope = 2 * np.pi, 0, np.eye(2), np.array([self.lam, 1.0])
        while True:
            flow = self.flow(t, y, mode)
            since, which = self._event(t, flow, mode, left)
            y, monodromy = flow(since)[:, 0], self.carried(since, mode) @ monodromy
            if which < 0:
                return y, monodromy, slid
            t, left, before = t + since, left - since, mode
            mode = (1 if which == 0 else -1) if mode == 0 else self.after(t, y)
            if before:
                old, new = self.field(t, y, before), self.field(t, y, mode)
                monodromy = (np.eye(2) + np.outer(new - old, slope) / (slope @ old)) @ monodromy
            slid += mode == 0

    def _event(self, t: float, flow: Any, mode: int, left: float) -> tuple[float, int]:
        """The first zero of a guard, and which; the end and -1 where none is."""
        looks = LOOKS[left > LOOKS]
        y, found = flow(looks), [(left, -1)]
        for which, guard in enumerate(self.guards(mode)):
            values = guard(t + looks, y)
            for j in np.flatnonzero((values[1:] < 0) & (values[:-1] >= 0)) if len(looks) > 1 else ():
                if j == 0 and abs(values[0]) < 1e-9:  # it has just passed there
                    continue

                def value(s: float, guard: Any = guard) -> float:
                    return float(guard(t + s, flow(s)[:, 0]))

                found.append((brentq(value, looks[j], looks[j + 1], xtol=1e-15), which))
                break
        return min(found)


def judged(point: per.Point, exact: Exact, begin: float, mode: int) -> int:
    """Assert that a point comes back to 1e-9 and its multipliers to 1e-8; return how often it slides."""
    y = point.orbit.state(np.array([begin]))[0]
    later, monodromy, slid = exact.period(begin, y, mode)
    np.testing.assert_allclose(later, y, atol=1e-9)
    np.testing.assert_allclose(in_order(point.multipliers), in_order(np.linalg.eigvals(monodromy)), atol=1e-8)
    return slid


CONTROL = {"lam": 0.7, "up": 0.4, "down": -0.2, "c": 0.1, "k": 0.5, "F": 0.5, "w": 1.0}


@cache
def controlled() -> sym.CompiledSystem:
    """An oscillator under a force that switches with v + lam x, unequal on the two sides."""
    return sym.compile(
        sym.Equations(
            lambda x, p, wave: {
                "x": x.v,
                "v": p.F * wave.cos - p.c * x.v - p.k * x.x - F.if_else(x.v + p.lam * x.x > 0, p.up, p.down),
            },
            {"x": 0.0, "v": 0.0},
            CONTROL,
            frequency="w",
        )
    )


def begin_of(point: per.Point) -> tuple[float, int]:
    """A phase in the longest stretch between two events, and the mode there."""
    orbit = point.orbit
    lengths = orbit.mesh.segment_lengths(orbit.phases)
    j = int(lengths.argmax())
    event = orbit.mesh.events[j]
    mode = dict(event.modes).get(0, event.direction)
    return float(orbit.phases[j] + 0.4 * lengths[j]), 0 if mode == STUCK else mode


@pytest.mark.parametrize("start", [0.05, 0.5, 1.5])
def test_from_sliding_all_along_to_none(start: float) -> None:
    """Assert orbits to 1e-9 and multipliers to 1e-8 at every other point, from three starts, over the force.

    Up from 0.2 the motion leaves s = 0 for a while, then on both sides, slides twice, once and no more.
    """
    system = controlled()
    (surface,) = system.surfaces
    assert surface.kind == Kind.SLIDING and surface.alone
    branch = per.trace(system, "F", (0.05, 1.5), start=start, tol=1e-9)
    assert "end of the range" in str(branch.stop)
    counts = set()
    for point in branch:
        if not point.orbit.mesh.events:
            assert point.parameter < 0.2 + 1e-8 and point.peak_to_peak("x") < 1e-9
            assert max(abs(point.multipliers)) == pytest.approx(np.exp(-2 * np.pi * 0.7), abs=1e-9)
    for point in [p for p in branch if p.orbit.mesh.events][::2]:
        exact = Exact(point.parameter, 0.7, 0.4, -0.2, 0.1, 0.5)
        counts.add(judged(point, exact, *begin_of(point)))
    assert counts == {0, 1, 2}


def test_motion_that_tracks() -> None:
    """Assert x = r cos t to 1e-9 up to an r known in closed form, and on beyond it.

    On s = 0 it takes (k - 1) r cos t - c r sin t; both starts lead to one branch.
    """
    system = sym.compile(
        sym.Equations(
            lambda x, p, wave: {
                "x": x.v,
                "v": -p.k * x.x
                - p.c * x.v
                - p.K * F.sign(x.v + p.r * wave.sin + p.lam * (x.x - p.r * wave.cos)),
            },
            {"x": 0.0, "v": 0.0},
            {"r": 0.3, "K": 0.5, "lam": 0.8, "k": 2.0, "c": 0.1, "w": 1.0},
            frequency="w",
        )
    )
    most, phase = 0.5 / np.hypot(1.0, 0.1), np.linspace(0, 6, 30)
    for start, near in ((0.45, 1e-8), (0.55, 1e-5)):  # slips end before they are of no length
        branch = per.trace(system, "r", (0.4, 0.6), start=start, tol=1e-9)
        assert "end of the range" in str(branch.stop)
        held = [point for point in branch if not point.orbit.mesh.events]
        slips = [point for point in branch if point.orbit.mesh.events]
        assert max(point.parameter for point in held) == pytest.approx(most, abs=near)
        assert most < min(point.parameter for point in slips) < most + 1e-3  # slips of 0.1 rad are the first
        for point in held:
            wanted = point.parameter * np.cos(phase)
            np.testing.assert_allclose(point.orbit.state(phase)[:, 0], wanted, atol=1e-9)
            assert max(abs(point.multipliers)) == pytest.approx(np.exp(-2 * np.pi * 0.8), abs=1e-9)


def test_first_order() -> None:
    """Assert phases to 1e-9 where a temperature is held at 1 by heat switched on and off without a band.

    It leaves where A cos t is 1 or -1, and comes back as exponentials have it.
    """
    system = sym.compile(
        sym.Equations(
            lambda x, p, wave: {"T": (p.A * wave.cos - x.T) / 2 + F.if_else(x.T < 1, 1, 0)},
            {"T": 0.0},
            {"A": 2.0, "w": 1.0},
            frequency="w",
        )
    )
    branch = per.trace(system, "A", (1.1, 2.3), start=2.0, tol=1e-9)
    assert "end of the range" in str(branch.stop)

    def excess(t: float, begin: float, a: float) -> float:
        """y - 1 with y' = (a cos t - y)/2, from 1."""

        def forced(t: float) -> float:
            return float(a * (0.25 * np.cos(t) + 0.5 * np.sin(t)) / 1.25)

        return forced(t) - 1 + (1 - forced(begin)) * float(np.exp(-(t - begin) / 2))

    for point in branch:
        leaves = -float(np.arccos(1 / point.parameter))
        back = brentq(excess, 0.01, 3.0, args=(leaves, point.parameter), xtol=1e-14)
        each = [leaves, back, leaves + np.pi, back + np.pi]
        np.testing.assert_allclose(
            np.sort(np.mod(point.orbit.phases, 2 * np.pi)), np.sort(np.mod(each, 2 * np.pi)), atol=1e-9
        )
        assert abs(point.multipliers[0]) < 1e-12


def curved(force: float) -> Any:
    """The map over a period of a control whose gain changes its sign with x, on a curved s = 0."""

    def free(t: float, y: Any, mode: float) -> float:
        return float(force * np.cos(t) - y[0] - 0.1 * y[1] - 0.2 * (1 + 1.5 * y[0]) * mode)

    def guard(y: Any) -> float:
        return float(y[1] + 0.8 * y[0] + 0.3 * y[0] ** 3)

    def slope(t: float, y: Any, mode: float) -> float:
        return free(t, y, mode) + (0.8 + 0.9 * y[0] ** 2) * y[1]

    def rates(t: float, y: Any, mode: float, begin: float) -> list[float]:
        held = -(0.8 + 0.9 * y[0] ** 2) * y[1]
        return [y[1] / W, (held if mode == 0 else free(t, y, mode)) / W]

    def first(t: float, y: Any, mode: float, begin: float) -> float:
        if mode == 0:
            return -slope(t, y, 1.0)
        return guard(y) if t > begin + 1e-6 else mode

    def second(t: float, y: Any, mode: float, begin: float) -> float:
        return slope(t, y, -1.0) if mode == 0 else 1.0

    def period(t: float, y: Any, mode: float) -> tuple[Any, int]:
        last, slid = t + 2 * np.pi, 0
        while True:
            for event, way in ((first, -mode if mode else -1.0), (second, -1.0)):
                event.terminal, event.direction = True, way  # type: ignore[attr-defined]
            tight = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "max_step": 0.05}
            given = mode, t
            found = solve_ivp(rates, (t, last), y, events=[first, second], args=given, **tight)
            t, y = float(found.t[-1]), found.y[:, -1]
            if found.status == 0:
                return y, slid
            if mode == 0:
                mode = 1.0 if len(found.t_events[0]) else -1.0
            else:
                y[1] -= guard(y)
                up, down = slope(t, y, 1.0), slope(t, y, -1.0)
                mode = 0.0 if up < 0 < down else 1.0 if up >= 0 else -1.0
                slid += mode == 0

    return period


def test_any_surface() -> None:
    """Assert orbits to 1e-9, multipliers to 1e-6, where s is curved and the jump does not always attract."""
    system = sym.compile(
        sym.Equations(
            lambda x, p, wave: {
                "x": x.v,
                "v": p.F * wave.cos
                - x.x
                - 0.1 * x.v
                - 0.2 * (1 + 1.5 * x.x) * F.sign(x.v + 0.8 * x.x + 0.3 * x.x**3),
            },
            {"x": 0.0, "v": 0.0},
            {"F": 0.5, "w": W},
            frequency="w",
        )
    )
    values = (0.19, 0.25, 0.31, 0.329, 0.45)
    branch = per.trace(system, "F", (0.18, 0.5), start=0.4, tol=1e-9, at=values)
    assert "end of the range" in str(branch.stop)
    counts = []
    for point in branch.labelled(per.Label.USER):
        if not point.orbit.mesh.events:
            assert point.parameter == 0.19 and point.peak_to_peak("x") < 1e-9
            continue
        period, (begin, mode) = curved(point.parameter), begin_of(point)
        y = point.orbit.state(np.array([begin]))[0]
        later, slid = period(begin, y, mode)
        np.testing.assert_allclose(later, y, atol=1e-9)
        step = 1e-5
        columns = [
            (period(begin, y + u, mode)[0] - period(begin, y - u, mode)[0]) / (2 * step)
            for u in np.eye(2) * step
        ]
        monodromy = np.array(columns).T
        np.testing.assert_allclose(
            in_order(point.multipliers), in_order(np.linalg.eigvals(monodromy)), atol=1e-6
        )
        counts.append(slid)
    assert sorted(counts) == [0, 1, 1, 2]
