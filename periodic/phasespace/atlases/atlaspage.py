"""What the page of an atlas shows: its curves and shares, and at each value the motions there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.atlases.sheet import Sheet
from periodic.phasespace.atlases.stretches import LETTERS, PLAIN
from periodic.phasespace.motion import Motion, Motions
from periodic.results.interactive.pictures import Line, Picture, Place, Shown, Style
from periodic.results.point import Point

FINE = 2e-3
"""Dots that differ by less than this part of the range are one."""

MOST = 400
"""Most states of a motion that are drawn."""


class Charted(Protocol):
    """An atlas."""

    @property
    def across(self) -> str: ...
    @property
    def up(self) -> str: ...
    @property
    def values(self) -> Array: ...
    @property
    def motions(self) -> Sequence[Motions]: ...
    @property
    def sheets(self) -> Sequence[Sheet]: ...
    @property
    def dots(self) -> Array: ...
    @property
    def box(self) -> dict[str, tuple[float, float]]: ...

    def state_of(self, point: Point, phase: float) -> float:
        """The state that is shown, of an orbit at a phase."""


def shown(atlas: Charted) -> Shown:
    """Return all that the page shows."""
    curves = Picture(atlas.across, atlas.up, [_dots(atlas), *_curves(atlas)])
    shares = Picture(atlas.across, "share of the box, %", _shares(atlas))
    return Shown(
        str(atlas).splitlines(), [curves, shares], [_place(atlas, k) for k in range(len(atlas.values))]
    )


def _nearest(atlas: Charted, values: Array) -> list[int]:
    """At which of the atlas's values something is shown."""
    return [int(k) for k in np.abs(atlas.values[:, None] - np.asarray(values)).argmin(axis=0)]


def _dots(atlas: Charted) -> Line:
    """What is seen from many starts, each dot once."""
    across, up = atlas.dots.T
    fine = np.round(up / max(np.ptp(up) if len(up) else 0.0, np.finfo(float).tiny) / FINE)
    _, first = np.unique(np.column_stack([across, fine]), axis=0, return_index=True)
    name = "settled motions"
    return Line(across[first], up[first], Style.DOTS, name, -1, _nearest(atlas, across[first]))


def _curves(atlas: Charted) -> list[Line]:
    """Each branch: stable parts drawn through, others dashed, special points marked."""
    lines = []
    for k, sheet in enumerate(atlas.sheets):
        points = list(sheet.branch)
        for number in range(sheet.periods):
            heights = np.array([atlas.state_of(point, FORCED * number) for point in points])
            across, up, stable = sheet.curve(heights)
            of = _nearest(atlas, across)
            for kind, style in ((stable, Style.LINE), (~stable, Style.DASH)):
                near = kind.copy()
                near[1:] |= kind[:-1]
                name = f"{k + 1}: {sheet.name}" if number == 0 and style == Style.LINE else ""
                lines.append(Line(across, np.where(near, up, np.nan), style, name, k, of))
            special = [i for i, point in enumerate(points) if str(point.label) not in PLAIN]
            texts = [str(points[i].label) for i in special]
            at = sheet.branch.values[special]
            lines.append(Line(at, heights[special], Style.OPEN, "", k, _nearest(atlas, at), texts))
    return lines


def _shares(atlas: Charted) -> list[Line]:
    """The share of each stable stretch over the values."""
    lines: list[Line] = []
    for k, sheet in enumerate(atlas.sheets):
        for letter, shares in zip(LETTERS, sheet.shares, strict=False):
            if shares.any():
                up, name = np.where(shares > 0, 100 * shares, np.nan), f"{k + 1}{letter}"
                lines.append(Line(atlas.values, up, Style.JOINED, name, len(lines), range(len(up))))
    other = np.array([sum(m.share for m in found.stable if m.point is None) for found in atlas.motions])
    if other.any():
        up = np.where(other > 0, 100 * other, np.nan)
        lines.append(Line(atlas.values, up, Style.JOINED, "tori and chaos", len(lines), range(len(other))))
    return lines


def _place(atlas: Charted, k: int) -> Place:
    """What is said and drawn of the motions at a value."""
    found, names = atlas.motions[k], list(atlas.box)
    said = [f"{atlas.across} = {atlas.values[k]:.9g}", *_rows(found.motions), *found.tried]
    if len(names) < 2:
        return Place(float(atlas.values[k]), said)
    lines = [_states(found.units, number, motion) for number, motion in enumerate(found)]
    return Place(
        float(atlas.values[k]),
        said,
        [Picture(f"{names[0]} at tau = 0 (SI)", f"{names[1]} at tau = 0 (SI)", lines)],
    )


def _rows(motions: Sequence[Motion]) -> list[str]:
    """Each motion in a line."""
    shares = [f"{100 * motion.share:.1f} % of the box" if motion.starts else "" for motion in motions]
    each = (
        (f"{k}: {motion.name}", share, motion.tells)
        for k, (motion, share) in enumerate(zip(motions, shares, strict=True), 1)
    )
    return [", ".join(filter(None, texts)) for texts in each]


def _states(units: Array, number: int, motion: Motion) -> Line:
    """A motion once in each period: small dots where it does not come back, circles where unstable."""
    states = (motion.sections[-MOST:] * units)[:, :2]
    style = Style.DOTS if not motion.comes_back else Style.MARKS if motion.stable else Style.OPEN
    return Line(states[:, 0], states[:, 1], style, f"{number + 1}", number)
