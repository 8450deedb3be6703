"""What a page shows of a branch, as numbers ready for JSON."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from typing import Any

import numpy as np

from periodic.checks import named
from periodic.orbit.layout import Quantity
from periodic.orbit.scheme import Array
from periodic.results.branch import Branch
from periodic.results.point import Point

SAMPLES = 128
"""Values of each signal over a period."""

MOST = 600
"""Points that a page holds; special points are kept in any case."""

Units = Mapping[str, tuple[str, float]]


def content(branch: Branch, units: Units) -> dict[str, Any]:
    """Return all that the page is made of."""
    shown = Shown(branch, units)
    points = [branch.points[k] for k in kept(branch)]
    return {
        "parameter": shown.described(branch.parameter),
        "signals": [shown.described(name) for name in shown.signals],
        "pairs": shown.pairs,
        "outputs": [shown.described(name) for name in shown.outputs],
        "samples": SAMPLES,
        "stop": str(branch.stop),
        "points": [shown.point(p) for p in points],
        "orbits": packed(np.array([shown.orbit(p) for p in points])),
    }


def kept(branch: Branch) -> list[int]:
    """Return which points are shown: all, or special ones and every k-th of the others."""
    every = -(-len(branch) // MOST)
    last = len(branch) - 1
    return [k for k, p in enumerate(branch.points) if k % every == 0 or k == last or p.label.value]


def packed(values: Array) -> str:
    """Return numbers as base64 of their 32-bit floats."""
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode()


class Shown:
    """The quantities of a branch in the units that they are shown in."""

    def __init__(self, branch: Branch, units: Units) -> None:
        self.branch, layout = branch, branch.layout
        self.outputs = [q.name for q in layout.outputs]
        self.signals = list(branch.points[0].orbit.names)
        self.velocities = {f"{name}'" for name in self.signals} & set(self.signals)
        known = {q.name: q for q in (*layout.outputs, *layout.parameters, *layout.states, *layout.algebraics)}
        self._known: dict[str, Quantity] = known
        for name in named("units", units, "units"):
            if name not in known:
                raise ValueError(f"units has {name!r}; its names must be among {', '.join(known)}")
        self._units = units

    @property
    def pairs(self) -> list[tuple[int, int]]:
        """Which signals make the phase planes: a state and its velocity, else neighbours."""
        found = [
            (k, self.signals.index(f"{name}'"))
            for k, name in enumerate(self.signals)
            if f"{name}'" in self.velocities
        ]
        return found or [(k, k + 1) for k in range(len(self.signals) - 1)]

    def described(self, name: str) -> dict[str, str]:
        """Return a quantity's name and the unit it is shown in."""
        base = name.removesuffix("'") if name in self.velocities else name
        unit = self._units[base][0] if base in self._units else self._known[base].unit
        return {"name": name, "unit": f"{unit}/s" if name in self.velocities and unit else unit}

    def factor(self, name: str) -> float:
        """Return the SI value of the unit a quantity is shown in."""
        base = name.removesuffix("'") if name in self.velocities else name
        return self._units[base][1] if base in self._units else 1.0

    def point(self, point: Point) -> dict[str, Any]:
        """Return what is said of a point."""
        sizes = [_rounded(point.peak_to_peak(name) / self.factor(name)) for name in self.outputs]
        multipliers = point.multipliers[:40]
        return {
            "at": point.parameter / self.factor(self.branch.parameter),
            "label": point.label.value or point.event,
            "stable": point.stable,
            "sizes": sizes,
            "most": [_rounded(point.maximum[name] / self.factor(name)) for name in self.outputs],
            "period": _rounded(point.orbit.period),
            "multipliers": [[_rounded(m.real), _rounded(m.imag)] for m in multipliers],
            "equilibrium": point.equilibrium,
        }

    def orbit(self, point: Point) -> Array:
        """Return the signals over a period, shape (signals, samples)."""
        orbit = point.orbit
        times = np.linspace(0, orbit.period, SAMPLES, endpoint=False)
        return np.array([orbit[name](times) / self.factor(name) for name in self.signals])


def _rounded(value: float) -> float | None:
    """Six digits; None for what is no number."""
    return float(f"{value:.6g}") if np.isfinite(value) else None
