"""Stretches of branches that are proven to have no fold."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import periodic as per
import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.proof.proving import row

RPM = math.pi / 30


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """Ranges of a scene's parameter, each with the number of its sheet along the branch."""

    key: str
    scene: str
    parameter: str
    range: tuple[float, float]
    asked: tuple[tuple[float, float, int], ...]
    words: str = ""

    @cached_property
    def section(self) -> Section:
        """The section of the page."""
        return Section(
            title=f"`{self.scene}`, without a fold",
            compute=self._compute,
            context=self._context,
            template="stretches.md.j2",
        )

    def _compute(self, tell: Tell) -> Found:
        system = sym.scene(self.scene)
        begin, end = self.range
        tell("tracing")
        branch = per.trace(system, self.parameter, (min(begin, end), max(begin, end)), start=begin)
        rows = []
        for low, high, sheet in self.asked:
            tell(f"{low:g} to {high:g}")
            point = branch.at(**{self.parameter: (low + high) / 2})[sheet]
            rows.append(self._row(system, point, low, high))
        return Found(numbers={"proven": sum(each["proven"] for each in rows)}, rows=rows)

    def _row(self, system: sym.CompiledSystem, point: per.Point, low: float, high: float) -> dict[str, Any]:
        found = row(system, point, self.parameter, (low, high))
        return {**found, "low": low, "high": high, "motion": "stable" if point.stable else "unstable"}

    def _context(self, kept: Kept) -> Mapping[str, Any]:
        return {"words": self.words, "axis": self.parameter, "table": _shown(kept.rows)}


def _shown(rows: Iterable[Mapping[str, Any]]) -> list[list[str]]:
    return [
        [
            f"{each['low']:.6g} to {each['high']:.6g}",
            f"{each['place']:.6g}",
            each["motion"],
            str(each["ranges"]),
            f"{each['widest']:.0e}",
            f"{each['seconds']:.0f}",
            f"{each['checked']:.0f}",
            "no fold" if each["proven"] else each["says"],
        ]
        for each in rows
    ]


STRETCHES = (
    Stretch(
        key="duffing-stretches",
        scene="duffing",
        parameter="Omega",
        range=(0.3, 3.0),
        asked=((1.99, 2.01, 0), (1.99, 2.01, 1), (1.8, 2.2, 2), (1.438, 1.45, -1)),
        words="The last range holds the fold at 1.43867014551: what is proven ends just above it.",
    ),
    Stretch(
        key="gear-pair-stretches",
        scene="gear-pair",
        parameter="Omega",
        range=(1.4, 0.55),
        asked=((1.2, 1.4, 0), (0.69, 0.71, 0), (0.69, 0.71, 1)),
        words="In contact, and with teeth that part and meet again.",
    ),
    Stretch(
        key="dry-810N-stretches",
        scene="dry-810N",
        parameter="speed",
        range=(50.0, 15.0),
        asked=((300 * RPM, 400 * RPM, 0),),
        words="The disc of 1990 without oil, from 300 to 400 rev/min.",
    ),
    Stretch(
        key="vitrea79-810N-stretches",
        scene="vitrea79-810N",
        parameter="speed",
        range=(50.0, 15.0),
        asked=((390 * RPM, 400 * RPM, 0),),
        words="In oil, from 390 to 400 rev/min.",
    ),
    Stretch(
        key="impact-oscillator-stretches",
        scene="impact-oscillator",
        parameter="A",
        range=(1.0, 0.5),
        asked=((0.85, 0.95, 0),),
    ),
)
"""In the order of the page."""
