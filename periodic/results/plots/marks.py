"""How special points look: a sign for each kind, named in the legend."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from periodic.bifurcations.label import Label
from periodic.results.peaks import PEAK_OF

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.axes import Axes

KINDS: dict[str, tuple[str, str]] = {
    "LP": ("o", "fold"),
    "PD": ("s", "period doubling"),
    "NS": ("D", "torus"),
    "BP": ("^", "branch point"),
    "HB": ("v", "Hopf"),
    "GR": ("d", "grazing"),
    "MX": ("X", "failed"),
    "PK": ("+", "peak or trough"),
    "CP": ("*", "cusp"),
    "R1": ("h", "resonance 1:1"),
    "R2": ("h", "resonance 1:2"),
    "R3": ("h", "resonance 1:3"),
    "R4": ("h", "resonance 1:4"),
    "LPPD": ("p", "fold and doubling"),
    "LPNS": ("p", "fold and torus"),
    "PDNS": ("p", "doubling and torus"),
    "GH": ("*", "Bautin"),
    "ZH": ("p", "zero and Hopf"),
    "BT": ("h", "Bogdanov-Takens"),
    "GPD": ("*", "generalised doubling"),
}
"""Sign and meaning of each label; other labels have a sign of their own without a meaning."""


def mark(axes: Axes, points: Iterable[tuple[str, str, float, float]]) -> None:
    """Mark special points: of each its label, the user's name of an event, and its place.

    Ends are not marked. Where a value was asked for ("UZ") there is a ring without a text, unless it has a
    name; where a measure is greatest or least ("PK") a cross, which has none by default.
    """
    from periodic.results.plots.frame import plain
    from periodic.results.plots.labels import placed

    named = {line.get_label() for line in axes.get_lines()}
    for label, event, x, y in points:
        if label in ("", Label.END) and not event:
            continue
        sign, meaning = KINDS.get(label, ("P", event))
        text = event or label if label in ("", Label.USER, Label.END, Label.PEAK) else label
        asked = label in ("", Label.USER)
        name = plain((event or "asked for") if asked else f"{label} {meaning}".strip())
        look: dict[str, Any] = {"marker": "o", "markerfacecolor": "none"} if asked else {"marker": sign}
        axes.plot([x], [y], color="black", linestyle="None", markersize=5.0, zorder=3, **look)
        axes.get_lines()[-1].set_label("" if name in named else name)
        named.add(name)
        if text != Label.USER and not text.startswith(PEAK_OF):
            placed(axes).add(text, (x, y))
