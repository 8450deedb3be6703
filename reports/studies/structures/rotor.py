"""A rotor of fifty stations on two bearings, over its first two critical speeds."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import numpy as np

import symbolic as sym
from periodic import Branch, Label, Point, trace
from periodic.results.plots.curve import draw_curve
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.pages.figures import PAPER, TRUSTED, panels
from symbolic.scenes.axes import RPM

ELEMENTS = 50
DISCS = (17, 33)
"""Their nodes."""

BEARING, FILM = (5e6, 3e6), 2e3
"""Stiffness in x and y (N/m), damping (N s/m) of each bearing."""

HARDENING = 3e15
"""Cubic stiffness of the second bearing in N/m^3: at 40 um as much again as the linear one in x."""

UNBALANCE = (32.6, 3e-6)
"""Mass (kg) and eccentricity (m) at the first disc."""

STATOR, GAP, SLIP = 1e6, 1e-4, 0.1
"""The ring about the second disc: stiffness (N/m), gap (m), coefficient of friction."""

OIL = {"viscosity": 0.02, "radius": 0.025, "length": 0.025, "clearance": 5e-5}
"""The journal bearing in the second one's place, SI."""

WEIGHT = 9.81 * (32.6 + 11.0)
"""Load on each disc in N: its weight and that of half the shaft."""

SAG = 20.0
"""Load on the second disc in N, downwards."""

KEPT, FEW = 12, 8
"""Modes of the reduced rotor, and of that on a film, which the fastest modes feel: they cost intervals."""

SPEEDS = (60.0, 550.0)
"""Of the branch, rad/s."""


def matrices(bearings: tuple[int, ...] = (0, ELEMENTS)) -> sym.Matrices:
    """Return shaft and discs on linear bearings at some nodes."""
    discs = [sym.ShaftDisc(node=node, mass=32.6, polar=0.33, diametral=0.18) for node in DISCS]
    bare = sym.shaft(length=1.5, diameter=0.05, elements=ELEMENTS, discs=discs)
    damping, stiffness = np.array(bare.C), np.array(bare.K)
    for node in bearings:
        for way, constant in enumerate(BEARING):
            stiffness[4 * node + way, 4 * node + way] += constant
            damping[4 * node + way, 4 * node + way] += FILM
    return sym.Matrices(bare.M, damping, stiffness, bare.G, at=bare.at)


def reduced(*others: int, bearings: tuple[int, ...] = (0, ELEMENTS), kept: int = KEPT) -> sym.Reduction:
    """Return the rotor by some of its modes, and what first disc and other nodes add to them statically."""
    ends = [f"{way}{node}" for node in (DISCS[0], *others) for way in "xy"]
    return sym.residual_modes(matrices(bearings), ends, kept)


def unbalanced(reduction: sym.Reduction, **nodes: int) -> tuple[sym.Model, sym.Structure]:
    """Return the rotor with its unbalance, and as a structure with the nodes that get names as places."""
    at = reduction.matrices.at
    places = {place: (at[f"x{k}"], at[f"y{k}"]) for place, k in {"disc": DISCS[0], **nodes}.items()}
    rotor = sym.Structure(reduction.matrices, at=places, scale=1e-4)
    x, y = rotor["disc"]
    mass, eccentricity = UNBALANCE
    return rotor + sym.Unbalance(x, y, mass, eccentricity), rotor


def system(reduction: sym.Reduction) -> sym.CompiledSystem:
    """Return the rotor with a hardening bearing."""
    model, rotor = unbalanced(reduction, bearing=ELEMENTS)
    x, y = rotor["bearing"]
    return sym.compile(model + sym.CubicSpring(x, HARDENING) + sym.CubicSpring(y, HARDENING))


def rubbing(reduction: sym.Reduction) -> sym.CompiledSystem:
    """Return the rotor with a ring about its second disc, which sags in it."""
    model, rotor = unbalanced(reduction, ring=DISCS[1])
    x, y = rotor["ring"]
    return sym.compile(model + sym.Rub(x, y, STATOR, GAP, SLIP) + sym.ConstantForce(y, -SAG))


def floating(reduction: sym.Reduction) -> sym.CompiledSystem:
    """Return the rotor with a journal bearing, whose film bears its weight."""
    model, rotor = unbalanced(reduction, other=DISCS[1], bearing=ELEMENTS)
    x, y = rotor["bearing"]
    loads = [sym.ConstantForce(rotor[disc][1], -WEIGHT) for disc in ("disc", "other")]
    return sym.compile(model + sym.JournalBearing(x, y, **OIL) + loads[0] + loads[1])


def branch(rotor: sym.CompiledSystem) -> Branch:
    """Return the branch over the first two critical speeds."""
    return trace(rotor, "speed", SPEEDS, start=SPEEDS[0])


def revolutions(point: Point) -> float:
    """Return the speed of a point in rev/min."""
    return point.parameter / RPM


def timed(rotor: sym.CompiledSystem) -> tuple[Branch, float]:
    """Return its branch and the seconds of the processor it took."""
    begin = time.process_time()
    found = branch(rotor)
    return found, time.process_time() - begin


def special(found: Branch) -> list[tuple[str, float]]:
    """Return labels and speeds (rev/min) of the special points."""
    points = [point for point in found.special_points if point.label is not Label.END]
    return [(point.label.value, revolutions(point)) for point in points]


def compute(tell: Tell) -> Found:
    """Return the Campbell diagram of the linear rotor and the branches of the nonlinear ones."""
    tell("Campbell diagram")
    speeds = np.linspace(0.0, 650.0, 53)
    diagram = sym.campbell(matrices(), speeds.tolist(), 6)
    figure, axes_of = panels(2, 2, height=2.6)
    left, *others = axes_of.ravel()
    left.plot(speeds / RPM, diagram.frequencies / (2 * np.pi), color=TRUSTED)
    left.plot(speeds / RPM, speeds / (2 * np.pi), "--", color=PAPER, label="once a revolution")
    left.set(xlabel="speed (rev/min)", ylabel="natural frequency (Hz)", ylim=(0, 130))
    left.legend(frameon=False)
    reductions = {
        "hardening bearing": reduced(ELEMENTS),
        "rub": reduced(DISCS[1]),
        "journal bearing": reduced(DISCS[1], ELEMENTS, bearings=(0,), kept=FEW),
    }
    made = {"hardening bearing": system, "rub": rubbing, "journal bearing": floating}
    rows = []
    for (name, reduction), axes in zip(reductions.items(), others, strict=True):
        tell(name)
        found, took = timed(made[name](reduction))
        across = np.array([revolutions(point) for point in found])
        swing = found.peak_to_peak("disc 1") * 1e6
        draw_curve(axes, across, swing, found.stable_between, color=TRUSTED)
        axes.set(xlabel="speed (rev/min)", ylabel="disc, x peak to peak (µm)", yscale="log", title=name)
        ends = {"points": len(found), "seconds": took, "stop": str(found.stop)}
        error = reduction.error(*SPEEDS)
        rows.append({"name": name, "error": error, "special": special(found), **ends})
    numbers = {f"critical speed {k} (rev/min)": value / RPM for k, value in enumerate(diagram.critical(), 1)}
    return Found(numbers=numbers, rows=rows, figures={"rotor": figure})


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the critical speeds and the special points as text."""
    names = kept.numbers
    told = [", ".join(f"{label} {place:.7g}" for label, place in row["special"]) for row in kept.rows]
    return {
        "critical": [value for name, value in names.items() if name.startswith("critical")],
        "told": told,
        "freedoms": 4 * (ELEMENTS + 1),
        "kept": KEPT,
        "few": FEW,
        "gap": 1e6 * GAP,
        "stator": STATOR,
        "slip": SLIP,
        "oil": OIL,
    }


ROTOR = Section(title="A rotor over two critical speeds", compute=compute, context=context)
