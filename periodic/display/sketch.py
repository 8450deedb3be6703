"""A small picture of curves as SVG, in the colour of the text around it: no library draws it."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.display.htmltables import AS_IT_IS

WIDTH, HEIGHT = 380.0, 210.0
LEFT, RIGHT, ABOVE, BELOW = 58.0, 14.0, 14.0, 36.0
"""The picture, and the margins of its frame."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Line:
    """A stretch of a curve; a dashed one is unstable."""

    x: Array
    y: Array
    dashed: bool = False


@dataclass(frozen=True)
class Mark:
    """A point with a name."""

    x: float
    y: float
    name: str


def sketch(lines: Sequence[Line], marks: Sequence[Mark], xlabel: str, ylabel: str) -> str:
    """Return the picture of lines and marks; nothing where there is no finite point."""
    points = np.column_stack(
        [np.concatenate([getattr(line, axis) for line in lines] or [[]]) for axis in "xy"]
    )
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        return ""
    frame = Frame(tuple(points.min(axis=0)), tuple(points.max(axis=0)))
    drawn = [frame.box(), *(frame.line(line) for line in lines), *(frame.mark(mark) for mark in marks)]
    return (
        f"<svg {AS_IT_IS} viewBox='0 0 {WIDTH:g} {HEIGHT:g}' width='{WIDTH:g}' role='img' font-size='11' "
        f"fill='currentColor'>{''.join(drawn)}{frame.labels(xlabel, ylabel)}</svg>"
    )


@dataclass(frozen=True)
class Frame:
    """Where numbers lie in the picture."""

    low: tuple[float, ...]
    high: tuple[float, ...]

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Return the place of a point."""
        across, up = (
            (value - low) / (high - low) if high > low else 0.5
            for value, low, high in zip((x, y), self.low, self.high, strict=True)
        )
        return LEFT + across * (WIDTH - LEFT - RIGHT), HEIGHT - BELOW - up * (HEIGHT - ABOVE - BELOW)

    def box(self) -> str:
        """Return the frame."""
        width, height = WIDTH - LEFT - RIGHT + 8, HEIGHT - ABOVE - BELOW + 8
        return (
            f"<rect x='{LEFT - 4:g}' y='{ABOVE - 4:g}' width='{width:g}' height='{height:g}' "
            f"fill='none' stroke='currentColor' stroke-opacity='0.35'/>"
        )

    def line(self, line: Line) -> str:
        """Return a line."""
        there = [self.at(x, y) for x, y in zip(line.x, line.y, strict=True) if np.isfinite([x, y]).all()]
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in there)
        dashes = " stroke-dasharray='5 3'" if line.dashed else ""
        return f"<polyline points='{points}' fill='none' stroke='#1f77d0' stroke-width='1.7'{dashes}/>"

    def mark(self, mark: Mark) -> str:
        """Return a mark, its name on the side where there is room."""
        x, y = self.at(mark.x, mark.y)
        left = x > WIDTH - RIGHT - 30
        anchor, shift = ("end", -5) if left else ("start", 5)
        name = html.escape(mark.name)
        return (
            f"<circle cx='{x:.1f}' cy='{y:.1f}' r='2.6' fill='#c0392b'/>"
            f"<text x='{x + shift:.1f}' y='{y - 4:.1f}' text-anchor='{anchor}'>{name}</text>"
        )

    def labels(self, xlabel: str, ylabel: str) -> str:
        """Return the ends of both axes, and what they are."""
        bottom, middle = HEIGHT - BELOW + 17, (LEFT + WIDTH - RIGHT) / 2
        texts = [
            (LEFT, bottom, "start", f"{self.low[0]:.4g}"),
            (WIDTH - RIGHT, bottom, "end", f"{self.high[0]:.4g}"),
            (LEFT - 7, HEIGHT - BELOW + 4, "end", f"{self.low[1]:.3g}"),
            (LEFT - 7, ABOVE + 4, "end", f"{self.high[1]:.3g}"),
            (middle, HEIGHT - 5, "middle", xlabel),
        ]
        written = [
            f"<text x='{x:g}' y='{y:g}' text-anchor='{anchor}'>{html.escape(text)}</text>"
            for x, y, anchor, text in texts
        ]
        up = (HEIGHT - BELOW + ABOVE) / 2
        turned = f"<text transform='translate(12 {up:g}) rotate(-90)' text-anchor='middle'>"
        return "".join(written) + turned + html.escape(ylabel) + "</text>"
