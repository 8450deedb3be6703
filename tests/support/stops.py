"""Oscillators with linear stops, and their branches judged point by point in closed form."""

from __future__ import annotations

import numpy as np
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
