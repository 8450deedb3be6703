"""Rotors on two film bearings or two squeeze-film dampers, rotors that rub, shafts in film bearings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

import symbolic as sym
from support.drawn.machines.machine import GRAVITY, RPM, Array, Machine, Random, spread

SLOWEST = 1000 * RPM

NODES, WEIGHTS = np.polynomial.legendre.leggauss(120)


@dataclass(frozen=True)
class Film:
    """A short film: p = -3 mu (L^2/4 - z^2) g/(c^2 h^3) where positive, g = Omega h_theta + 2 h_t."""

    viscosity: float
    radius: float
    length: float
    clearance: float
    turns: bool

    def force(self, q: Array, rate: Array, speed: float) -> Array:
        """The force on the journal in N, (2, r), by quadrature where the pressure is positive."""
        x, y = q / self.clearance
        u, v = rate / self.clearance
        turn = speed if self.turns else 0.0
        begin = np.arctan2(turn * y + 2 * u, turn * x - 2 * v) - math.pi
        theta = begin + math.pi / 2 * (1 + NODES[:, None])
        h = 1 - x * np.cos(theta) - y * np.sin(theta)
        g = turn * (x * np.sin(theta) - y * np.cos(theta)) - 2 * (u * np.cos(theta) + v * np.sin(theta))
        part = math.pi / 2 * WEIGHTS[:, None] * g / h**3
        size = self.viscosity * self.radius * self.length**3 / (2 * self.clearance**2)
        return size * np.array([(part * np.cos(theta)).sum(axis=0), (part * np.sin(theta)).sum(axis=0)])

    @property
    def sizes(self) -> dict[str, float]:
        """As the parts take them."""
        return {
            "viscosity": self.viscosity,
            "radius": self.radius,
            "length": self.length,
            "clearance": self.clearance,
        }


def journals(draw: Random) -> Machine:
    """On two journal bearings: L/D .3 to 1, Sommerfeld number .05 to 5 at 3000 rev/min."""
    return _on_two(draw, dampers=False)


def dampers(draw: Random) -> Machine:
    """On two squeeze-film dampers with cages, half of them sagging by up to 70 % of the clearance."""
    return _on_two(draw, dampers=True)


def _on_two(draw: Random, dampers: bool) -> Machine:
    """A rotor whose mass is shared between its bearings, the two joined by its elastic shaft."""
    mass, share = spread(draw, 5.0, 80.0), draw.uniform(0.3, 0.7)
    masses = mass * np.array([share, 1 - share])
    speed = sym.parameter("speed", 3000 * RPM, "rad/s")
    films, cages, loads, heavy = list[Film](), np.zeros(2), np.zeros(2), np.zeros((2, 2))
    parts: list[Any] = []
    ends = [[sym.coordinate(f"{way}{k}", scale=1e-5) for way in "xy"] for k in (1, 2)]
    sag = dampers and bool(draw.uniform() < 0.5)
    for k, (x, y) in enumerate(ends):
        own, radius = float(masses[k]), draw.uniform(0.015, 0.04)
        length, clearance = 2 * radius * draw.uniform(0.3, 1.0), radius * draw.uniform(0.001, 0.003)
        eccentricity, angle = spread(draw, 1e-6, 1e-5), float(draw.uniform(0, 6))
        heavy[k] = own * eccentricity * np.array([math.cos(angle), math.sin(angle)])
        parts += [sym.Mass(x, own), sym.Mass(y, own)]
        parts.append(sym.Unbalance(x, y, own, eccentricity, speed, angle).named(f"side{k + 1}"))
        if dampers:
            cages[k] = own * (draw.uniform(1500, 5000) * RPM) ** 2
            parts += [sym.Spring(q, float(cages[k])) for q in (x, y)]
            viscosity, length, clearance = spread(draw, 0.003, 0.03), length / 2, 1.5 * clearance
            loads[k] = float(cages[k]) * clearance * draw.uniform(0, 0.7) if sag else 0.0  # of a cage
        else:
            loads[k] = own * GRAVITY
            number = spread(draw, 0.05, 5.0)
            viscosity = number * loads[k] / (50 * length * 2 * radius) * (clearance / radius) ** 2
        film = Film(float(viscosity), float(radius), float(length), float(clearance), not dampers)
        films.append(film)
        if dampers:
            parts.append(sym.SqueezeFilmDamper(x, y, **film.sizes).named(f"side{k + 1}"))
        else:
            parts.append(sym.JournalBearing(x, y, **film.sizes, speed=speed).named(f"side{k + 1}"))
        if loads[k]:
            parts.append(sym.ConstantForce(y, -float(loads[k])))
    shaft = mass * spread(draw, 50.0, 600.0) ** 2
    damped = 0.02 * math.sqrt(shaft * mass)
    parts += [sym.Coupling(ends[0][i], ends[1][i], shaft, damped) for i in (0, 1)]

    def accelerations(tau: float, q: Array, rate: Array, omega: float) -> Array:
        q, rate = q.reshape(2, 2, -1), rate.reshape(2, 2, -1)
        turned = np.array([[math.cos(tau), -math.sin(tau)], [math.sin(tau), math.cos(tau)]])
        between = shaft * (q[0] - q[1]) + damped * (rate[0] - rate[1])
        found = np.empty_like(q)
        for k, way in enumerate((-1.0, 1.0)):
            force = films[k].force(q[k], rate[k], omega) + way * between - cages[k] * q[k]
            steady = omega**2 * turned @ heavy[k] - np.array([0.0, loads[k]])
            found[k] = (force + steady[:, None]) / masses[k]
        return found.reshape(4, -1)

    told = f"{mass:.3g} kg, {'dampers' if dampers else 'journal bearings'}{', sagging' if sag else ''}"
    bounds = SLOWEST, float(draw.uniform(6000, 15000)) * RPM
    return Machine(sym.combine(parts), "speed", bounds, told, accelerations)


def rubs(draw: Random) -> Machine:
    """A rotor in a ring: stiffnesses up to 15 % unlike, half of them off centre, with friction or without."""
    mass, natural = spread(draw, 1.0, 50.0), spread(draw, 60.0, 400.0)
    unlike = 0.0 if draw.uniform() < 0.3 else draw.uniform(0, 0.15)
    springs = mass * natural**2 * np.array([1.0, 1 + unlike])
    gap, damping = spread(draw, 5e-5, 5e-4), 2 * spread(draw, 0.02, 0.15) * mass * natural
    eccentricity, stator = gap * draw.uniform(0.05, 0.5), float(springs[0]) * spread(draw, 1.0, 50.0)
    slip = 0.0 if draw.uniform() < 0.3 else float(draw.uniform(0.02, 0.2))
    sag = float(springs[0]) * gap * draw.uniform(0, 0.5) if draw.uniform() < 0.6 else 0.0
    x, y = sym.coordinate("x", scale=1e-4), sym.coordinate("y", scale=1e-4)
    speed = sym.parameter("speed", natural, "rad/s")
    parts: list[Any] = [sym.Unbalance(x, y, mass, float(eccentricity), speed)]
    for q, k in zip((x, y), springs, strict=True):
        parts += [sym.Mass(q, mass), sym.Spring(q, float(k)), sym.Damper(q, damping)]
    parts.append(sym.Rub(x, y, stator, gap, slip))
    if sag:
        parts.append(sym.ConstantForce(y, -sag))

    def accelerations(tau: float, q: Array, rate: Array, omega: float) -> Array:
        r = np.hypot(*q)
        push = stator * np.maximum(r - gap, 0.0) / np.maximum(r, gap)
        contact = push * np.array([q[0] - slip * q[1], q[1] + slip * q[0]])
        pull = mass * eccentricity * omega**2 * np.array([math.cos(tau), math.sin(tau)])
        steady = pull - np.array([0.0, sag])
        return np.asarray((steady[:, None] - contact - springs[:, None] * q - damping * rate) / mass)

    told = (
        f"{mass:.3g} kg, {100 * unlike:.2g} % unlike, gap {1e6 * gap:.3g} um, e/gap {eccentricity / gap:.2f}"
    )
    bounds = 0.3 * natural, 2.0 * natural
    return Machine(sym.combine(parts), "speed", bounds, told, accelerations)


def shafts(draw: Random) -> Machine:
    """A shaft of six to ten elements with one or two discs, in two film bearings at its ends."""
    length, diameter, count = draw.uniform(0.4, 1.2), draw.uniform(0.03, 0.08), int(draw.integers(6, 11))
    size = int(draw.integers(1, 3))
    nodes = sorted(int(v) for v in draw.choice(np.arange(1, count), size=size, replace=False))
    discs = []
    for node in nodes:
        outer, width = diameter * draw.uniform(2, 4), draw.uniform(0.02, 0.06)
        mass = 7850 * math.pi * (outer**2 - (diameter / 2) ** 2) * width
        across = mass * (outer**2 / 4 + width**2 / 12)
        discs.append(sym.ShaftDisc(node, mass, polar=mass * outer**2 / 2, diametral=across))
    matrices = sym.shaft(length=length, diameter=diameter, elements=count, discs=discs)
    places = {"left": ("x0", "y0"), "right": (f"x{count}", f"y{count}")}
    places |= {f"disc{node}": (f"x{node}", f"y{node}") for node in nodes}
    rotor = sym.Structure(matrices, at=places, rayleigh=(0.0, spread(draw, 1e-6, 1e-5)), scale=1e-5)
    speed, parts = sym.parameter("speed", 3000 * RPM, "rad/s"), list[Any]([rotor])
    half = 7850 * math.pi * diameter**2 / 4 * length / 2
    for end in ("left", "right"):
        radius = diameter / 2
        sides, clearance = 2 * radius * draw.uniform(0.3, 1.0), radius * draw.uniform(0.001, 0.003)
        film = Film(spread(draw, 0.004, 0.05), radius, float(sides), float(clearance), turns=True)
        parts.append(sym.JournalBearing(*rotor[end], **film.sizes, speed=speed).named(end))
        parts.append(sym.ConstantForce(rotor[end][1], -half * GRAVITY))
    for disc, node in zip(discs, nodes, strict=True):
        x, y = rotor[f"disc{node}"]
        parts.append(sym.ConstantForce(y, -disc.mass * GRAVITY))
        heavy = spread(draw, 1e-6, 2e-5), speed, float(draw.uniform(0, 6))
        parts.append(sym.Unbalance(x, y, disc.mass, *heavy).named(f"disc{node}"))
    told = f"{1e3 * length:.0f} mm, {1e3 * diameter:.0f} mm thick, {count} elements, discs at {nodes}"
    bounds = SLOWEST, float(draw.uniform(6000, 15000)) * RPM
    return Machine(sym.combine(parts), "speed", bounds, told)
