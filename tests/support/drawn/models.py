"""Models and scenes drawn at random within the domain that the numerics are meant for; a seed is a case.

Discs in rolling contact: preload 20 N to 10 kN, any film law, viscosity 5 mPa s to 2 Pa s, waviness up to
half the static deflection, Hertz exponents 1 to 3, with and without damping and supports. Chains of one to
four masses with cubic springs and clearances, forced at their first. Self-excited oscillators from their
limit cycle.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from reference.integration import limit_cycle, over_period

import periodic as per
import symbolic as sym
from symbolic.equations.assembly import Assembly
from symbolic.motion.explicit import rates
from symbolic.scenes.axes import RPM
from symbolic.scenes.building import build
from symbolic.scenes.schema import HertzDiscScene

Random = np.random.Generator


@dataclass(frozen=True)
class Case:
    """What `periodic.trace` is given; `told` says it in words."""

    system: sym.CompiledSystem
    parameter: str
    bounds: tuple[float, float]
    start: float
    told: str
    options: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Clearance(sym.Part):
    """A stop: force -k max(q - gap, 0), with a switch at the gap."""

    q: sym.Coordinate
    k: float
    gap: float

    def contribute(self, assembly: Assembly) -> None:
        """Subtract the force of the stop."""
        motion = assembly.motion(self.q)
        k = assembly.parameter(self.k, f"stop_{self.q.name}", "N/m")
        past = motion.position.symbol - self.gap
        motion.force -= k * sym.functions.fmax(past, 0)
        assembly.switch(f"{self.q.name} = gap", past / self.gap, 0)


def drawn(kind: str, seed: int) -> Case:
    """Return the case of a seed."""
    return KINDS[kind](np.random.default_rng([list(KINDS).index(kind), seed]))


def _log(random: Random, low: float, high: float) -> float:
    return float(np.exp(random.uniform(math.log(low), math.log(high))))


def disc(random: Random) -> Case:
    """Two discs through their resonance."""
    tables = disc_tables(random)
    scene = HertzDiscScene.model_validate(tables)
    begin, end = (value * RPM for value in scene.trace.ends)
    told = repr({k: v for k, v in tables.items() if k not in ("title", "kind")})
    return Case(build(scene), "speed", (min(begin, end), max(begin, end)), begin, told)


def disc_tables(random: Random) -> dict[str, Any]:
    """A scene of two discs, as its file would have it."""
    exponent = 1.5 if random.random() < 0.5 else float(random.uniform(1, 3))
    preload, static, mass = _log(random, 20, 1e4), _log(random, 2e-6, 5e-5), _log(random, 0.1, 100)
    frequency = math.sqrt(exponent * preload / static / (mass / 2))
    waves = max(1, round(frequency / (_log(random, 30, 10_000) * RPM)))
    resonance = frequency / waves / RPM
    film = None if random.random() < 0.25 else film_table(random)
    tables: dict[str, Any] = {
        "title": "drawn",
        "kind": "disc",
        "discs": {"mass": mass, "diameter": _log(random, 0.03, 0.5)},
        "contact": {"stiffness": preload / static**exponent, "exponent": exponent, "preload": preload},
        "waviness": {"amplitude": static * _log(random, 3e-3, 0.5), "waves": waves},
        "trace": {
            "from_rpm": resonance * random.uniform(1.3, 2.2),
            "to_rpm": resonance * random.uniform(0.5, 1),
        },
    }
    if film is not None:
        tables["film"] = film
    if film is None or film["law"] in ("quasistatic", "cavitating") or random.random() < 0.3:
        tables["damping"] = {"ratio": _log(random, 2e-3, 0.3)}
    if random.random() < 0.25 and (film is None or film["law"] != "third-order"):
        stiffness = exponent * preload / static
        tables["support"] = {
            "stiffness": stiffness * _log(random, 0.5, 100),
            "damping": 2 * _log(random, 1e-2, 0.3) * math.sqrt(stiffness * mass),
            "disc_share": float(random.uniform(0.1, 0.9)),
        }
        if random.random() < 0.5:
            tables["support"]["leaf"] = stiffness * _log(random, 1e-4, 1e-1)
    return tables


def film_table(random: Random) -> dict[str, Any]:
    """A film between the discs."""
    law = str(random.choice(["squeeze", "squeeze", "quasistatic", "cavitating", "third-order"]))
    thickness = ["calibrated", "equation-5", "constant-one-body", "constant-two-body", "hamrock-dowson"]
    table: dict[str, Any] = {
        "law": law,
        "thickness": str(random.choice(thickness)) if random.random() < 0.3 else "calibrated",
        "viscosity": _log(random, 5e-3, 2),
        "piezoviscosity": _log(random, 5e-9, 4e-8),
        "beta": float(random.uniform(5, 60)),
    }
    if law != "quasistatic":
        table["squeeze"] = _log(random, 300, 2e4)
    if law == "cavitating":
        table["floor"] = _log(random, 1e-5, 1e-2)
    return table


def chain(random: Random) -> Case:
    """One to four masses in a row, some on cubic springs or before a stop, forced at the first."""
    count = int(random.integers(1, 5))
    q = [sym.coordinate(f"q{k + 1}") for k in range(count)]
    values: dict[str, float] = {}

    def value(name: str, number: float) -> sym.Parameter:
        values[name] = number
        return sym.parameter(name, number)

    parts: list[sym.Part] = []
    for k, x in enumerate(q):
        parts += [sym.Mass(x, value(f"m{k}", random.uniform(0.5, 2)))]
        parts += [sym.Spring(x, value(f"k{k}", random.uniform(0.3, 1.5) if k == 0 else random.uniform(0, 1)))]
        parts += [sym.Damper(x, value(f"c{k}", _log(random, 0.01, 0.3)))]
        if random.random() < 0.5 or k == 0:
            parts += [sym.CubicSpring(x, value(f"h{k}", _log(random, 0.03, 3)))]
        if random.random() < 0.25:
            parts += [Clearance(x, _log(random, 0.3, 10), _log(random, 0.2, 2))]
            values[f"gap{k}"] = parts[-1].gap
            values[f"stop{k}"] = parts[-1].k
    for k in range(count - 1):
        stiffness = value(f"s{k}", _log(random, 0.1, 3))
        parts += [sym.Coupling(q[k], q[k + 1], stiffness, value(f"d{k}", _log(random, 1e-3, 0.1)))]
    values["F"] = force = _log(random, 0.03, 1)
    parts += [sym.HarmonicForce(q[0], force)]
    low, high = float(random.uniform(0.3, 0.8)), float(random.uniform(1.5, 3))
    start = low if random.random() < 0.5 else high
    return Case(sym.compile(sym.combine(parts)), "Omega", (low, high), start, f"{count} masses, {values}")


def cycle(random: Random) -> Case:
    """A self-excited oscillator, from the limit cycle that a simulation settles to."""
    name = str(random.choice(list(CYCLES)))
    function, states, parameter, (low, high), draw_others = CYCLES[name]
    values = {parameter: _log(random, low, high), **draw_others(random)}
    equations = sym.Equations(function, states=dict.fromkeys(states, 0.0), parameters=values)
    system = sym.compile(equations)
    begin = values[parameter]
    bounds = (begin, 2.5 * begin) if random.random() < 0.5 else (begin / 2.5, begin)
    options = {"guess": settled(system), "determined": {"omega": per.PhaseCondition()}}
    return Case(system, parameter, bounds, begin, f"{name}, {values}", options)


def settled(system: sym.CompiledSystem) -> per.Orbit:
    """Return the orbit to which a simulation settles, between two passages of its first state."""
    field, nominal = rates(system), np.array(system.nominal)
    names = [p.name for p in system.parameters]
    nominal[names.index("omega")] = 1.0
    n = len(system.states)

    def rhs(t: float, x: Any) -> Any:
        return field(x[None, :], np.zeros(1), nominal)[0]

    begin, period = limit_cycle(rhs, np.full(n, 0.3), 300, 0, method="LSODA")
    phase, motion = over_period(rhs, begin, period, 801, "LSODA")
    nominal[names.index("omega")] = 2 * np.pi / period
    return per.sampled(phase, motion, np.zeros((801, 0)), nominal)


def _none(random: Random) -> dict[str, float]:
    return {}


CYCLES: dict[str, Any] = {
    "van der Pol": (
        lambda x, p: {"x": x.v, "v": p.mu * (1 - x.x**2) * x.v - x.x},
        ("x", "v"),
        "mu",
        (0.1, 15.0),
        _none,
    ),
    "Rayleigh and Duffing": (
        lambda x, p: {"x": x.v, "v": p.mu * (1 - x.v**2) * x.v - x.x - p.h * x.x**3},
        ("x", "v"),
        "mu",
        (0.1, 5.0),
        lambda random: {"h": float(random.uniform(0, 2))},
    ),
    "FitzHugh and Nagumo": (
        lambda x, p: {"x": x.x - x.x**3 / 3 - x.w + p.I, "w": p.e * (x.x + 0.7 - 0.8 * x.w)},
        ("x", "w"),
        "e",
        (0.03, 0.15),
        lambda random: {"I": float(random.uniform(0.45, 1.2))},
    ),
    "two coupled": (
        lambda x, p: {
            "x": x.v,
            "v": p.mu * (1 - x.x**2) * x.v - x.x + p.k * (x.y - x.x),
            "y": x.w,
            "w": -p.c * x.w - x.y + p.k * (x.x - x.y),
        },
        ("x", "v", "y", "w"),
        "mu",
        (0.3, 4.0),
        lambda random: {"k": float(random.uniform(0.05, 1)), "c": float(random.uniform(0.05, 0.4))},
    ),
}
"""Rates, states, the parameter continued in, where it starts, and how others are drawn."""

KINDS: dict[str, Callable[[Random], Case]] = {"disc": disc, "chain": chain, "cycle": cycle}
