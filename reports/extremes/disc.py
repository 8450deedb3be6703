"""The wavy disc with one number changed, traced through its own resonance."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial

import periodic as per
import symbolic as sym
from reports.build import build
from reports.extremes.survey import Case
from reports.scene import load
from reports.schema import DiscScene
from reports.view import RPM

FROM, TO = 1.8, 0.4
"""Ends of the trace, in units of the speed at which the dry contact resonates."""


def case(value: float, changes: Mapping[str, float], base: str = "vitrea79-810N") -> Case:
    """Return the disc with some keys of its scene changed, traced in speed through resonance."""

    def scene() -> DiscScene:
        loaded = load(base, [(key, repr(number)) for key, number in changes.items()])
        assert isinstance(loaded, DiscScene)
        return loaded

    def trace(system: sym.CompiledSystem, settings: per.Settings) -> per.Branch:
        resonance = dry_resonance(scene())
        ends = (TO * resonance, FROM * resonance)
        return per.trace(system, "speed", ends, start=ends[1], settings=settings)

    return Case(value=value, system=lambda: build(scene()), trace=trace)


def dry_resonance(scene: DiscScene) -> float:
    """Return the speed (rad/s) at which the waves meet the dry contact, omega^2 = n Q/(delta0 m/2)."""
    contact, n = scene.contact, scene.contact.exponent
    deflection = (contact.preload / contact.stiffness) ** (1 / n)
    omega = math.sqrt(n * contact.preload / (deflection * scene.discs.mass / 2))
    return omega / scene.waviness.waves


def speeds(rpm: tuple[float, float], base: str = "vitrea79-810N") -> Case:
    """Return the disc as it is, traced over a range of speeds from its upper end."""

    def trace(system: sym.CompiledSystem, settings: per.Settings) -> per.Branch:
        ends = (rpm[0] * RPM, rpm[1] * RPM)
        return per.trace(system, "speed", ends, start=ends[1], settings=settings)

    return Case(
        value=rpm[1], system=partial(_built, base), trace=trace, name=f"{rpm[1]:g} to {rpm[0]:g} rev/min"
    )


def _built(base: str) -> sym.CompiledSystem:
    return build(load(base))
