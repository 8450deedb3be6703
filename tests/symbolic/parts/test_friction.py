"""Friction dampers against closed forms: the loop of an elastic slider, and its spring while it sticks."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.kept import kept

import periodic as per
import symbolic as sym
from symbolic.equations.surfaces import Kind

STIFFNESS, LIMIT, PLACE = 0.5, 0.1, 1.15


@kept
def slid() -> per.Branch:
    """The branch of the scene, from above its resonance down into it, where the slider slips."""
    return per.trace(sym.scene("jenkins-damper"), "Omega", (1.1, 1.3), start=1.3, at=PLACE)


def test_loop_is_coulombs() -> None:
    """Assert the work of a cycle, 4 F (X - F/k), and its largest force, to the tolerance."""
    (point,) = slid().labelled(per.Label.USER)
    tau = np.linspace(0, 2 * np.pi, 20001)
    states = point.orbit.state(tau)
    x, force = states[:, 0], STIFFNESS * (states[:, 0] - states[:, 2])
    work = float(np.sum((force[1:] + force[:-1]) / 2 * np.diff(x)))
    assert work == pytest.approx(4 * LIMIT * (np.ptp(x) / 2 - LIMIT / STIFFNESS), rel=1e-5)
    assert np.abs(force).max() == pytest.approx(LIMIT, rel=1e-6)


def test_two_slips_in_a_cycle() -> None:
    """Assert four event nodes: each slip has one where it begins and one where it ends."""
    (point,) = slid().labelled(per.Label.USER)
    assert len(point.orbit.phases) == 4


@pytest.mark.parametrize("start", [0.9, 1.5])
def test_first_slips(start: float) -> None:
    """Assert where the slider begins to slip, and slips no more: the linear response is F/k there.

    To the tolerance, which the place is known to at which the slider is held.
    """
    branch = per.trace(sym.scene("jenkins-damper"), "Omega", (0.9, 1.5), start=start)
    assert branch.stop.reason is per.Reason.BOUND
    found = sorted(p.parameter for p in branch.labelled(per.Label.GRAZING))
    excess = [0.1 / abs(1 + STIFFNESS - w**2 + 0.02j * w) - LIMIT / STIFFNESS for w in found]
    assert len(found) == 2
    assert excess == pytest.approx([0.0, 0.0], abs=1e-6)


def test_stuck_slider_is_a_spring() -> None:
    """Assert the linear response with the slider's spring where it never slips, to ten digits."""
    system = sym.scene("jenkins-damper", {"limit": 100.0})
    first = per.trace(system, "Omega", (2.0, 2.1), start=2.0)[0]
    exact = 2 * 0.1 / abs(1 + STIFFNESS - 4 + 1j * 0.02 * 2)
    assert first.peak_to_peak("x") == pytest.approx(exact, rel=1e-10)


def test_equal_sliders_are_one() -> None:
    """Assert that sliders side by side of equal limits are one of their sum, as they are with creep."""
    q = sym.coordinate("x", unit="")
    parts = [sym.Mass(q, 1.0), sym.Damper(q, 0.02), sym.Spring(q, 1.0), sym.HarmonicForce(q, 0.1, 1.3)]
    several = sym.compile(sym.combine([*parts, sym.Iwan(q, STIFFNESS, (LIMIT / 2, LIMIT / 2))]))
    first = per.trace(several, "Omega", (1.3, 1.4), start=1.3)[0]
    assert first.peak_to_peak("x") == pytest.approx(slid()[0].peak_to_peak("x"), rel=1e-12)
    assert len(several.states) == 3
    creeping = [
        sym.compile(sym.combine([*parts, sym.Iwan(q, STIFFNESS, limits, creep=1e-2)]))
        for limits in ((LIMIT / 2, LIMIT / 2), (LIMIT,))
    ]
    apart, one = (per.trace(s, "Omega", (1.3, 1.4), start=1.3)[0] for s in creeping)
    assert [len(s.states) for s in creeping] == [4, 3]
    assert apart.peak_to_peak("x") == pytest.approx(one.peak_to_peak("x"), rel=1e-12)


def exact(*sliders: Any) -> sym.CompiledSystem:
    """An oscillator with exact sliders."""
    q = sym.coordinate("x")
    parts = [sym.Mass(q, 1.0), sym.Spring(q, 1.0), sym.HarmonicForce(q, 1.0, 1.3)]
    return sym.compile(sym.combine([*parts, *(replace(slider, q=q) for slider in sliders)]))


@pytest.mark.parametrize(("mode", "carried"), [(1, 1.0), (-1, 1.0), (2, 0.0)])
def test_modes_of_an_exact_slider(mode: int, carried: float) -> None:
    """Assert z' = 0 held and z' = u' carried, and f = F and -F at the releases."""
    q = sym.coordinate("x")
    system = exact(sym.Jenkins(q, 2.0, 0.3, creep=None))
    (slider,) = system.surfaces
    assert slider.kind == Kind.SLIDER and slider.releases is not None and slider.column == 0
    state, rate, phase = np.array([[0.4, 0.7, 0.1]]), np.zeros((1, 3)), np.array([0.2])
    rate[0] = 0.7, (np.cos(0.2) - 0.4 - 2.0 * 0.3) / 1.3**2, 0.7 * carried
    at = rate, state, np.zeros((1, 0)), phase, system.nominal
    found = system.linearise_beside(*at, np.array([[float(mode)]]))
    np.testing.assert_allclose(found.residual, 0, atol=1e-15)
    guards = system.switch(state, phase, system.nominal)[0]
    np.testing.assert_allclose(guards[[slider.switch, *slider.releases]], [0.7, 0.15, 0.45], rtol=1e-14)
    assert not system.guards_depend


def test_exact_slider_creeps_where_the_state_decides() -> None:
    """Assert that without given modes the equations are those of the usual creep."""
    q = sym.coordinate("x")
    systems = [exact(sym.Jenkins(q, 2.0, 0.3, creep=creep)) for creep in (None, 1e-2)]
    draw = np.random.default_rng(1)
    rate, state = draw.normal(size=(2, 5, 3))
    rows = [s.residual(rate, state, np.zeros((5, 0)), np.zeros(5), s.nominal) for s in systems]
    np.testing.assert_allclose(rows[0], rows[1], rtol=1e-14)


def test_unequal_sliders_side_by_side() -> None:
    """Assert that Iwan's sliders of own stiffnesses are those of as many parts, whatever they are called."""
    q = sym.coordinate("x")
    together = exact(sym.Iwan(q, (2.0, 1.0), (0.3, 0.1), creep=None))
    apart = exact(*(sym.Jenkins(q, k, limit, creep=None) for k, limit in ((2.0, 0.3), (1.0, 0.1))))
    assert [v.name for v in apart.states[2:]] == ["z of x", "z of x (2)"]
    assert len(together.surfaces) == len(apart.surfaces) == 2
    rate, state = np.random.default_rng(1).normal(size=(2, 5, 4))
    for side in (np.zeros((5, 2)), np.tile([2.0, 1.0], (5, 1))):
        found = [
            s.linearise_beside(rate, state, np.zeros((5, 0)), np.zeros(5), s.nominal, side).residual
            for s in (together, apart)
        ]
        np.testing.assert_allclose(found[0], found[1], rtol=1e-14)
    with pytest.raises(ValueError, match="one for each of the 2 limits"):
        sym.Iwan(q, (1.0, 2.0, 3.0), (0.1, 0.2))


def test_two_frictions_of_one_speed() -> None:
    """Assert that they are one surface, which sticks up to the sum of both."""
    q = sym.coordinate("x")
    system = exact(sym.CoulombFriction(q, 0.3), sym.CoulombFriction(q, 0.2))
    (surface,) = system.surfaces
    assert surface.kind == Kind.SLIDING and surface.releases is not None
    up, down = system.switch(np.zeros((1, 2)), np.array([np.pi / 2]), system.nominal)[0, [1, 2]]
    assert (up, down) == pytest.approx((-0.5 / 1.3**2, 0.5 / 1.3**2))


def pressed(part: type[sym.CoulombFriction] | type[sym.Jenkins]) -> sym.CompiledSystem:
    """Friction of x under a load that a second coordinate varies and takes away; the slider is exact."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    load = sym.NormalLoad(y, coefficient=0.9, stiffness=2.0, preload=0.3)
    slider = sym.Jenkins(x, 4.0, load, creep=None)
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Mass(y, 1.0), sym.Spring(y, 2.0), sym.Damper(y, 0.1)]
    parts += [slider if part is sym.Jenkins else sym.CoulombFriction(x, load), sym.Damper(x, 0.1)]
    parts += [sym.HarmonicForce(x, 0.4, 0.9), sym.HarmonicForce(y, 1.0, 0.9, phase=1.0)]
    return sym.compile(sym.combine(parts))


def test_friction_under_a_load_that_moves() -> None:
    """Assert where it sticks: up to mu max(N0 + k y, 0), and nowhere when it is lifted off."""
    system = pressed(sym.CoulombFriction)
    state, phase, p = np.array([[0.1, 0.0, 0.2, 0.3], [0.1, 0.0, -0.2, 0.3]]), np.zeros(2), system.nominal
    (surface,) = (s for s in system.surfaces if s.kind == Kind.SLIDING)
    up, down = system.switch(state, phase, p)[:, surface.releases].T * 0.9**2
    limit = 0.9 * np.array([0.7, 0.0])
    np.testing.assert_allclose([up, down], [0.3 - limit, 0.3 + limit], rtol=1e-14)


@pytest.mark.parametrize("part", [sym.CoulombFriction, sym.Jenkins])
def test_motion_under_a_load_that_moves(part: Any) -> None:
    """Assert Coulomb's law along a motion: the force within the limit, and on it against what slips."""
    system = pressed(part)
    motion = sym.simulate(system, settle=3, samples=4000, tolerance=1e-9)
    limit = 0.9 * np.maximum(0.3 + 2.0 * motion["y"], 0.0)
    assert (limit == 0).any() and limit.max() > 0.5
    if part is sym.Jenkins:
        force = motion["force of z of x"]
        assert (np.abs(force) <= limit + 1e-7).all() and (np.abs(force) < limit - 1e-3).any()
        inside = np.abs(force) < limit - 1e-3
        carried = np.abs(np.diff(motion["z of x"]))
        assert carried[inside[1:] & inside[:-1]].max() < 1e-9 < carried.max()
    else:
        sliding = [e.after for e in motion.events if system.surfaces[e.surface].kind == Kind.SLIDING]
        assert {*sliding} == {-1, 1, 2}
        assert (np.abs(motion["x'"][limit == 0]) > 1e-9).mean() > 0.9


def test_switches_of_joints_by_name() -> None:
    """Assert guards, releases and departures of friction, a slider and a wall, with the ways of each."""
    x = sym.coordinate("x")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 1.0) + sym.ConstantForce(x, 2.0)
    joints = model + sym.CoulombFriction(x, 0.5) + sym.Jenkins(x, 1.0, 0.2, creep=None)
    found = [(switch.name, switch.direction) for switch in sym.compile(joints).switches]
    slips = [
        (f"{name}: slips {way}", d)
        for name in ("z of x", "dx/dt = 0")
        for way, d in (("up", 1), ("down", -1))
    ]
    assert sorted(found) == sorted([("dx/dt = 0", 0), ("z of x: strained", 0), *slips])
    wall = sym.compile(model + sym.RigidStop(x, 1.0, 0.5)).switches
    names = [(switch.name, switch.direction) for switch in wall]
    assert names == [("impact at x = gap", -1), ("impact at x = gap: leaves", 1)]


def test_sliders_between_the_same_places_have_names_of_their_own() -> None:
    """Assert the state z of its places, of its part's name, or with a number."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    base = sym.Mass(x, 1.0) + sym.Mass(y, 1.0) + sym.Spring(x, 1.0) + sym.Spring(y, 1.0)
    sliders = [sym.Jenkins(x, k, 0.2, to=y) for k in (1.0, 2.0, 3.0)]

    def names(*sliders: sym.Part) -> list[str]:
        model = base + sym.HarmonicForce(x, 1.0)
        for slider in sliders:
            model = model + slider
        return [state.name for state in sym.compile(model).states if state.name.startswith("z")]

    first, second, third = sliders
    assert names(first, second, third) == ["z of x - y", "z of x - y (2)", "z of x - y (3)"]
    outer = second.named("outer"), third.named("outer")
    assert names(first, *outer) == ["z of x - y", "z of outer", "z of x - y (2)"]


@pytest.mark.parametrize("scale", [1.0, 0.25])
def test_creeping_slider_by_hand(scale: float) -> None:
    """Assert its force, its switches in its own units of length, and the row of its creep."""
    x, k, limit, creep = sym.coordinate("x", scale=scale), 4.0, 0.6, 0.02
    parts = [sym.Mass(x, 1.0), sym.Jenkins(x, k, limit, creep=creep), sym.HarmonicForce(x, 1.0, 2.0)]
    system = sym.compile(sym.combine(parts))
    names = [state.name for state in system.states]
    (place,) = (j for j, name in enumerate(names) if name.startswith("z"))
    state = np.zeros((5, len(names)))
    state[:, names.index("x")] = elongation = np.array([0.0, 0.1, 0.2, 0.9, -0.9])
    rate, phase = np.zeros_like(state), np.zeros(5)
    force = k * scale * elongation
    outputs = system.output(rate, state, np.zeros((5, 0)), phase, system.nominal)
    named = {output.name: outputs[:, j] for j, output in enumerate(system.outputs)}
    (shown,) = (values for name, values in named.items() if name.startswith("force of"))
    assert shown == pytest.approx(force)
    switches = system.switch(state, phase, system.nominal)
    names = [switch.name.rpartition(": ")[2] for switch in system.switches]
    for name, sign in (("f = F", -1.0), ("f = -F", 1.0)):
        assert switches[:, names.index(name)] == pytest.approx((force + sign * limit) / (k * scale))
    over = np.sign(force) * np.maximum(np.abs(force) - limit, 0.0)
    rows = [
        system.residual(each, state, np.zeros((5, 0)), phase, system.nominal) for each in (rate, rate + 1.0)
    ]
    turned = np.abs(rows[1] - rows[0]).max(axis=0)
    (own,) = np.flatnonzero(np.isclose(turned, creep))
    leak = creep * 1e-4 * force / k
    assert rows[0][:, own] == pytest.approx(-(leak + over / k) / scale, abs=1e-12)
    assert place == 2


@pytest.mark.parametrize(
    ("stiffness", "limits", "found"),
    [
        (8.0, (0.3, 0.3, 0.9), [(8.0 * 2 / 3, 0.6), (8.0 / 3, 0.9)]),
        ((1.0, 2.0, 4.0), (0.3, 0.6, 0.9), [(3.0, 0.9), (4.0, 0.9)]),
        ((1.0, 2.0), (0.3, 0.3), [(1.0, 0.3), (2.0, 0.3)]),
    ],
)
def test_iwan_joins_sliders(stiffness: Any, limits: tuple[float, ...], found: Any) -> None:
    """Assert stiffness and limit of each slider that is left, of those that slip at one elongation."""
    x = sym.coordinate("x")
    system = exact(sym.Iwan(x, stiffness, limits, creep=None))
    state = np.zeros((1, len(system.states)))
    state[0, [s.name for s in system.states].index("x")] = 0.01
    outputs = system.output(np.zeros_like(state), state, np.zeros((1, 0)), np.zeros(1), system.nominal)
    forces = [v for v, o in zip(outputs[0], system.outputs, strict=True) if o.name.startswith("force of")]
    assert forces == pytest.approx([0.01 * k for k, _ in found])
    values = {p.name: p.value for p in system.parameters}
    assert sum(v for name, v in values.items() if name.startswith("F_slider")) == pytest.approx(sum(limits))
    assert sorted(v for name, v in values.items() if name.startswith("F_slider")) == pytest.approx(
        sorted(limit for _, limit in found)
    )


@pytest.mark.parametrize("scale", [1.0, 0.25])
def test_exact_slider_in_units_of_its_coordinate(scale: float) -> None:
    """Assert rows and switches held, carried up and down, whatever the coordinate is measured in."""
    q = sym.coordinate("x", scale=scale)
    parts = [sym.Mass(q, 1.0), sym.Spring(q, 1.0), sym.HarmonicForce(q, 1.0, 1.3)]
    system = sym.compile(sym.combine([*parts, sym.Jenkins(q, 2.0, 0.3, creep=None)]))
    (slider,) = system.surfaces
    state, phase = np.array([[0.4, 0.7, 0.1]]) / scale, np.array([0.2])
    guards = system.switch(state, phase, system.nominal)[0]
    assert slider.releases is not None
    up, down = slider.releases
    assert guards[[slider.switch, up, down]] * scale == pytest.approx([0.7, 0.3 - 0.15, 0.3 + 0.15])
    for mode, carried in ((1, 1.0), (-1, 1.0), (2, 0.0)):
        for moving in (0.7, 0.2):
            rate = np.array([[0.7, 0.0, moving * carried]]) / scale
            given = rate, state, np.zeros((1, 0)), phase, system.nominal
            rows = system.linearise_beside(*given, np.array([[float(mode)]])).residual[0]
            wrong = 0.0 if mode == 2 else moving - 0.7
            assert np.abs(rows * scale - wrong).min() == pytest.approx(0.0, abs=1e-12)
        slow = np.array([[0.7, 0.0, 0.05]]) / scale
        found = system.linearise_beside(slow, *given[1:], np.array([[float(mode)]])).residual[0]
        wrong = 0.05 if mode == 2 else 0.05 - 0.7
        assert np.isclose(found * scale, wrong).any()
