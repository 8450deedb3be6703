"""What a page shows of a branch, as numbers ready for JSON."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from periodic.orbit.extrema import outputs
from periodic.orbit.scheme import Array
from periodic.results.branch import Branch
from periodic.results.interactive.drawing import drawing, packed, sketch_of
from periodic.results.plots.regions import second_of
from periodic.results.plots.units import Shown, Unit, Units, quantities
from periodic.results.point import Point
from periodic.system import System

SAMPLES = 128
"""Values of each signal over a period."""

PIECES = 4
"""Pieces in which curves are drawn from a point to the next."""

MOST_POINTS = 600
"""Points that a page holds; special points are kept in any case."""


def content(
    branch: Branch, units: Units, system: System | None = None, notes: Mapping[Point, str] | None = None
) -> dict[str, Any]:
    """Return all that the page is made of."""
    noted = notes or {}
    points = [branch.points[k] for k in kept(branch, noted)]
    signals = Signals(branch, system)
    values = np.array([signals.values(p) for p in points])
    shown = Shown(quantities(branch.layout), units)
    scales = [shown.unit(name, values[:, k]) for k, name in enumerate(signals.names)]
    orbits = values / np.array([unit.size for unit in scales])[:, None]
    heights = Heights(branch, shown)
    across = shown.unit(branch.parameter, branch.values)
    places = {name: (k, unit.size) for k, (name, unit) in enumerate(zip(signals.names, scales, strict=True))}
    return {
        "parameter": {"name": branch.parameter, "unit": across.text},
        "signals": [{"name": n, "unit": u.text} for n, u in zip(signals.names, scales, strict=True)],
        "pairs": signals.pairs,
        "heights": heights.described,
        "samples": SAMPLES,
        "parts": PIECES,
        "stop": str(branch.stop),
        "border": second_of(branch) is not None,
        "points": [_said(p, across, heights) | {"note": noted.get(p, "")} for p in points],
        "curves": heights.curves(branch, across) if len(points) == len(branch) else None,
        "orbits": packed(orbits),
        "drawing": drawing(sketch_of(system), points, places, orbits, quantities(branch.layout), system),
    }


def kept(branch: Branch, notes: Collection[Point] = ()) -> list[int]:
    """Return which points are shown: all, or special ones, those with notes and every k-th of the others."""
    every = -(-len(branch) // MOST_POINTS)
    last = len(branch) - 1
    return [
        k for k, p in enumerate(branch.points) if k % every == 0 or k == last or p.label.value or p in notes
    ]


class Signals:
    """What is shown over time: states, unknowns and, where the system is at hand, its other outputs."""

    def __init__(self, branch: Branch, system: System | None) -> None:
        self._system, self._states = system, list(branch.points[0].orbit.names)
        found = [] if system is None else [q.name for q in system.outputs]
        self._columns = [k for k, name in enumerate(found) if name not in self._states]
        self.names = [*self._states, *(found[k] for k in self._columns)]

    @property
    def pairs(self) -> list[tuple[int, int]]:
        """Which signals make the phase planes: states and velocities, then the others over the first."""
        index = {name: k for k, name in enumerate(self.names)}
        moving = [(k, index[f"{name}'"]) for name, k in index.items() if f"{name}'" in index]
        used = {k for pair in moving for k in pair}
        return moving + [(0, k) for k in range(1, len(self.names)) if k not in used]

    def values(self, point: Point) -> Array:
        """Return the signals over a period (SI), shape (signals, samples)."""
        orbit = point.orbit
        if orbit.equilibrium:
            times = np.zeros(SAMPLES)
        else:
            times = np.linspace(0, orbit.period, SAMPLES, endpoint=False)
        found = [orbit[name](times) for name in self._states]
        if self._system is not None and self._columns:
            tau = np.zeros(SAMPLES) if orbit.equilibrium else orbit.omega * times
            found += list(outputs(self._system, orbit, tau)[:, self._columns].T)
        return np.array(found)


class Heights:
    """What may be plotted over the parameter: outputs and, of curves in two parameters, the second one."""

    def __init__(self, branch: Branch, shown: Shown) -> None:
        still = all(point.equilibrium for point in branch)
        self._second = second_of(branch)
        self._outputs = [q.name for q in branch.layout.outputs]
        columns = {} if self._second is None else {self._second: branch.column(self._second)}
        for name in self._outputs:
            columns[name] = np.array([p.maximum[name] if still else p.peak_to_peak(name) for p in branch])
        self._still = still
        self._units = {name: shown.unit(name, values) for name, values in columns.items()}

    @property
    def described(self) -> list[dict[str, str]]:
        """Name, unit and what is measured of each."""
        plain = {self._second} if not self._still else set(self._units)
        return [
            {"name": name, "unit": unit.text, "said": name if name in plain else f"{name} peak to peak"}
            for name, unit in self._units.items()
        ]

    def curves(self, branch: Branch, across: Unit) -> list[list[list[float | None]]]:
        """Return x and y of the curve of each, PIECES values from a point to the next."""
        found = []
        for name, unit in self._units.items():
            plain = name == self._second or self._still
            x, y = branch.curve(name if plain else f"{name} p-p", PIECES)
            found.append([[_rounded(v) for v in (x / across.size)], [_rounded(v) for v in (y / unit.size)]])
        return found

    def of(self, point: Point) -> list[float | None]:
        """Return the heights of a point."""
        found = []
        for name, unit in self._units.items():
            if name == self._second:
                value = point.orbit.parameters[name]
            else:
                value = point.maximum[name] if self._still else point.peak_to_peak(name)
            found.append(_rounded(value / unit.size))
        return found


def _said(point: Point, across: Unit, heights: Heights) -> dict[str, Any]:
    """Return what is said of a point."""
    multipliers = point.multipliers[:40]
    still = point.equilibrium
    return {
        "at": point.parameter / across.size,
        "label": point.event or point.label.value,
        "stable": point.stable,
        "heights": heights.of(point),
        "period": None if still else _rounded(point.orbit.period),
        "periods": 1 if still else max(point.orbit.periods, 1),
        "multipliers": [[_rounded(m.real), _rounded(m.imag)] for m in multipliers],
        "equilibrium": still,
    }


def _rounded(value: float) -> float | None:
    """A value to six digits; None where it is not finite."""
    return float(f"{value:.6g}") if np.isfinite(value) else None
