"""Oscillators with linear stops, and their branches judged point by point in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from reference.excursions import exact
from reference.piecewise import Piecewise, periodic

import periodic as per
import symbolic as sym

FORCE, DAMPING = 0.5, 0.1


def stopped(stiffness: float, gap: float = 1.0) -> sym.CompiledSystem:
    """q'' + .1 q' + q + k max(q - gap, 0) = .5 cos(Omega t)."""
    q = sym.coordinate("q")
    model = sym.Mass(q, 1.0) + sym.Damper(q, DAMPING) + sym.Spring(q, 1.0) + sym.HarmonicForce(q, FORCE)
    return sym.compile(model + sym.Stop(q, sym.HertzLaw(stiffness, 1.0), gap=gap))


def exactly(stiffness: float, gap: float = 1.0) -> Piecewise:
    """The same in closed form."""
    return Piecewise(
        matrix=np.array([[0.0, 1.0], [-1.0, -DAMPING]]),
        force=np.array([0.0, FORCE]),
        normals=np.array([[1.0, 0.0]]),
        gaps=np.array([gap]),
        columns=np.array([[0.0, -stiffness]]),
    )


def errors(system: Piecewise, point: per.Point, states: tuple[str, ...] = ("q",)) -> tuple[float, float]:
    """Error of the orbit of a point at one phase, and of the characteristic polynomial of its multipliers.

    The latter over the largest one.
    """
    orbit, omega = point.orbit, point.parameter
    away = int(np.abs(orbit.nodes[:-1, 0] - 1.0).argmax())
    tau = float(orbit.grid.left[away])
    start = [orbit[name](tau / omega) for name in states] + [
        orbit[f"{name}'"](tau / omega) for name in states
    ]
    found = periodic(system, omega, start, orbit.periods, tau)
    largest = max(1.0, float(np.abs(found.multipliers).max()))
    apart = np.abs(np.poly(found.monodromy) - np.poly(point.multipliers)).max()
    return float(np.abs(found.start - np.array(start)).max()), float(apart) / largest


@dataclass(frozen=True)
class Judged:
    """Errors of a point's orbit at its passages, and of its multipliers as these are claimed.

    wrong: how far a switch is on the wrong side of its level somewhere.
    """

    orbit: float
    multiplier: float
    wrong: float


def judged(system: Piecewise, point: per.Point) -> Judged:
    """Hold a point of a branch against the exact orbit of its pattern of passages."""
    orbit, omega = point.orbit, point.parameter
    at = orbit.mesh.starts if len(orbit.phases) else np.zeros(1, dtype=int)
    n = orbit.nodes.shape[1]
    states = orbit.nodes[at] * np.repeat([1.0, omega], n // 2)
    switches = tuple(event.switch for event in orbit.mesh.events)
    found = exact(system, omega, orbit.grid.left[at], states, switches, orbit.mesh.period)
    radius = max(1.0, float(np.abs(found.multipliers).max()))
    own, true = point.multipliers / radius, found.multipliers / radius
    apart = max(abs(own.sum() - true.sum()), abs((own**2).sum() - (true**2).sum()) / 2)
    away = np.abs(found.states - states).max()
    return Judged(float(away), float(apart), found.wrong)
