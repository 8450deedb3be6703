"""Shafts of the program ROSS in two film bearings.

`ross.npz` holds the matrices M, C, K and G that ROSS 2.3.0 gives for the bending (x, y, alpha, beta of each
node) of four rotors of steel (7810 kg/m^3, 211 and 81.2 GPa) with shear, rotatory inertia and gyroscopic
terms, without bearings, and the nodes and masses of their discs (width, inner, outer diameter in m):

- example: its own, six elements of 250 mm, 50 mm thick, discs .07, .05, .28 at the nodes 2 and 4;
- overhung: 200, 300, 300, 200, 150 mm, 60, 70, 70, 60, 60 mm thick, discs .03, .07, .2 at 2 and
  .05, .06, .25 at 4;
- slender: eight elements of 150 mm, 30 mm thick, a disc .05, .03, .2 at 4;
- heavy: five elements of 200 mm, 90, 120, 140, 120, 90 mm thick, discs .06, .12, .35 at 1 and
  .06, .14, .4 at 2 and 3.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import symbolic as sym
from support.drawn.machines.machine import GRAVITY, RPM, Machine, Random, spread
from support.drawn.machines.rotors import Film

ROTORS = ("example", "overhung", "slender", "heavy")

FREEDOMS = 4
"""Of a node."""

SLOWEST = 400 * RPM
"""Below their first critical speeds."""


def shafts(draw: Random) -> Machine:
    """One of them, its discs unbalanced, in journal bearings of L/D .3 to 1, Sommerfeld number .05 to 5."""
    name = str(draw.choice(ROTORS))
    with np.load(Path(__file__).with_name("ross.npz")) as file:
        own = {key.removeprefix(f"{name}_"): file[key] for key in file.files if key.startswith(f"{name}_")}
    nodes = len(own["M"]) // FREEDOMS
    at = {f"{way}{k}": FREEDOMS * k + i for k in range(nodes) for i, way in enumerate("xy")}
    matrices = sym.Matrices(own["M"], own["C"], own["K"], own["G"], at=at)
    discs = dict(zip(own["discs"].tolist(), own["disc_masses"].tolist(), strict=True))
    ends = {"left": 0, "right": nodes - 1}
    places = {end: (f"x{node}", f"y{node}") for end, node in ends.items()}
    places |= {f"disc{node}": (f"x{node}", f"y{node}") for node in discs}
    rotor = sym.Structure(matrices, at=places, rayleigh=(0.0, spread(draw, 1e-6, 1e-5)), scale=1e-5)
    speed, parts = sym.parameter("speed", 3000 * RPM, "rad/s"), list[Any]([rotor])
    half = (float(own["mass"]) - sum(discs.values())) / 2
    radius = 0.04 if name == "heavy" else 0.02
    right = sum(mass * node / (nodes - 1) for node, mass in discs.items())  # elements are about as long
    carried = {"left": half + sum(discs.values()) - right, "right": half + right}
    for end in ends:
        sides, clearance = 2 * radius * draw.uniform(0.3, 1.0), radius * draw.uniform(0.001, 0.003)
        number = spread(draw, 0.05, 5.0)
        viscosity = number * carried[end] * GRAVITY / (50 * sides * 2 * radius) * (clearance / radius) ** 2
        film = Film(float(viscosity), radius, float(sides), float(clearance), turns=True)
        parts.append(sym.JournalBearing(*rotor[end], **film.sizes, speed=speed).named(end))
        parts.append(sym.ConstantForce(rotor[end][1], -half * GRAVITY))
    for node, mass in discs.items():
        x, y = rotor[f"disc{node}"]
        parts.append(sym.ConstantForce(y, -mass * GRAVITY))
        heavy = spread(draw, 1e-6, 2e-5), speed, float(draw.uniform(0, 6))
        parts.append(sym.Unbalance(x, y, mass, *heavy).named(f"disc{node}"))
    told = f"ROSS's {name}, {own['mass']:.3g} kg"
    bounds = (
        400 * RPM,
        float(draw.uniform(6000, 15000)) * RPM,
    )  # the slowest is below their first critical speeds
    return Machine(sym.combine(parts), "speed", bounds, told)
