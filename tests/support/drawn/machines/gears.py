"""Spur gears, as one coordinate and as two wheels on shafts of their own."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import symbolic as sym
from support.drawn.machines.machine import Array, Machine, Random, spread

RANGE = (0.3, 1.6)
"""Of mesh frequencies, over the natural one of the mesh."""


class Teeth:
    """Stiffness, half backlash, harmonics of stiffness and transmission error, and their force."""

    def __init__(self, draw: Random) -> None:
        self.k, self.b = spread(draw, 1e8, 6e8), spread(draw, 1e-5, 1e-4)
        shape = np.array([1.0, draw.uniform(-0.5, 0.6), draw.uniform(-0.3, 0.3)])
        self.variation = [float(v) for v in draw.uniform(0.05, 0.3) * shape]
        self.load = self.k * self.b * spread(draw, 0.02, 3.0)
        shares = np.array([1.0, draw.uniform(0, 0.5), draw.uniform(0, 0.3)])
        self.error = [float(v) for v in spread(draw, 5e-7, 8e-6) * shares]
        self.orders = np.arange(1, 4)

    def force(self, tau: float, u: Array) -> Array:
        """K(tau) B(u)."""
        varying = self.k * (1 - np.array(self.variation) @ np.cos(self.orders * tau))
        return np.asarray(varying * (np.maximum(u - self.b, 0.0) + np.minimum(u + self.b, 0.0)))

    def __str__(self) -> str:
        load = self.load / (self.k * self.b)
        return f"k {self.k:.3g} N/m, backlash {2e6 * self.b:.3g} um, load {load:.3g} k b"


def pair(draw: Random) -> Machine:
    """One coordinate: the dynamic transmission error."""
    teeth, mass = Teeth(draw), spread(draw, 0.05, 2.0)
    natural = math.sqrt(teeth.k / mass)
    damping = 2 * spread(draw, 0.02, 0.12) * mass * natural
    q, omega = sym.coordinate("q", scale=1e-5), sym.parameter("Omega", natural, "rad/s")
    parts = [sym.Mass(q, mass), sym.Damper(q, damping), sym.ConstantForce(q, teeth.load)]
    parts.append(sym.GearMesh(q, teeth.k, teeth.b, teeth.variation))
    parts.append(sym.TransmissionError(q, mass, teeth.error, omega))
    error = np.array(teeth.error)

    def accelerations(tau: float, at: Array, rate: Array, speed: float) -> Array:
        stirred = error @ ((teeth.orders * speed) ** 2 * np.cos(teeth.orders * tau))
        return np.asarray((teeth.load - teeth.force(tau, at) - damping * rate) / mass + stirred)

    bounds = RANGE[0] * natural, RANGE[1] * natural
    return Machine(sym.combine(parts), "Omega", bounds, f"{teeth}, {mass:.3g} kg", accelerations)


def wheels(draw: Random) -> Machine:
    """Two wheels, each on a shaft whose end turns steadily; along the line of action."""
    teeth, masses = Teeth(draw), np.array([spread(draw, 0.2, 4.0), spread(draw, 0.2, 8.0)])
    together = float(masses.prod() / masses.sum())
    natural = math.sqrt(teeth.k / together)
    shafts = teeth.k * np.array([spread(draw, 0.003, 0.3) for _ in range(2)])
    dampers = 2 * spread(draw, 0.01, 0.05) * np.sqrt(shafts * masses)
    damping = 2 * spread(draw, 0.02, 0.1) * together * natural
    ends = [sym.coordinate(name, scale=1e-5) for name in ("driving", "driven")]
    parts: list[Any] = []
    for q, m, k, c in zip(ends, masses, shafts, dampers, strict=True):
        parts += [sym.Mass(q, float(m)), sym.Spring(q, float(k)), sym.Damper(q, float(c))]
    parts += [sym.ConstantForce(ends[0], teeth.load), sym.ConstantForce(ends[1], -teeth.load)]
    omega = sym.parameter("Omega", natural, "rad/s")
    meshing = {"to": ends[1], "damping": damping, "error": teeth.error, "frequency": omega}
    parts.append(sym.GearMesh(ends[0], teeth.k, teeth.b, teeth.variation, **meshing))
    error, way = np.array(teeth.error), np.array([1.0, -1.0])

    def accelerations(tau: float, at: Array, rate: Array, speed: float) -> Array:
        u = way @ at - error @ np.cos(teeth.orders * tau)
        moved = way @ rate + speed * (error * teeth.orders) @ np.sin(teeth.orders * tau)
        driven = np.outer(way, teeth.load - teeth.force(tau, u) - damping * moved)
        held = shafts[:, None] * at + dampers[:, None] * rate
        return np.asarray((driven - held) / masses[:, None])

    bounds = RANGE[0] * natural, RANGE[1] * natural
    told = f"{teeth}, {masses[0]:.3g} and {masses[1]:.3g} kg"
    return Machine(sym.combine(parts), "Omega", bounds, told, accelerations)
