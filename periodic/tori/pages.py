"""What the pages of tori show: a family over its parameter, of each torus section, motion, spectrum."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from periodic.display.htmltables import with_unit
from periodic.orbit.scheme import Array
from periodic.results.interactive.pictures import Line, Picture, Place, Shown, Style
from periodic.system import System
from periodic.tori.averages import in_time
from periodic.tori.combinations import combinations
from periodic.tori.section import Section
from periodic.tori.toruspoint import TorusPoint

ANGLES = 241
"""Places round a section, both ends included."""

PERIODS, SAMPLES = 12, 24
"""Periods of a motion in time, and samples in each."""

MOST = 60
"""Most tori of a family whose places are shown; special ones are not left out."""

MULTIPLIERS = 3
"""The largest of them, whose moduli are shown."""


def torus_shown(torus: Section, system: System | None) -> Shown:
    """Return what the page of one torus shows."""
    return Shown(torus_said(torus), torus_pictures(torus, system))


def family_shown(
    said: Sequence[str],
    points: Sequence[TorusPoint],
    titles: Sequence[str],
    released: str,
    system: System | None,
) -> Shown:
    """Return what the page of a family shows; titles: of its parameter, and of the one that is released."""
    step = -(-len(points) // MOST)
    chosen = [k for k, p in enumerate(points) if k % step == 0 or p.label or k == len(points) - 1]
    of = [int(np.abs(np.array(chosen) - k).argmin()) for k in range(len(points))]
    places = [_place(points[k], system) for k in chosen]
    pictures = [
        Picture(titles[0], up, _lines(points, each, of)) for up, each in _measures(points, titles, released)
    ]
    return Shown(said, pictures, places)


def torus_said(torus: Section) -> list[str]:
    """Return what is known of a torus, in words."""
    first, second = torus.frequencies
    return [
        f"rotation number {torus.rotation_number:.9f}, frequencies {first:.9g} and {second:.9g} rad/s",
        f"{len(torus.states)} angles, {len(torus.breaks)} breaks, tail {torus.tail:.0e}",
    ]


def torus_pictures(torus: Section, system: System | None) -> list[Picture]:
    """Return section, and with its system motion in time and spectrum of the first state."""
    names = [q.name for q in torus.layout.states]
    titles = [with_unit(name, torus.layout.column(name).unit) for name in names]
    angles = np.linspace(0, 2 * np.pi, ANGLES)
    pictures = []
    if len(names) > 1:
        round_ = Line(torus.section(names[0], angles), torus.section(names[1], angles))
        pictures.append(Picture(f"{titles[0]} at tau = 0", f"{titles[1]} at tau = 0", [round_]))
    if system is not None:
        time, moved = in_time(system, torus, PERIODS, SAMPLES)
        pictures.append(Picture("time (s)", titles[0], [Line(time, moved[names[0]])]))
        lines = combinations(system, torus, names[0])
        what = with_unit(f"amplitude of {lines.name}", lines.unit)
        stems = Line(lines.frequencies, lines.amplitudes, Style.STEMS)
        pictures.append(Picture("frequency (rad/s)", what, [stems], log=True))
    return pictures


def _place(point: TorusPoint, system: System | None) -> Place:
    largest = ", ".join(f"{abs(m):.6g}" for m in point.multipliers[:MULTIPLIERS])
    kind = " ".join(filter(None, [point.label, "stable" if point.stable else "unstable"]))
    said = [f"{point.parameter:.9g}: {kind}, moduli of the multipliers {largest}", *torus_said(point.torus)]
    return Place(point.parameter, said, torus_pictures(point.torus, system))


def _measures(
    points: Sequence[TorusPoint], titles: Sequence[str], released: str
) -> list[tuple[str, list[Array]]]:
    """Size, rotation number or what is released for it, and moduli of multipliers."""
    tori = [point.torus for point in points]
    second = "rotation number", np.array([torus.rotation_number for torus in tori])
    if released:
        second = titles[1], np.array([torus.parameters[released] for torus in tori])
    moduli = np.array([np.sort(np.abs(point.multipliers))[::-1][:MULTIPLIERS] for point in points]).T
    return [
        ("size of the section (scaled)", [np.array([torus.size for torus in tori])]),
        (second[0], [second[1]]),
        ("moduli of the multipliers", list(moduli)),
    ]


def _lines(points: Sequence[TorusPoint], each: Sequence[Array], of: Sequence[int]) -> list[Line]:
    """Measures: drawn through where tori are stable, else dashed, special points marked on the first."""
    values = np.array([point.parameter for point in points])
    stable = np.array([point.stable for point in points])
    lines = []
    for k, up in enumerate(each):
        for kind, style in ((stable, Style.LINE), (~stable, Style.DASH)):
            near = kind.copy()
            near[1:] |= kind[:-1]
            lines.append(Line(values, np.where(near, up, np.nan), style, "", k, of))
    special = [i for i, point in enumerate(points) if point.label not in ("", "EP", "UZ")]
    texts, marked = [points[i].label for i in special], [of[i] for i in special]
    lines.append(Line(values[special], each[0][special], Style.OPEN, "", 2, marked, texts))
    return lines
