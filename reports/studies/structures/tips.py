"""Three nonlinear tips of a beam of ten elements: a cubic spring, a stop, friction."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

import symbolic as sym
from periodic import Branch, Point, trace
from periodic.results.plots.curve import draw_curve
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.pages.figures import TRUSTED, panels
from reports.studies.structures.beams import cantilever, cubic

HISTORY = 400
"""Instants of a time history."""

STOP = "beam-stop"
"""The scene of the stop: six times as stiff as the tip."""


def friction(tip: Any) -> sym.Part:
    """Dry friction, smooth over a velocity of 0.05."""
    return sym.TanhFriction(tip, 0.02, 0.05)


@dataclass(frozen=True, kw_only=True)
class Tip:
    """What sits at a tip: the system, the output, the range of Omega and where the history is (rad/s)."""

    made: Callable[[], sym.CompiledSystem]
    output: str
    range: tuple[float, float]
    at: float

    def branch(self) -> Branch:
        """Return its branch over the first resonance."""
        bounds = min(self.range), max(self.range)
        return trace(self.made(), "Omega", bounds, start=self.range[0], at=self.at)


HERTZ = 2 * np.pi

TIPS_OF: Mapping[str, Tip] = {
    "cubic spring": Tip(made=lambda: cantilever(10, cubic), output="tip", range=(2.0, 8.0), at=5.0),
    "stop": Tip(made=lambda: sym.scene(STOP), output="tip", range=(16 * HERTZ, 26 * HERTZ), at=19.5 * HERTZ),
    "friction": Tip(
        made=lambda: cantilever(10, friction, force=0.05), output="tip", range=(2.5, 4.5), at=3.5
    ),
}


def largest(found: Branch, tip: Tip) -> Point:
    """Return the point with the largest motion among those asked for."""
    asked = [point for point in found.labelled("UZ") if np.isclose(point.parameter, tip.at)]
    return max(asked, key=lambda point: point.peak_to_peak(tip.output))


def compute(tell: Tell) -> Found:
    """Trace each branch, and draw it beside a period of the tip's motion."""
    figure, axes = panels(len(TIPS_OF), 2, height=2.4)
    numbers: dict[str, float] = {}
    rows: list[dict[str, Any]] = []
    for (name, tip), (left, right) in zip(TIPS_OF.items(), axes, strict=True):
        tell(name)
        found = tip.branch()
        across = np.array([point.parameter for point in found])
        draw_curve(left, across, found.peak_to_peak(tip.output), found.stable_between, color=TRUSTED)
        point = largest(found, tip)
        left.plot(point.parameter, point.peak_to_peak(tip.output), "o", color="k", markersize=4)
        left.set(xlabel="Ω (rad/s)", ylabel="tip, peak to peak (m)", title=name)
        time = np.linspace(0.0, point.orbit.period, HISTORY)
        right.plot(time, point.orbit[tip.output](time), color=TRUSTED)
        right.set(xlabel="time (s)", ylabel="tip (m)")
        numbers[f"{name}: tip peak to peak (m)"] = point.peak_to_peak(tip.output)
        special = [p for p in found.special_points if p.label.value not in ("EP", "UZ")]
        rows.append(
            {
                "name": name,
                "points": len(found),
                "intervals": max(p.orbit.mesh.ntst for p in found),
                "special": [(p.label.value, p.parameter) for p in special],
                "stop": str(found.stop),
            }
        )
    return Found(numbers=numbers, rows=rows, figures={"tips": figure})


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the special points as text."""
    told = [", ".join(f"{label} {place:.8g}" for label, place in row["special"]) for row in kept.rows]
    return {"told": told}


TIPS = Section(title="Three nonlinear tips", compute=compute, context=context)
