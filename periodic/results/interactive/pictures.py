"""What a page shows of anything that says so itself: pictures, and more at each place along them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, Protocol, runtime_checkable

import numpy as np

from periodic.orbit.scheme import Array
from periodic.system import System


class Style(StrEnum):
    """How a line is drawn: through, dashed, as small or large dots, as circles, joined, or from zero up."""

    LINE = "line"
    DASH = "dash"
    DOTS = "dots"
    MARKS = "marks"
    OPEN = "open"
    JOINED = "joined"
    STEMS = "stems"


@dataclass(frozen=True, eq=False)
class Line:
    """A line of a picture.

    across, up: its points (K,), NaN where there is a gap. name: in the legend, if any. colour: which, -1 for
    one that stands behind. of: which place each point belongs to, (K,). texts: beside points.
    """

    across: Array
    up: Array
    style: Style = Style.LINE
    name: str = ""
    colour: int = 0
    of: Sequence[int] = ()
    texts: Sequence[str] = ()


@dataclass(frozen=True, eq=False)
class Picture:
    """Lines over axes with names; log: whether the axis up is logarithmic."""

    across: str
    up: str
    lines: Sequence[Line]
    log: bool = False


@dataclass(frozen=True, eq=False)
class Place:
    """A place along the overviews, at a value of their axis: what is said and drawn of it."""

    at: float
    said: Sequence[str]
    pictures: Sequence[Picture] = ()


@dataclass(frozen=True, eq=False)
class Shown:
    """All that a page shows: what is said of the whole, pictures of it, and its places in order."""

    said: Sequence[str]
    overviews: Sequence[Picture]
    places: Sequence[Place] = field(default_factory=tuple)


@runtime_checkable
class Showable(Protocol):
    """What says what a page shows of it."""

    def shown(self, system: System | None = None) -> Shown:
        """Return it; with its system also what takes its equations."""


def pictured(shown: Shown) -> dict[str, Any]:
    """Return all that the page is made of."""
    places = [
        {"at": _number(p.at), "said": list(p.said), "pictures": [_picture(q) for q in p.pictures]}
        for p in shown.places
    ]
    return {
        "said": list(shown.said),
        "overviews": [_picture(picture) for picture in shown.overviews],
        "places": places,
    }


def _picture(picture: Picture) -> dict[str, Any]:
    lines = [
        {
            "x": [_number(v) for v in np.asarray(line.across, dtype=float)],
            "y": [_number(v) for v in np.asarray(line.up, dtype=float)],
            "style": line.style.value,
            "name": line.name,
            "colour": line.colour,
            "of": [int(k) for k in line.of],
            "texts": list(line.texts),
        }
        for line in picture.lines
    ]
    return {"across": picture.across, "up": picture.up, "log": picture.log, "lines": lines}


def _number(value: float) -> float | None:
    """Seven digits, None for what is no number."""
    return float(f"{float(value):.7g}") if np.isfinite(value) else None
