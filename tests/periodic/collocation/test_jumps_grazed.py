"""Jumps of the equations that an orbit grazes: contacts that begin with a jump, or turn to another law."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from reference.closer import closer
from reference.contact import Contact, Stop, period, periodic
from reference.hybrid import Hybrid, Surface, motion, periodic_orbit
from reference.integration import Array
from support.kept import kept

import periodic as per
import symbolic as sym

GAP, FORCE, DAMPING = 0.3, 0.4, 0.05
LAWS = {"damped": (20.0, 0.8, 0.0, 0.0), "preloaded": (0.0, 0.0, 1.0, 0.0), "loading": (20.0, 0.0, 0.0, 0.1)}
"""Stiffness k, damping c, preload F, and the part e of k that is lost on the way back.

The contact's force, where d = x - g > 0, is k d (1 + e sign v) + c v + F.
"""


def grazed() -> float:
    """Omega at which x'' + .05 x' + x = .4 cos Omega t, above its resonance, has the amplitude g."""
    square = np.roots([1.0, DAMPING**2 - 2, 1 - (FORCE / GAP) ** 2])
    return float(np.sqrt(square.real.max()))


@kept
def traced(law: str, bounds: tuple[float, float]) -> tuple[int, per.Branch]:
    """The index of the depth's switch, and the branch of x'' + .05 x' + x + the contact = .4 cos Omega t."""
    k, c, preload, lost = LAWS[law]
    f = sym.functions

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        depth = x.x - GAP
        if lost:
            contact = k * f.fmax(depth, 0) * (1 + lost * f.sign(x.v))
        else:
            contact = f.if_else(depth > 0, k * depth + c * x.v + preload, 0)
        return {"x": x.v, "v": FORCE * wave.cos - DAMPING * x.v - x.x - contact}

    equations = sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"Omega": 1.0}, frequency="Omega")
    system = sym.compile(equations)
    (depth,) = (k for k, switch in enumerate(system.switches) if switch.name.startswith("x"))
    return depth, per.trace(system, "Omega", bounds)


def exact(law: str, Omega: float, begin: float) -> Hybrid:
    """The same in tau, from a phase on; the signs are those of the depth and of the speed."""
    k, c, preload, lost = LAWS[law]

    def rates(t: float, y: Array, signs: tuple[float, ...]) -> list[float]:
        contact = k * (y[0] - GAP) * (1 + lost * signs[1]) + c * y[1] + preload if signs[0] > 0 else 0.0
        return [y[1] / Omega, (FORCE * np.cos(begin + t) - DAMPING * y[1] - y[0] - contact) / Omega]

    def jacobian(t: float, y: Array, signs: tuple[float, ...]) -> Array:
        stiff, damps = (k * (1 + lost * signs[1]), c) if signs[0] > 0 else (0.0, 0.0)
        return np.array([[0, 1], [-1 - stiff, -DAMPING - damps]]) / Omega

    depth = Surface(lambda t, y: y[0] - GAP, lambda t, y: (0.0, np.array([1.0, 0.0])))
    speed = Surface(lambda t, y: y[1], lambda t, y: (0.0, np.array([0.0, 1.0])))
    return Hybrid(rates, jacobian, [depth, speed])


def in_pieces(law: str) -> Contact:
    """The same where all is linear but for the contact, in closed form."""
    k, c, preload, _ = LAWS[law]
    free = np.array([[0.0, 1.0], [-1.0, -DAMPING]])
    row, force = np.array([1.0, 0, -GAP, 0, 0]), np.array([k, c, preload - k * GAP, 0, 0])
    contact = Stop(row, np.array([0.0, -1, 0, 0, 0]), force)
    return Contact(free, np.zeros(2), np.array([0.0, FORCE]), [contact])


def followed(law: str, Omega: float, begin: float, state: Array) -> tuple[Array, Array]:
    """The periodic orbit beside a state and its monodromy matrix; beside a fold those of the state itself."""
    if LAWS[law][-1]:
        system = exact(law, Omega, begin)
        shot = motion(system, state)
        beside = np.abs(shot.multipliers - 1).min() < BESIDE
        shot = shot if beside else periodic_orbit(system, state)
        assert shot.end == pytest.approx(shot.start, abs=2e-7)
        return shot.start, shot.monodromy
    pieces = in_pieces(law)
    found = period(pieces, Omega, state, begin)
    if np.abs(found.multipliers - 1).min() > BESIDE:
        found = closer(pieces, Omega, periodic(pieces, Omega, state, begin), begin)
    assert found.end == pytest.approx(found.start, abs=2e-7)
    return found.start, found.monodromy


def within(depth: int, point: per.Point) -> float | None:
    """A phase within the one contact of an orbit, before its speed is 0; None if there is none."""
    each = zip(point.orbit.mesh.events, point.orbit.phases, strict=True)
    ends = {event.direction: float(phase) for event, phase in each if event.switch == depth}
    return ends[1] + 0.3 * ((ends[-1] - ends[1]) % (2 * np.pi)) if ends else None


BESIDE = 1e-1
"""Multipliers nearer to 1 are those of the orbit as it is: beside a fold none is found at its parameter."""

BOUNDS = pytest.mark.parametrize("bounds", [(1.8, 1.45), (1.45, 1.8)], ids=["down", "up"])


@BOUNDS
@pytest.mark.parametrize("law", LAWS)
def test_grazing_of_a_jump_is_located(law: str, bounds: tuple[float, float]) -> None:
    """Assert that the branch passes grazing to its bound, and has it as GR where it is in closed form."""
    _, branch = traced(law, bounds)
    assert branch.stop.reason is per.Reason.BOUND
    (grazing,) = branch.labelled(per.Label.GRAZING)
    assert grazing.parameter == pytest.approx(grazed(), abs=1e-7)


@BOUNDS
@pytest.mark.parametrize("law", LAWS)
def test_every_contact_that_jumps_is_followed(law: str, bounds: tuple[float, float]) -> None:
    """Assert orbits and multipliers against event-exact shooting, and that no contact is left out."""
    depth, branch = traced(law, bounds)
    beside = [point for point in branch if abs(point.parameter - grazed()) < BESIDE / 1000]
    assert len(beside) > 1
    for point in {id(point): point for point in (*beside, *branch[::3])}.values():
        begin = within(depth, point)
        if begin is None:
            tau = np.linspace(0, 2 * np.pi, 20001)
            assert point.orbit["x"](tau / point.parameter).max() < GAP + 1e-7
            continue
        state = np.array([point.orbit[name](begin / point.parameter) for name in ("x", "v")])
        start, monodromy = followed(law, point.parameter, begin, state)
        assert state == pytest.approx(start, abs=2e-7)
        trace = np.trace(monodromy)
        assert point.error.multiplier < 1e-5
        known = 1e-7 + 1.5 * point.error.multiplier
        assert point.multipliers.sum().real == pytest.approx(trace, rel=known, abs=known)


def test_force_that_vanishes_in_flight() -> None:
    """Assert that max(0, k d (1 + c v)) with d = max(0, x - g) is traced as k d max(0, 1 + c v) is."""
    f, k, c = sym.functions, 20.0, 0.8

    def traced(contact: Callable[[Any], Any]) -> per.Branch:
        def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
            return {"x": x.v, "v": FORCE * wave.cos - DAMPING * x.v - x.x - contact(x)}

        equations = sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"Omega": 1.0}, frequency="Omega")
        return per.trace(sym.compile(equations), "Omega", (0.4, 0.5))

    nested = traced(lambda x: f.fmax(0, k * f.fmax(x.x - GAP, 0) * (1 + c * x.v)))
    plain = traced(lambda x: k * f.fmax(x.x - GAP, 0) * f.fmax(0, 1 + c * x.v))
    labels = [[p.label for p in branch.special_points] for branch in (nested, plain)]
    assert labels[0] == labels[1]
    assert per.Label.GRAZING in labels[0]
    places = [[p.parameter for p in branch.special_points] for branch in (nested, plain)]
    assert places[0] == pytest.approx(places[1], abs=1e-9)


@pytest.mark.parametrize("tol", [1e-4, 1e-8])
@BOUNDS
def test_both_sides_are_grazed_at_once(bounds: tuple[float, float], tol: float) -> None:
    """Assert grazing of a spring that jumps on both sides: a fold above the resonance, a branch point below.

    Beyond the latter an odd number of multipliers is outside the circle while the branch goes on: orbits that
    graze one side alone leave there.
    """
    f = sym.functions

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        jumping = f.if_else(f.fabs(x.x) > 0.5, 2 * x.x, 0)
        return {"x": x.v, "v": 0.3 * wave.cos - 0.1 * x.v - x.x - jumping}

    system = sym.compile(sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"Omega": 1.0}, frequency="Omega"))
    begin = 0.55 if bounds[0] > bounds[1] else 2.0
    branch = per.trace(system, "Omega", (0.55, 2.0), start=begin, tol=tol)
    assert branch.stop.reason is per.Reason.BOUND
    assert branch.unaccounted == ()
    square = np.sqrt(np.roots([1.0, 0.1**2 - 2, 1 - (0.3 / 0.5) ** 2]).real)
    labels = {p.label: [q.parameter for q in branch.labelled(p.label)] for p in branch.special_points}
    below, above = sorted(square)
    assert sorted(labels[per.Label.GRAZING]) == pytest.approx([below, above], abs=1e-6)
    assert min(labels[per.Label.BRANCH]) == pytest.approx(below, abs=1e-6)
    assert len(labels[per.Label.FOLD]) == 2
    assert min(labels[per.Label.FOLD]) == pytest.approx(above, abs=1e-6)
    assert per.Label.TORUS not in labels
