"""The discs of the paper: their systems, parameters and rest."""

from __future__ import annotations

from functools import cache

import symbolic as sym
from symbolic.motion.linear import Modes, modes
from symbolic.scenes.building import build
from symbolic.scenes.reading import load
from symbolic.system.compiled import with_values

PAPER_SPEED = ("trace.from_rpm", "360")
"""What makes the speed of the paper's time histories the nominal one of a scene."""


@cache
def system(name: str, *overrides: tuple[str, str]) -> sym.CompiledSystem:
    """Return the system of a built-in scene with some of its keys changed."""
    return build(load(name, overrides))


@cache
def nominal(name: str) -> dict[str, float]:
    """Return the parameters (SI) of a built-in scene by name."""
    return {p.name: p.value for p in system(name).parameters}


def at_paper_speed(name: str) -> Modes:
    """Return rest and linear motion of a scene at 360 rev/min."""
    return modes(system(name, PAPER_SPEED))


def film_at_rest(disc: sym.CompiledSystem, **values: float) -> float:
    """Return h0 in m at some values (SI) of the parameters, the others nominal."""
    index = [state.name for state in disc.states].index("h")
    state, _ = disc.rest(with_values(disc, values))
    return float(state[index] * disc.states[index].scale)


def static_deflection(values: dict[str, float]) -> float:
    """Return delta0 = (Q/K)^(1/n) of the dry Hertz contact under the preload, in m."""
    return (values["preload"] / values["stiffness"]) ** (1 / values["exponent"])
