"""Relays with hysteresis, against closed forms: a thermostat, relay feedback, an oscillator with a memory."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from reference.shooting import in_order
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq, minimize_scalar
from support.kept import kept

import periodic as per
import symbolic as sym
from periodic.system import MINUS, PLUS

F = sym.functions
TAU, BAND = 8.0, 0.2


@cache
def thermostat() -> sym.CompiledSystem:
    """T' = (A cos t - T)/tau + h r(T), which heats below 0.8 until it is warmer than 1.2; its mean is 1."""
    return sym.compile(
        sym.Equations(
            lambda x, p, wave: {
                "T": (p.A * wave.cos - x.T) / p.tau + p.h * F.relay(x.T, p.on, p.off, low=1, high=0)
            },
            {"T": 0.0},
            {"A": 0.3, "tau": TAU, "h": 2 / TAU, "on": 1 + BAND, "off": 1 - BAND, "w": 1.0},
            frequency="w",
        )
    )


def forced(t: float, a: float) -> tuple[float, float]:
    """A solution of y' = (a cos t - y)/tau, and its rate."""
    k = 1 / TAU
    size = a * k / (k * k + 1)
    return size * (k * np.cos(t) + np.sin(t)), size * (np.cos(t) - k * np.sin(t))


def missed(phi: float, a: float) -> float:
    """How far y = T - 1 is above -BAND half a period after it rose through BAND at phi, the heating off."""
    return BAND + forced(phi + np.pi, a)[0] - 1 + (BAND + 1 - forced(phi, a)[0]) * np.exp(-np.pi / TAU)


def speeds(phi: float, a: float) -> tuple[float, float]:
    """y' just before and just after T rises through the threshold: y' jumps by -2/tau."""
    after = forced(phi, a)[1] - (BAND + 1 - forced(phi, a)[0]) / TAU
    return after + 2 / TAU, after


def amplitude(phi: float) -> float:
    """The A at which the heating goes off at phi: what is missed is linear in it."""
    none, one = missed(phi, 0.0), missed(phi, 1.0)
    return none / (none - one)


def off(point: per.Point) -> float:
    """The phase at which the heating of a point goes off."""
    each = zip(point.orbit.mesh.events, point.orbit.phases, strict=True)
    (phi,) = (float(phi) for event, phi in each if event.direction > 0)
    return phi


@kept
def branches() -> tuple[per.Branch, per.Branch]:
    """Over the amplitude, from its middle both ways, and back from its upper end."""
    there = per.trace(thermostat(), "A", (0.02, 1.5), start=0.3, tol=1e-9)
    back = per.trace(thermostat(), "A", (0.02, 1.5), guess=there[-1].orbit, start=1.5, tol=1e-9)
    return there, back


def test_thermostat_at_every_point() -> None:
    """Assert A at the phase of switching and T to 1e-9, the multiplier to 1e-8, at every point.

    In half a period differences die away by exp(-pi/tau), and at the switching by the ratio of the speeds.
    """
    for branch in branches():
        assert len(branch) > 15
        for point in branch:
            phi, a = off(point), point.parameter
            assert amplitude(phi) == pytest.approx(a, abs=1e-9)
            since = np.linspace(0.1, 3.0, 20)
            cooling = forced(phi + since, a)[0] + (1 + BAND - forced(phi, a)[0]) * np.exp(-since / TAU)
            np.testing.assert_allclose(point.orbit.state(phi + since)[:, 0], cooling, atol=1e-9)
            before, after = speeds(phi, a)
            exact = (np.exp(-np.pi / TAU) * after / before) ** 2
            least = 1e-8 if before > 1e-3 else 1e-3  # 1/speed^2 of what is known to rounding
            assert point.multipliers[0].real == pytest.approx(exact, rel=least)


def test_thermostat_folds_and_grazes() -> None:
    """Assert the fold to 1e-9, and that the unstable orbits end where T only just reaches the threshold.

    There T has no speed left, and past it does not switch any more: the amplitude to 1e-5.
    """
    fold = minimize_scalar(amplitude, bounds=(1.0, 2.0), method="bounded", options={"xatol": 1e-12}).fun
    phi = brentq(lambda phi: speeds(phi, amplitude(phi))[0], 2.9, 3.0, xtol=1e-15)
    for branch in branches():
        (turn,), (last,) = branch.labelled(per.Label.FOLD), branch.labelled(per.Label.GRAZING)
        assert turn.parameter == pytest.approx(fold, abs=1e-9)
        assert last.parameter == pytest.approx(amplitude(phi), abs=1e-5)
        assert abs(last.multipliers[0]) > 1e8
    assert "relay at T - on grazes the threshold at which it switches" in str(branches()[1].stop)


def test_relay_that_does_not_switch() -> None:
    """Assert that an orbit below the threshold ends where it grazes it, the amplitude to 1e-9."""
    system, gain = thermostat(), np.hypot(1.0, TAU)
    branch = per.trace(system, "A", (1.0, 20.0), start=2.0, values={"h": 0.0}, tol=1e-9)
    (last,) = branch.labelled(per.Label.GRAZING)
    assert last.parameter == pytest.approx((1 + BAND) * gain, rel=1e-9)
    assert "relay at T - on grazes" in str(branch.stop)


A3 = np.array([[-1.0, 0.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, -1.0]])
B3, C3 = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


def feedback(x: Any, p: Any) -> dict[str, Any]:
    """1/(s + 1)^3 with a relay in its feedback."""
    return {"a": F.relay(x.c, p.eps, -p.eps, low=1, high=-1) - x.a, "b": x.a - x.b, "c": x.b - x.c}


def limit_cycle(eps: float) -> tuple[float, Any]:
    """omega and multipliers of the cycle that repeats with the other sign after half a period h.

    With u = -1 from x(0) = -x(h) on: x(h) = -(1 + e^{Ah})^-1 int_0^h e^{As} b ds, and c x(h) = -eps
    (Tsypkin; Astrom, Oscillations in systems with relay feedback, 1995).
    """

    def last(h: float) -> Any:
        carried = expm(A3 * h)
        pushed = np.linalg.solve(A3, (carried - np.eye(3)) @ B3)
        return -np.linalg.solve(np.eye(3) + carried, pushed), carried

    h = brentq(lambda h: float(C3 @ last(h)[0]) + eps, 0.3, 20.0, xtol=1e-15)
    x, carried = last(h)
    before, after = A3 @ x - B3, A3 @ x + B3
    half = (np.eye(3) + np.outer(after - before, C3) / (C3 @ before)) @ carried
    return np.pi / h, np.linalg.eigvals(half) ** 2


def test_relay_feedback() -> None:
    """Assert frequency and multipliers of limit cycles to 1e-9 at every point over the hysteresis."""
    system = sym.compile(sym.Equations(feedback, {"a": 0.0, "b": 0.0, "c": 0.0}, {"eps": 0.1}))
    motion = sym.simulate(system, settle=5, periods=2, samples=1000)
    begin, end = [event.phase for event in motion.events if event.after == PLUS][-2:]
    times = np.linspace(begin, end, 300)
    state = {n: np.interp(times, motion.phase, motion[n]) for n in "abc"}
    given = {"omega": 2 * np.pi / (end - begin)}
    guess = per.sampled(times=times - begin, state=state, parameter=given, system=system)
    conditions = {"omega": per.PhaseCondition()}
    branch = per.trace(system, "eps", (1e-4, 0.6), guess=guess, determined=conditions, tol=1e-9)
    assert "upper end" in str(branch.stop) and branch[0].parameter == 1e-4
    for point in branch:
        omega, multipliers = limit_cycle(point.parameter)
        assert point.orbit.parameter[-1] == pytest.approx(omega, abs=1e-9)
        np.testing.assert_allclose(in_order(point.multipliers), in_order(multipliers), atol=1e-9)


def bistable() -> sym.CompiledSystem:
    """x'' + 0.1 x' + x = r/2 + F cos w t: about 0 or about 1/2, as the relay has it."""
    x = sym.coordinate("x")
    machine = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 0.1) + sym.HarmonicForce(x, 0.1, 0.5)
    push = sym.Equations(
        lambda x, p: {"x": p.push * F.relay(x.x, 0.8, -0.3)}, {}, {"push": 0.5}, coordinates=[x]
    )
    return sym.compile(machine + push)


def test_relay_that_remembers(tmp_path: Path) -> None:
    """Assert two orbits at one force, each in its mode all along, to 1e-9; in files too; and where they end.

    One ends where x rises to 0.8, the other where it falls to -0.3: of amplitude 0.8 both.
    """
    system, gain = bistable(), 1 / abs(1 - 0.25 + 0.05j)
    for knock, mode, middle in (({}, MINUS, 0.0), ({"x": 1.0}, PLUS, 0.5)):
        motion = sym.simulate(system, knock=knock, settle=6)
        assert motion.modes == (mode,)
        given = motion.phase, motion.state, motion.algebraic, motion.parameter
        guess = per.sampled(*given, system=system, modes=motion.modes)
        branch = per.trace(system, "F", (0.05, 2.0), guess=guess, tol=1e-9)
        phase = np.linspace(0, 6, 20)
        for point in (branch[1], branch[-1]):
            amplitude = point.maximum["x"] - middle
            assert amplitude == pytest.approx(gain * point.parameter, abs=1e-9)
        assert branch[-1].parameter == pytest.approx(0.8 / gain, abs=1e-9)
        assert "grazes the threshold at which it would switch" in str(branch.stop)
        path = tmp_path / "branch.npz"
        branch.save(path)
        again = per.Branch.load(path)
        assert again[1].orbit.mesh.modes == branch[1].orbit.mesh.modes == ((0, mode),)
        np.testing.assert_array_equal(again[1].orbit.state(phase), branch[1].orbit.state(phase))
        onward = per.trace(system, "F", (0.05, 0.3), guess=again[1].orbit, tol=1e-9)
        assert onward[-1].maximum["x"] - middle == pytest.approx(gain * onward[-1].parameter, abs=1e-9)


GAP, STIFF, DRY, LOST = 1.0, 3.0, 0.1, 0.8


def beside(other: str) -> sym.CompiledSystem:
    """An oscillator that a relay pushes on as x has gone, with a stop, dry friction or a wall besides."""
    x = sym.coordinate("x", scale=1.0)
    more = {
        "stop": sym.Equations(lambda x, p: {"x": -STIFF * F.fmax(x.x - GAP, 0)}, {}, coordinates=[x]),
        "friction": sym.CoulombFriction(x, DRY),
        "wall": sym.RigidStop(x, GAP, LOST),
    }[other]
    push = sym.Equations(lambda x, p: {"x": 0.3 * F.relay(x.x, 0.5, -0.5, -1)}, {}, coordinates=[x])
    machine = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 0.2) + sym.HarmonicForce(x, 1.0, 0.7)
    return sym.compile(machine + push + more)


class Piece(NamedTuple):
    """A motion between two events: where it begins, the relay's mode, the side of friction, past the stop."""

    start: float
    relay: int
    side: int
    past: bool


def followed(other: str, force: float, t: float, begin: Any, relay: int) -> tuple[Any, list[str]]:
    """(x, dx/dtau) 2 pi later and what happened, event by event; friction is on the side of the speed."""
    w, last, y, names = 0.7, t + 2 * np.pi, np.array(begin), []
    slip, past = int(np.sign(y[1])), other == "stop" and y[0] > GAP

    def pull(t: float, y: Any, relay: int, past: bool) -> float:
        stop = STIFF * (y[0] - GAP) if past else 0.0
        return float(force * np.cos(t) + 0.3 * relay - y[0] - 0.2 * w * y[1] - stop)

    def rates(t: float, y: Any, at: Piece) -> list[float]:
        dry = DRY * at.side if other == "friction" else 0.0
        stuck = other == "friction" and at.side == 0
        return [y[1], 0.0 if stuck else (pull(t, y, at.relay, at.past) - dry) / w**2]

    def switches(t: float, y: Any, at: Piece) -> float:
        return float(at.relay * (y[0] + 0.5 * at.relay))

    def turns(t: float, y: Any, at: Piece) -> float:
        if other != "friction":
            return 1.0
        if at.side == 0:
            return DRY - abs(pull(t, y, at.relay, at.past))
        return float(at.side * y[1]) if t > at.start + 1e-6 else 1.0

    def hits(t: float, y: Any, at: Piece) -> float:
        return GAP - y[0] if other == "wall" and t > at.start + 1e-6 else 1.0

    def bends(t: float, y: Any, at: Piece) -> float:
        ahead = y[0] - GAP if at.past else GAP - y[0]
        return float(ahead) if other == "stop" and t > at.start + 1e-6 else 1.0

    events = [switches, turns, hits, bends]
    for event in events:
        event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
    while True:
        tight = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "max_step": 0.05}
        at = Piece(t, relay, slip, past)
        found = solve_ivp(rates, (t, last), y, events=events, args=(at,), **tight)
        t, y = float(found.t[-1]), found.y[:, -1]
        if found.status == 0:
            return y, names
        (which,) = (k for k, times in enumerate(found.t_events) if len(times))
        names.append(events[which].__name__)
        if which == 0:
            relay = -relay
        elif which == 1:
            y[1] = 0.0
            force_now = pull(t, y, relay, past)
            slip = 0 if slip and abs(force_now) < DRY else int(np.sign(force_now))
        elif which == 2:
            y[1] *= -LOST
        else:
            past = not past


@pytest.mark.parametrize(
    ("other", "least", "happens"),
    [
        ("stop", 0.5, "bends bends switches switches"),
        ("friction", 0.55, "switches switches turns turns"),
        ("wall", 1.5, "hits hits switches switches"),
    ],
)
def test_relay_beside_others(other: str, least: float, happens: str) -> None:
    """Assert orbits to 1e-8 and multipliers to 1e-6 by event-exact integration, and what happens."""
    values = (least + 0.1, 1.75)
    branch = per.trace(beside(other), "F", (least, 1.8), start=1.7, tol=1e-9, at=values)
    points = branch.labelled(per.Label.USER)
    assert "end of the range" in str(branch.stop) and len(points) == len(values)
    for point in points:
        orbit = point.orbit
        j = int(orbit.mesh.segment_lengths(orbit.phases).argmax())
        begin = float(orbit.phases[j] + 0.5 * orbit.mesh.segment_lengths(orbit.phases)[j])
        relays = [
            (phi, e.direction)
            for e, phi in zip(orbit.mesh.events, orbit.phases, strict=True)
            if e.switch == 0
        ]
        before = [mode for phi, mode in relays if phi < begin] or [mode for _, mode in relays]
        y = orbit.state(np.array([begin]))[0]
        later, names = followed(other, point.parameter, begin, y, before[-1])
        np.testing.assert_allclose(later, y, atol=1e-8)
        assert " ".join(sorted(names)) == happens
        step = 1e-5
        at = [y + sign * u for u in np.eye(2) * step for sign in (1, -1)]
        ends = np.array([followed(other, point.parameter, begin, z, before[-1])[0] for z in at])
        multipliers = np.linalg.eigvals((ends[::2] - ends[1::2]).T / (2 * step))
        np.testing.assert_allclose(in_order(point.multipliers), in_order(multipliers), atol=1e-6)


def test_simulated_relay() -> None:
    """Assert when a thermostat switches in time, by exponentials to 1e-9, and that it goes on in its mode."""
    system = thermostat()
    motion = sym.simulate(system, {"A": 0.0}, settle=0, periods=3, tolerance=1e-11)
    first, between = TAU * np.log(2 / 0.8), TAU * np.log(1.2 / 0.8)  # as fast up as down
    found = [event.phase for event in motion.events]
    assert [event.after for event in motion.events] == [PLUS, MINUS, PLUS, MINUS]
    np.testing.assert_allclose(found, first + between * np.arange(4), atol=1e-9)
    onward = sym.simulate(system, {"A": 0.0}, start=motion, settle=0, periods=1, tolerance=1e-11)
    assert onward.events[0].after == PLUS  # it began colder than 1.2, and cooled no more
    np.testing.assert_allclose(onward.events[0].phase + 6 * np.pi, found[-1] + between, atol=1e-9)


def test_what_relays_are_refused_in() -> None:
    """Assert one sentence each for methods blind to relays, and for what is no relay."""
    for method in (per.HarmonicBalance(), per.Shooting()):
        with pytest.raises(ValueError, match="relays"):
            per.trace(thermostat(), "A", (0.1, 1.0), method=method)
    with pytest.raises(ValueError, match="outside of a model's equations"):
        F.relay(0.5, 1.0, 0.0)

    def equations(relay: Any, **more: Any) -> sym.CompiledSystem:
        return sym.compile(sym.Equations(lambda x, p: {"T": relay(x) - x.T}, {"T": 0.0}, **more))

    with pytest.raises(ValueError, match="less than on"):
        equations(lambda x: F.relay(x.T, 0.0, 1.0))
    with pytest.raises(ValueError, match="never switches"):
        equations(lambda x: F.relay(1.0, 0.5, 0.0))
    with pytest.raises(ValueError, match="'heat' depends on a relay"):
        equations(lambda x: 0.0, outputs=lambda x, p: {"heat": F.relay(x.T, 1.0, 0.0)})
