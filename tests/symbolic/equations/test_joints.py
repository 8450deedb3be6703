"""Tests of coupled friction joints: equations and guards in every mode against a solve by hand."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest

import symbolic as sym
from symbolic.arrays import Array
from symbolic.equations.surfaces import STUCK, Kind
from symbolic.integration.flow import Flow, Trajectory
from symbolic.system.compiled import with_values

MASSES, SPRINGS, LIMITS, OMEGA, FORCE = (1.3, 0.7), (1.0, 2.0), (0.4, 0.25), 1.7, 1.1
WAYS = np.array([[1.0, 0.0], [-1.0, 1.0]])
"""Rows: the sliding speeds, x' to the ground and y' - x', in the two speeds."""


def joints(kernels: str | None = None, **more: Any) -> sym.CompiledSystem:
    """Two masses, one with a joint to the ground, and a joint between them."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    parts = [sym.Mass(x, MASSES[0]), sym.Mass(y, MASSES[1])]
    parts += [sym.Spring(x, SPRINGS[0]), sym.Spring(y, SPRINGS[1])]
    parts += [sym.CoulombFriction(x, LIMITS[0]), sym.CoulombFriction(y, LIMITS[1], to=x)]
    parts += [sym.HarmonicForce(y, FORCE, sym.parameter("Omega", OMEGA, "rad/s"))]
    return sym.compile(sym.combine(parts), kernels, **more)


def by_hand(
    state: Array, phase: float, modes: tuple[int, ...], free: int | None = None
) -> tuple[Array, Array]:
    """Accelerations d2/dtau2 and the friction factors: slips as given, what sticks solved for.

    State: x, x', y, y'. The joint `free` slips though it should stick.
    """
    inertia = np.diag(MASSES)
    load = -np.array(SPRINGS) * state[[0, 2]] + np.array([0.0, FORCE * np.cos(phase)])
    matrix, right = np.zeros((4, 4)), np.zeros(4)
    matrix[:2, :2], matrix[:2, 2:] = inertia * OMEGA**2, WAYS.T * LIMITS
    right[:2] = load
    for i, mode in enumerate(modes):
        if mode == STUCK and i != free:
            matrix[2 + i, :2] = WAYS[i]
        else:
            speed = (WAYS @ state[[1, 3]])[i]
            matrix[2 + i, 2 + i], right[2 + i] = 1.0, np.sign(speed) if mode == 0 else mode
    solved = np.linalg.solve(matrix, right)
    return solved[:2], solved[2:]


@pytest.mark.parametrize("kernels", ["numpy", "c"])
@pytest.mark.parametrize("modes", list(product((1, -1, STUCK, 0), repeat=2)))
def test_every_mode(modes: tuple[int, int], kernels: str) -> None:
    """Assert the accelerations and both releases of both joints, whatever the modes of the two."""
    system, draw = joints(kernels), np.random.default_rng(3)
    assert [s.kind for s in system.surfaces] == [Kind.SLIDING, Kind.SLIDING] and system.guards_depend
    state, phase = draw.normal(size=(5, 4)), draw.uniform(0, 6, 5)
    side, none = np.tile(np.array(modes, dtype=float), (5, 1)), np.zeros((5, 0))
    rate = np.zeros((5, 4))
    rate[:, [0, 2]] = state[:, [1, 3]]
    for k in range(5):
        rate[k, [1, 3]] = by_hand(state[k], phase[k], modes)[0]
    found = system.linearise_beside(rate, state, none, phase, system.nominal, side)
    np.testing.assert_allclose(found.residual, 0, atol=1e-13)
    guards = system.switch(state, phase, system.nominal, side)
    for i, surface in enumerate(system.surfaces):
        assert surface.releases is not None and surface.column == i
        np.testing.assert_allclose(guards[:, surface.switch], state[:, [1, 3]] @ WAYS[i], atol=1e-14)
        for release, way in zip(surface.releases, (1, -1), strict=True):
            given = tuple(way if j == i else mode for j, mode in enumerate(modes))
            expected = [WAYS[i] @ by_hand(x, tau, given)[0] for x, tau in zip(state, phase, strict=True)]
            np.testing.assert_allclose(guards[:, release], expected, rtol=1e-12, atol=1e-13)


def test_guards_where_the_state_decides() -> None:
    """Assert that without sides the guards are those of sides 0, and their derivatives those of all sides."""
    system, draw = joints(), np.random.default_rng(5)
    state, phase, p = draw.normal(size=(4, 4)), draw.uniform(0, 6, 4), system.nominal
    np.testing.assert_array_equal(
        system.switch(state, phase, p), system.switch(state, phase, p, np.zeros((4, 2)))
    )
    side, step = np.tile([STUCK, 1.0], (4, 1)), 1e-6
    by_state, by_phase, by_parameter = system.switch_gradient(state, phase, p, side)
    for k in range(4):
        up, down = state + step * np.eye(4)[k], state - step * np.eye(4)[k]
        slope = (system.switch(up, phase, p, side) - system.switch(down, phase, p, side)) / (2 * step)
        np.testing.assert_allclose(by_state[:, :, k], slope, atol=1e-8)
    slope = (system.switch(state, phase + step, p, side) - system.switch(state, phase - step, p, side)) / (
        2 * step
    )
    np.testing.assert_allclose(by_phase, slope, atol=1e-8)
    for k, value in enumerate(p):
        by = step * (value or 1.0)
        more, less = (p + way * by * np.eye(len(p))[k] for way in (1, -1))
        slope = (system.switch(state, phase, more, side) - system.switch(state, phase, less, side)) / (2 * by)
        np.testing.assert_allclose(by_parameter[:, :, k], slope, atol=1e-7)


def test_joints_that_know_nothing_of_each_other() -> None:
    """Assert that the guards of joints on masses that share nothing take no sides."""
    x, y = sym.coordinates("x", 2)
    parts: list[sym.Part] = [sym.HarmonicForce(x, 1.0, 1.3), sym.Coupling(x, y, 1.0)]
    for q in (x, y):
        parts += [sym.Mass(q, 1.0), sym.Spring(q, 1.0), sym.CoulombFriction(q, 0.2)]
    system = sym.compile(sym.combine(parts))
    assert [s.kind for s in system.surfaces] == [Kind.SLIDING, Kind.SLIDING] and not system.guards_depend


def test_load_that_vanishes() -> None:
    """Assert that friction under a load max(N, 0) sticks where it is pressed, and slips where it is not."""
    F = sym.functions

    def rows(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": p.F * wave.cos - x.x - p.mu * F.fmax(1 + 2 * x.x, 0) * F.sign(x.v)}

    given = {"F": 0.3, "w": 1.0, "mu": 0.5}
    system = sym.compile(sym.Equations(rows, {"x": 0.0, "v": 0.0}, given, frequency="w"))
    load, sliding = system.surfaces
    assert (sliding.kind, load.kind) == (Kind.SLIDING, Kind.KINK) and sliding.releases is not None
    states, phase = np.array([[0.1, 0.0], [-0.7, 0.0]]), np.array([0.4, 0.4])
    push = 0.3 * np.cos(phase) - states[:, 0]
    friction = 0.5 * np.maximum(1 + 2 * states[:, 0], 0)
    guards = system.switch(states, phase, system.nominal)[:, list(sliding.releases)]
    np.testing.assert_allclose(guards, np.array([push - friction, push + friction]).T, rtol=1e-14)
    stuck = system.linearise_beside(
        np.zeros((1, 2)), states[:1], np.zeros((1, 0)), phase[:1], system.nominal, np.full((1, 1), 2.0)
    )
    np.testing.assert_allclose(stuck.residual, 0, atol=1e-15)


def test_signs_that_multiply_each_other() -> None:
    """Assert that jumps whose forces are no sums, one for each, are jumps and no more."""
    F = sym.functions

    def rows(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        both = 0.1 * F.sign(x.v) * F.sign(x.u)
        one, other = wave.cos - x.x - 0.5 * F.sign(x.v), wave.sin - x.y - 0.5 * F.sign(x.u)
        return {"x": x.v, "v": one - both, "y": x.u, "u": other - both}

    states = {"x": 0.0, "v": 0.0, "y": 0.0, "u": 0.0}
    system = sym.compile(sym.Equations(rows, states, {"w": 1.0}, frequency="w"))
    assert [s.kind for s in system.surfaces] == [Kind.JUMP, Kind.JUMP]


def test_branches_by_conditions() -> None:
    """Assert that friction written with conditions has the guards and the sliding of that with signs."""
    F = sym.functions

    def signs(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {
            "x": x.v,
            "v": p.F * wave.cos - x.x - p.mu * F.sign(x.v),
            "u": wave.sin - x.u - F.sign(x.u - x.v),
        }

    def conditions(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        one, other = F.if_else(x.v > 0, p.mu, -p.mu), F.if_else(x.u < x.v, -1, 1)
        return {"x": x.v, "v": p.F * wave.cos - x.x - one, "u": wave.sin - x.u - other}

    given, names = {"F": 0.3, "w": 1.0, "mu": 0.5}, {"x": 0.0, "v": 0.0, "u": 0.0}
    one, other = (sym.compile(sym.Equations(f, names, given, frequency="w")) for f in (signs, conditions))
    draw = np.random.default_rng(1)
    rate, state = draw.normal(size=(2, 6, 3))
    for modes in product((1, -1, STUCK), repeat=2):
        side = np.tile(np.array(modes, dtype=float), (6, 1))
        at = rate, state, np.zeros((6, 0)), np.zeros(6), one.nominal, side
        np.testing.assert_allclose(
            one.linearise_beside(*at).residual, other.linearise_beside(*at).residual, atol=1e-14
        )
        guards = [s.switch(state, np.zeros(6), s.nominal, side) for s in (one, other)]
        np.testing.assert_allclose(guards[0], guards[1], atol=1e-14)


def test_condensed_structure() -> None:
    """Assert that joints at two places of a condensed structure have the guards of all its states.

    The acceleration without forces at a place stands for what all other states do.
    """
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=2)
    structure, systems = sym.Structure(beam, damping=0.02, at={"middle": 0}), []
    joints = [sym.CoulombFriction(structure["tip"], 0.002), sym.CoulombFriction(structure["middle"], 0.003)]
    model = sym.combine([structure, *joints, sym.HarmonicForce(structure["tip"], 0.02, 2.2)])
    for condense in (True, False):
        systems.append(sym.compile(model, condense=condense))
    small, large = systems
    assert all([s.kind for s in system.surfaces] == [Kind.SLIDING] * 2 for system in systems)
    draw = np.random.default_rng(2)
    state, phase = 1e-2 * draw.normal(size=(3, len(large.states))), draw.uniform(0, 6, 3)
    still = with_values(large, {"F": 0.0, "F_f_tip": 0.0, "F_f_middle": 0.0})
    free = Flow(large).rates(Trajectory(phase, state, np.zeros((3, 0))), still)
    known = {v.name: state[:, i] * v.scale for i, v in enumerate(large.states)}
    for place in ("tip", "middle"):
        index = [v.name for v in large.states].index(f"{place}'")
        known[f"acceleration of {place} without force"] = free[:, index]
    kept = np.array([known[v.name] / v.scale for v in small.states]).T
    for modes in product((1, -1, STUCK), repeat=2):
        side = np.tile(np.array(modes, dtype=float), (3, 1))
        guards = [s.switch(x, phase, s.nominal, side) for s, x in ((small, kept), (large, state))]
        np.testing.assert_allclose(guards[0], guards[1], rtol=1e-9, atol=1e-12)
