"""Oscillators with each kind of event, for what follows motions in time."""

from __future__ import annotations

from collections.abc import Callable

import symbolic as sym

X, Y = sym.coordinate("x"), sym.coordinate("y")


def oscillator(
    *parts: sym.Part, force: float = 1.0, omega: float = 1.0, c: float = 0.1
) -> sym.CompiledSystem:
    """A mass on a spring with a damper and a force, and more."""
    model: sym.Model | sym.Part = sym.Mass(X, 1.0) + sym.Damper(X, c) + sym.Spring(X, 1.0)
    model = model + sym.HarmonicForce(X, force, omega)
    for part in parts:
        model = model + part
    return sym.compile(model)


def two_with_friction() -> sym.CompiledSystem:
    """Two masses, each rubbing on the ground, and on one another."""
    masses = sym.Mass(X, 1.0) + sym.Mass(Y, 0.7) + sym.Spring(X, 1.0) + sym.Coupling(X, Y, 1.3)
    rubs = sym.CoulombFriction(X, 0.2) + sym.CoulombFriction(Y, 0.15) + sym.CoulombFriction(X, 0.1, to=Y)
    return sym.compile(masses + rubs + sym.Damper(X, 0.05) + sym.HarmonicForce(X, 0.8, 0.7))


def thermostat() -> sym.CompiledSystem:
    """A relay that heats, outside it is warmer and colder."""
    return sym.compile(
        sym.Equations(
            lambda x, p, wave: {
                "t": -0.3 * x.t + 0.2 * wave.sin + sym.functions.relay(x.t, 1.0, 0.6, low=0.5, high=0.0)
            },
            states={"t": 0.0},
            parameters={"Omega": 0.5},
            frequency="Omega",
        )
    )


SYSTEMS: dict[str, Callable[[], sym.CompiledSystem]] = {
    "gap": lambda: oscillator(sym.Gap(X, 5.0, -0.4, 0.5)),
    "impact": lambda: oscillator(sym.RigidStop(X, gap=1.0, restitution=0.8)),
    "chatter": lambda: oscillator(sym.RigidStop(X, gap=0.1, restitution=0.3), force=0.7, omega=0.4),
    "friction": lambda: oscillator(sym.CoulombFriction(X, 0.5), omega=0.5),
    "joints": two_with_friction,
    "slider": lambda: oscillator(sym.Jenkins(X, 0.5, 0.2)),
    "friction and slider": lambda: oscillator(sym.Jenkins(X, 0.5, 0.2), sym.CoulombFriction(X, 0.3)),
    "friction and impact": lambda: oscillator(
        sym.CoulombFriction(X, 0.2), sym.RigidStop(X, gap=0.8, restitution=0.6)
    ),
    "relay": thermostat,
    "film": lambda: sym.scene("vitrea79-810N"),
    "gears": lambda: sym.scene("gear-pair"),
    "rub": lambda: sym.scene("jeffcott-rub"),
}
