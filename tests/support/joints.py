"""Small models with joints that stick, for tests of the engine."""

from __future__ import annotations

import symbolic as sym


def dry_friction() -> sym.CompiledSystem:
    """A mass on a spring that friction holds for a while in each period."""
    x = sym.coordinate("x")
    own = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.05), sym.CoulombFriction(x, 0.4)]
    return sym.compile(sym.combine([*own, sym.HarmonicForce(x, 1.0)]))


def friction_and_slider() -> sym.CompiledSystem:
    """Two masses, one on friction, the other at an elastic slider."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    joints = [sym.CoulombFriction(x, 0.2), sym.Jenkins(y, 0.5, 0.3, creep=None)]
    springs = [sym.Spring(x, 1.0), sym.Spring(y, 1.5), sym.Spring(x, 0.8, to=y)]
    masses = [sym.Mass(x, 1.0), sym.Mass(y, 1.0), sym.Damper(x, 0.05), sym.Damper(y, 0.05)]
    return sym.compile(sym.combine([*masses, *springs, *joints, sym.HarmonicForce(x, 1.0)]))
