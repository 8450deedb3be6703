"""Friction dampers on one to three masses, and beams that strike stops."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import symbolic as sym
from support.drawn.machines.machine import Machine, Random, spread


def friction(draw: Random) -> Machine:
    """One to three masses with dry friction, elastic sliders or Iwan joints, to ground or between."""
    count, k, m = int(draw.integers(1, 4)), spread(draw, 1e5, 1e7), spread(draw, 0.05, 2.0)
    force = spread(draw, 1.0, 50.0)
    natural, ratio = math.sqrt(k / m), spread(draw, 0.002, 0.02)
    q = [sym.coordinate(f"q{i}", scale=10 * force / k) for i in range(count)]
    omega = sym.parameter("Omega", natural, "rad/s")
    parts: list[Any] = [sym.HarmonicForce(q[0], force, omega)]
    for each in q:
        parts += [sym.Mass(each, m * draw.uniform(0.8, 1.2)), sym.Spring(each, k * draw.uniform(0.5, 1.0))]
        parts.append(sym.Damper(each, 2 * ratio * m * natural))
    parts += [sym.Coupling(a, b, k * draw.uniform(0.1, 1.0)) for a, b in zip(q, q[1:], strict=False)]
    kinds = ""
    for i in range(int(draw.integers(1, count + 1))):
        to = q[i + 1] if i + 1 < count and draw.uniform() < 0.5 else None
        kind, limit, stiff = (
            str(draw.choice(list("CJI"))),
            force * spread(draw, 0.1, 3.0),
            k * spread(draw, 0.1, 3),
        )
        if kind == "C":
            joint: Any = sym.CoulombFriction(q[i], limit, to=to)
        elif kind == "J":
            joint = sym.Jenkins(q[i], stiff, limit, to=to)
        else:
            joint = sym.Iwan(q[i], stiff, tuple(float(v) for v in limit * np.linspace(0.2, 1, 4)), to=to)
        parts.append(joint.named(f"joint{i}"))
        kinds += kind if to is None else kind.lower()
    told = f"{count} masses near {m:.3g} kg, joints {kinds} (small: between masses), {force:.3g} N"
    return Machine(sym.combine(parts), "Omega", (0.5 * natural, 2.2 * natural), told)


def beams(draw: Random) -> Machine:
    """A cantilever of 20 to 200 degrees of freedom whose tip strikes a stop on one side or both."""
    count, length = int(draw.integers(10, 101)), draw.uniform(0.2, 1.0)
    wide, thick = draw.uniform(0.01, 0.04), draw.uniform(0.002, 0.01)
    bending, mass = 2.1e11 * wide * thick**3 / 12, 7850 * wide * thick
    matrices = sym.beam(length=length, bending=bending, mass_per_length=mass, elements=count)
    first, tip = 3.516 * math.sqrt(bending / mass / length**4), 3 * bending / length**3
    damped = (0.0, 2 * spread(draw, 0.005, 0.03) / first)
    beam = sym.Structure(matrices, at={"end": "tip"}, rayleigh=damped, scale=1e-3)
    force = spread(draw, 0.05, 1.0) * tip * 1e-4
    gap, stiff = force / tip * spread(draw, 1.5, 12.0), tip * spread(draw, 2.0, 100.0)
    omega = sym.parameter("Omega", first, "rad/s")
    one = bool(draw.uniform() < 0.6)
    stop = sym.OneSidedSpring(beam["end"], stiff, gap)
    both = sym.Gap(beam["end"], stiff, -gap * draw.uniform(0.7, 1.3), gap)
    parts: list[Any] = [beam, stop if one else both, sym.HarmonicForce(beam["end"], force, omega)]
    told = f"{2 * count} degrees of freedom, stop{'' if one else 's'} {stiff / tip:.3g} times as stiff"
    return Machine(sym.combine(parts), "Omega", (0.5 * first, 2.0 * first), told)
