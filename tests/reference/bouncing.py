"""COCO's problem `hspo`: x'' + c x' + k x = A cos w t with a rigid wall x <= d, v+ = -e v-."""

from __future__ import annotations

from typing import Any

import numpy as np

import periodic as per
import symbolic as sym
from reference.hybrid import Hybrid, Surface, periodic_orbit
from reference.shooting import Motion

DAMPING, GAP, RESTITUTION = 0.1, 1.0, 0.8
VALUES = {"A": 1.0, "w": 1.0, "c": DAMPING, "k": 1.0, "d": GAP, "e": RESTITUTION}


def equations(x: Any, p: Any, wave: Any) -> dict[str, Any]:
    """The oscillator."""
    return {"x": x.v, "v": p.A * wave.cos - p.c * x.v - p.k * x.x}


def wall(x: Any, p: Any, wave: Any) -> dict[str, Any]:
    """The rigid wall."""
    return {"wall": (p.d - x.x, {"v": -p.e * x.v})}


def bouncing() -> sym.CompiledSystem:
    """The compiled problem."""
    return sym.compile(sym.Equations(equations, {"x": 0.0, "v": 0.0}, VALUES, frequency="w", resets=wall))


def settled_at(system: sym.CompiledSystem, **values: float) -> per.Orbit:
    """The motion to which it settles, with one impact in a period."""
    motion = sym.simulate(system, values, settle=40, tolerance=1e-9)
    assert np.count_nonzero(np.diff(motion.phase) == 0) == 1
    return per.sampled(motion.phase, motion.state, motion.algebraic, motion.parameter, system=system)


def shot(point: per.Point) -> Motion:
    """The orbit by event-exact shooting, its perturbations by saltation."""
    force, w = (point.orbit.parameters[name] for name in ("A", "w"))
    reset = lambda t, y: (np.array([y[0], -RESTITUTION * y[1]]), np.zeros(2), np.diag([1.0, -RESTITUTION]))  # noqa: E731
    surface = Surface(lambda t, y: GAP - y[0], lambda t, y: (0.0, np.array([-1.0, 0.0])), reset)
    system = Hybrid(
        lambda t, y, signs: [y[1] / w, (force * np.cos(t) - DAMPING * y[1] - y[0]) / w],
        lambda t, y, signs: [[0, 1 / w], [-1 / w, -DAMPING / w]],
        [surface],
    )
    return periodic_orbit(system, point.orbit.state(np.zeros(1))[0])
