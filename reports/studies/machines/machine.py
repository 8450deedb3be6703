"""A machine of the report: its scene, its branch, what is known of it, marching, a second parameter."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

import symbolic as sym
from periodic import Branch, Label, Point, trace
from reports.studies.machines.figures import Curve, View, diagram, over_two, spectra
from reports.studies.pages.content import Found, Kept, Section, Tell
from symbolic.scenes.axes import RPM

SETTLED = 1e-3
"""Relative change of a peak to peak over a period up to which a simulated motion has settled."""


@dataclass(frozen=True, kw_only=True)
class Known:
    """A number that others have found, and how ours is read from the branch."""

    name: str
    value: float
    ours: Callable[[Branch], float]


@dataclass(frozen=True, kw_only=True)
class Machine:
    """A scene and what the report shows of it.

    unit: SI value of one unit of the axis; size: of one unit of the peak to peak shown, that of `output`.
    marched: values of the parameter at which time integration is run, settle: its periods.
    """

    key: str
    title: str
    parameter: str
    axis: str
    range: tuple[float, float]
    output: str = "x"
    swing: str = "x peak to peak"
    unit: float = 1.0
    size: float = 1.0
    at: tuple[float, ...] = ()
    marched: tuple[float, ...] = ()
    settle: int = 300
    words: str
    known: tuple[Known, ...] = ()
    two: Callable[[Machine, Branch], Curve] | None = None
    waterfall: bool = False

    @property
    def section(self) -> Section:
        """The section of the page."""
        return Section(title=self.title, compute=self.compute, context=self.context, template="machine.md.j2")

    @cached_property
    def system(self) -> sym.CompiledSystem:
        """The system of the scene."""
        return sym.scene(self.key)

    def branch(self) -> Branch:
        """Trace the branch of the scene over its range."""
        begin, end = (value * self.unit for value in self.range)
        at = tuple(value * self.unit for value in self.at)
        bounds = (min(begin, end), max(begin, end))
        return trace(self.system, self.parameter, bounds, start=begin, at=at)

    def compute(self, tell: Tell) -> Found:
        """Trace the branch, march beside it, and follow a special point over a second parameter."""
        tell("branch")
        found = self.branch()
        marched = []
        for value in self.marched:
            tell(f"time integration at {value:g}")
            marched.append((value, self.simulated(value)))
        view = View(self.output, (self.axis, self.swing), self.unit, self.size)
        figures = {self.key: diagram(view, found, marched)}
        if self.two is not None:
            tell("a curve in two parameters")
            figures[f"{self.key}-two"] = over_two(self.two(self, found))
        if self.waterfall:
            figures[f"{self.key}-waterfall"] = spectra(view, found)
        return Found(numbers=self.numbers(found), rows=[self.row(p) for p in special(found)], figures=figures)

    def simulated(self, value: float) -> float | None:
        """Return the peak to peak to which the motion from rest settles, None where it does not."""
        values = {self.parameter: value * self.unit}
        motion = sym.simulate(self.system, values, settle=self.settle, periods=2)[self.output]
        first, second = (float(np.ptp(half)) for half in np.array_split(motion, 2))
        return second / self.size if abs(first - second) < SETTLED * second else None

    def numbers(self, found: Branch) -> dict[str, float]:
        """Return our values of the known numbers."""
        return {known.name: float(known.ours(found)) for known in self.known}

    def row(self, point: Point) -> dict[str, Any]:
        """Return the row of a special point."""
        largest = point.multipliers[0]
        return {
            "label": point.label.value,
            "place": point.parameter / self.unit,
            "swing": point.peak_to_peak(self.output) / self.size,
            "multiplier": f"{abs(largest):.6f}"
            + (f" at {abs(np.angle(largest)):.6f}" if abs(largest.imag) > 1e-9 else ""),
        }

    def context(self, kept: Kept) -> Mapping[str, Any]:
        """Return what the template is given."""
        known = [(k.name, k.value, kept.numbers[k.name]) for k in self.known]
        table = [
            (name, f"{value:.10g}", f"{ours:.10g}", f"{ours / value - 1:.1e}") for name, value, ours in known
        ]
        return {
            "key": self.key,
            "title": self.title,
            "words": self.words,
            "axis": self.axis,
            "swing": self.swing,
            "known": table,
            "marched": bool(self.marched),
            "two": self.two is not None,
            "waterfall": self.waterfall,
        }


def special(found: Branch) -> list[Point]:
    """Return the special points but for the ends and those asked for."""
    return [p for p in found.special_points if p.label.value not in ("EP", "UZ")]


def place(label: Label, count: int, unit: float = 1.0) -> Callable[[Branch], float]:
    """Return what reads the place of a branch's special point, counted from 0 along it."""
    return lambda found: found.labelled(label)[count].parameter / unit


def swing(value: float, output: str, size: float) -> Callable[[Branch], float]:
    """Return what reads a peak to peak at a value (SI) that was asked for."""

    def read(found: Branch) -> float:
        points = found.labelled(Label.USER)
        return min(points, key=lambda p: abs(p.parameter - value)).peak_to_peak(output) / size

    return read


def rpm(value: float) -> float:
    """Return rad/s of rev/min."""
    return value * RPM
