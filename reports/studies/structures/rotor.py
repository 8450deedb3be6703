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

KEPT = 16
"""Modes of the reduced rotor."""

SPEEDS = (60.0, 550.0)
"""Of the branch, rad/s."""


def matrices() -> sym.Matrices:
    """Return shaft and discs on their linear bearings."""
    discs = [sym.ShaftDisc(node=node, mass=32.6, polar=0.33, diametral=0.18) for node in DISCS]
    bare = sym.shaft(length=1.5, diameter=0.05, elements=ELEMENTS, discs=discs)
    damping, stiffness = np.array(bare.C), np.array(bare.K)
    for node in (0, ELEMENTS):
        for way, constant in enumerate(BEARING):
            stiffness[4 * node + way, 4 * node + way] += constant
            damping[4 * node + way, 4 * node + way] += FILM
    return sym.Matrices(bare.M, damping, stiffness, bare.G, at=bare.at)


def reduced() -> sym.Reduction:
    """Return the rotor by some of its modes, and what its places add to them statically."""
    first, _ = DISCS
    ends = [f"{way}{node}" for node in (first, ELEMENTS) for way in "xy"]
    return sym.residual_modes(matrices(), ends, KEPT)


def system(reduction: sym.Reduction) -> sym.CompiledSystem:
    """Return the rotor with a hardening bearing and its unbalance."""
    at = reduction.matrices.at
    names = {"disc": DISCS[0], "bearing": ELEMENTS}
    places = {name: (at[f"x{node}"], at[f"y{node}"]) for name, node in names.items()}
    rotor = sym.Structure(reduction.matrices, at=places, scale=1e-4)
    x, y = rotor["disc"]
    mass, eccentricity = UNBALANCE
    model = rotor + sym.Unbalance(x, y, mass, eccentricity)
    for place in rotor["bearing"]:
        model = model + sym.CubicSpring(place, HARDENING)
    return sym.compile(model)


def branch(rotor: sym.CompiledSystem) -> Branch:
    """Return the branch over the first two critical speeds."""
    return trace(rotor, "speed", SPEEDS, start=SPEEDS[0])


def revolutions(point: Point) -> float:
    """Return the speed of a point in rev/min."""
    return point.parameter / RPM


def compute(tell: Tell) -> Found:
    """Return the Campbell diagram of the linear rotor and the branch of the nonlinear one."""
    tell("Campbell diagram")
    speeds = np.linspace(0.0, 650.0, 53)
    diagram = sym.campbell(matrices(), speeds.tolist(), 6)
    reduction = reduced()
    tell("branch")
    begin = time.process_time()
    found = branch(system(reduction))
    took = time.process_time() - begin
    figure, (left, right) = panels(1, 2, height=3.2)
    left.plot(speeds / RPM, diagram.frequencies / (2 * np.pi), color=TRUSTED)
    left.plot(speeds / RPM, speeds / (2 * np.pi), "--", color=PAPER, label="once a revolution")
    left.set(xlabel="speed (rev/min)", ylabel="natural frequency (Hz)", ylim=(0, 130))
    left.legend(frameon=False)
    across = np.array([revolutions(point) for point in found])
    swing = found.peak_to_peak("disc 1") * 1e6
    draw_curve(right, across, swing, found.stable_between, color=TRUSTED)
    right.set(xlabel="speed (rev/min)", ylabel="disc, x peak to peak (µm)", yscale="log")
    folds = found.labelled(Label.FOLD)
    numbers = {f"critical speed {k} (rev/min)": value / RPM for k, value in enumerate(diagram.critical(), 1)}
    numbers |= {f"fold {k} (rev/min)": revolutions(point) for k, point in enumerate(folds, 1)}
    numbers |= {"points": float(len(found)), "seconds": took, "error": reduction.error(*SPEEDS)}
    return Found(numbers=numbers, figures={"rotor": figure})


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the critical speeds and the folds."""
    names = kept.numbers
    return {
        "critical": [value for name, value in names.items() if name.startswith("critical")],
        "folds": [value for name, value in names.items() if name.startswith("fold")],
        "freedoms": 4 * (ELEMENTS + 1),
        "kept": KEPT,
    }


ROTOR = Section(title="A rotor over two critical speeds", compute=compute, context=context)
