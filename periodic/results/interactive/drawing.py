"""The drawing of a system that a page moves: the shapes of `System.sketch`, as far as the page knows them.

A shape is plain data. Its x, y, size and depth are lengths {"fixed": f, "moved": [[name, factor], ...]}: f,
in units of the drawing, plus the outputs and parameters named times their factors, all magnified alike.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from periodic.condensed.whole.displacements import displacements
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.results.plots.units import prefixed
from periodic.results.point import Point
from periodic.system import System

LENGTHS = ("x", "y", "size", "depth")

SHAPE_INSTANTS, MOST_NODES = 32, 20
"""Instants of a period at which the shape of a structure is drawn, and its largest number of nodes."""

LARGEST_MOVEMENT = 0.4
"""Magnified size of the largest movement, in units of the drawing."""


def sketch_of(system: object) -> list[dict[str, Any]]:
    """Return the shapes of a system; few have any that are not made by `symbolic.compile`."""
    return [dict(shape) for shape in getattr(system, "sketch", ())]


def drawing(
    shapes: Sequence[Mapping[str, Any]],
    points: Sequence[Point],
    signals: Mapping[str, tuple[int, float]],
    orbits: Array,
    units: Mapping[str, str],
    system: System | None,
) -> dict[str, Any] | None:
    """Return what the page needs to draw; None where nothing can be drawn.

    Parameters
    ----------
    shapes : sequence of dict
        The shapes.
    points : sequence of Point
        The points that are shown.
    signals : dict of str to (int, float)
        Index of each output on the page, and the SI value of its unit there.
    orbits : ndarray, shape (points, signals, samples)
        Its signals.
    units : dict of str to str
        Units in SI by name, for the scale.
    system : System, optional
        The system, which knows where a structure is between its places.
    """
    names = {name for shape in shapes for key in LENGTHS for name, _ in shape[key]["moved"]}
    parameters = [p.orbit.parameters for p in points]
    shapes = [_deflected(shape, points, system) for shape in shapes]
    deflections = [np.abs(shape["values"]).max() for shape in shapes if shape["kind"] == "line"]
    numbers = {name: [float(known[name]) for known in parameters] for name in names if name in parameters[0]}
    if not shapes or not names <= set(signals) | set(numbers):
        return None
    swings = [
        abs(signals[name][1]) * np.abs(orbits[:, signals[name][0]]).max() for name in names & set(signals)
    ]
    sizes = [*swings, *deflections, *(max(map(abs, values)) for values in numbers.values())]
    largest = max(sizes, default=0.0) or 1.0
    return {
        "shapes": [{**s, "values": packed(s["values"])} if s["kind"] == "line" else s for s in shapes],
        "signals": {name: [*signals[name]] for name in names & set(signals)},
        "numbers": numbers,
        "magnified": LARGEST_MOVEMENT / largest,
        "bar": _bar(largest, units.get(shapes[0]["of"][0], "")),
    }


def _deflected(shape: Mapping[str, Any], points: Sequence[Point], system: System | None) -> dict[str, Any]:
    """Return a shape; that of a structure with its deflections, shape (points, nodes, STEPS)."""
    if shape["kind"] != "line" or system is None:
        return dict(shape)
    every = -(-len(shape["nodes"]) // MOST_NODES)
    nodes = [*shape["nodes"][:-1:every], shape["nodes"][-1]]
    values = np.array([_deflections(p.orbit, nodes, shape["structure"], system) for p in points])
    return {**shape, "nodes": nodes, "values": values}


def _deflections(orbit: Orbit, nodes: Sequence[tuple[str, int]], structure: str, system: System) -> Array:
    """Displacements of nodes over a period (SI), shape (nodes, STEPS)."""
    phases = np.linspace(0, orbit.mesh.period, SHAPE_INSTANTS, endpoint=False)
    return displacements(system, orbit, nodes, phases, structure).T


def packed(values: Array) -> str:
    """Return numbers as base64 of their 32-bit floats."""
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode()


def _bar(largest: float, unit: str) -> dict[str, Any]:
    """The scale bar, a round length near the largest movement: its length as drawn, and its text."""
    power = 10.0 ** np.floor(np.log10(largest))
    length = max(step * power for step in (1, 2, 5) if step * power <= largest * (1 + 1e-9))
    shown = prefixed(unit, length)
    return {
        "length": LARGEST_MOVEMENT * length / largest,
        "text": f"{length / shown.size:g} {shown.text}".strip(),
    }
