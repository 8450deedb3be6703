"""Sections on the wavy disc: one of its numbers taken over decades, traced through its own resonance."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import periodic as per
import symbolic as sym
from reports.studies.extremes.study import Study
from reports.studies.extremes.survey import Case
from symbolic.scenes.axes import RPM
from symbolic.scenes.building import build
from symbolic.scenes.reading import load
from symbolic.scenes.schema import DiscScene

FROM, TO = 1.8, 0.4
"""Ends of the trace, in units of the speed at which the dry contact resonates."""


def case(value: float, changes: Mapping[str, float], base: str = "vitrea79-810N") -> Case:
    """Return the disc with some keys of its scene changed, traced in speed through resonance."""

    def scene() -> DiscScene:
        loaded = load(base, [(key, repr(number)) for key, number in changes.items()])
        assert isinstance(loaded, DiscScene)
        return loaded

    def trace(system: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
        resonance = dry_resonance(scene())
        ends = (TO * resonance, FROM * resonance)
        return per.trace(system, "speed", ends, start=ends[1], control=control)

    return Case(value=value, system=lambda: build(scene()), trace=trace)


def dry_resonance(scene: DiscScene) -> float:
    """Return the speed (rad/s) at which the waves meet the dry contact, omega^2 = n Q/(delta0 m/2)."""
    preload, contact = scene.contact.preload, scene.contact.numbers
    n = contact["exponent"]
    deflection = (preload / contact["stiffness"]) ** (1 / n)
    omega = math.sqrt(n * preload / (deflection * scene.discs.mass / 2))
    return omega / scene.waviness.waves


def speeds(rpm: tuple[float, float], base: str = "vitrea79-810N") -> Case:
    """Return the disc as it is, traced over a range of speeds from its upper end."""

    def trace(system: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
        ends = (rpm[0] * RPM, rpm[1] * RPM)
        return per.trace(system, "speed", ends, start=ends[1], control=control)

    return Case(
        value=rpm[1], system=partial(_built, base), trace=trace, name=f"{rpm[1]:g} to {rpm[0]:g} rev/min"
    )


def _built(base: str) -> sym.CompiledSystem:
    return build(load(base))


CAVITATING, DRY, SUPPORTS = "cavitating-film-810N", "dry-810N", "supports-810N"

SPEEDS = (
    (0.98, 1.0),
    (2.9, 3.0),
    (9.0, 10.0),
    (25.0, 30.0),
    (60.0, 100.0),
    (100.0, 500.0),
    (500.0, 2000.0),
    (2000.0, 6000.0),
    (6000.0, 20000.0),
)
"""rev/min; short ones where natural vibrations fit many times into a period of the excitation."""

SMALL, LARGE = (1e-9, 1e-8, 1e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4), (1e-9, 1e-5, 3e-5, 1e-4)
"""Amplitudes (m) for the disc with its film, and for a film that cavitates and none."""


def waves() -> list[Case]:
    """Return the disc with its film, then with a film that cavitates, then dry."""
    film = [case(a, {"amplitude": a}) for a in SMALL]
    others = [replace(case(a, {"amplitude": a}, base), way=base) for base in (CAVITATING, DRY) for a in LARGE]
    return film + others


def squeezes() -> list[Case]:
    """Return the disc with a film that has no squeeze, then with coefficients."""
    none = replace(case(0.0, {}, "quasistatic-film-810N"), name="0 (quasistatic film)")
    return [none, *(case(g, {"squeeze": g}) for g in (0.001, 27.343, 273.43, 2734.3, 27343.0, 273430.0))]


def exponent(n: float) -> Case:
    """Return the disc with an exponent of the contact and the static deflection of 810 N as it is."""
    return case(n, {"exponent": n, "contact.stiffness": 810 / (810 / 28e9) ** (n / 1.5)})


STUDIES = (
    Study(
        key="preload",
        title="Preload",
        quantity="preload",
        unit="N",
        cases=lambda: [case(q, {"preload": q}) for q in (1.0, 10.0, 100.0, 810.0, 1e4, 1e5, 1e6)],
        quick=(810.0,),
    ),
    Study(
        key="viscosity",
        title="Viscosity",
        quantity="viscosity",
        unit="Pa s",
        cases=lambda: [case(eta, {"viscosity": eta}) for eta in (1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0)],
        quick=(10.0,),
    ),
    Study(
        key="speed",
        title="Speed",
        quantity="upper end of the speeds",
        unit="rev/min",
        cases=lambda: [speeds(ends) for ends in SPEEDS],
        quick=(2000.0,),
    ),
    Study(key="waviness", title="Waviness", quantity="amplitude", unit="m", cases=waves, quick=(1e-8, 1e-7)),
    Study(
        key="beta",
        title="Film exponent β",
        quantity="β",
        cases=lambda: [case(b, {"beta": b}) for b in (1.0, 2.0, 5.0, 10.0, 22.23, 40.0, 60.0)],
        quick=(5.0,),
    ),
    Study(key="squeeze", title="Squeeze coefficient γ", quantity="γu", cases=squeezes, quick=(27.343,)),
    Study(
        key="exponent",
        title="Hertz exponent",
        quantity="n",
        cases=lambda: [exponent(n) for n in (1.0, 1.25, 1.5, 2.0, 2.5, 3.0)],
        quick=(1.0,),
    ),
    Study(
        key="damping",
        title="Damping ratio",
        quantity="ratio",
        cases=lambda: [case(z, {"ratio": z}, DRY) for z in (0.0, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0)],
        quick=(0.1, 1.0),
    ),
    Study(
        key="massratio",
        title="Mass ratio",
        quantity="disc / housing",
        cases=lambda: [
            case(r, {"disc_share": r / (1 + r)}, SUPPORTS)
            for r in (1e-6, 1e-4, 1e-3, 1e-2, 1.0, 1e2, 1e3, 1e4, 1e6)
        ],
        quick=(1e6,),
    ),
    Study(
        key="stiffness",
        title="Support stiffness",
        quantity="bearing / contact",
        cases=lambda: [
            case(r, {"support.stiffness": r * 129e6}, SUPPORTS)
            for r in (1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6)
        ],
        quick=(0.01,),
    ),
)
