"""The frequency domain: amplitude against speed (Figs. 9 and 10) and against preload (Figs. 12a and 12b)."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import periodic
from reports.curve import draw_curve, solid
from reports.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.pages.section import Section, Tell
from reports.paper import preload, resonance
from reports.paper.rows import Row, Verdict, compared
from reports.paper.scenes import branch
from reports.view import MICRO, RPM

OIL_A, OIL_B, HEAVY = "vitrea79-810N", "turbo33-810N", "vitrea79-2100N"
NAMES = {OIL_A: "Vitrea 79, 810 N", OIL_B: "Turbo 33, 810 N", HEAVY: "Vitrea 79, 2100 N"}
PARTS = (0.003, 0.01, 0.03, 0.1, 0.3, 1.0)
"""Parts of the paper's waviness whose highest points make the backbone."""

SPEED_810, SPEED_2100 = 275.0, 325.0
"""Resonance speeds that the paper reads off its plots (rows P8 and P9), rev/min."""


def numbers() -> dict[str, float]:
    """Return the section's key numbers."""
    found: dict[str, float] = {}
    for name in NAMES:
        at = resonance.of(name)
        found |= {
            f"{name} natural speed rpm": at.natural,
            f"{name} linear peak rpm": at.linear[0],
            f"{name} branch peak rpm": at.highest[0],
            f"{name} branch peak um": at.highest[1] / MICRO,
        }
    for speed in preload.SPEEDS:
        folds = preload.branch(speed).labelled(periodic.Label.FOLD)
        doublings = preload.branch(speed).labelled(periodic.Label.DOUBLING)
        found |= {f"preload fold {i} at {speed:g} rpm N": p.parameter for i, p in enumerate(folds, 1)}
        found |= {f"preload doubling {i} at {speed:g} rpm N": p.parameter for i, p in enumerate(doublings, 1)}
        low, _, sign = preload.trend(speed)
        found |= {f"contact kept down to at {speed:g} rpm N": low, f"sign of dx/dQ at {speed:g} rpm": sign}
    return found


def meeting() -> dict[str, float]:
    """Return how far continuation in preload and in speed differ at their common points, relative."""
    return {
        f"{speed:g} rev/min, {force:g} N": preload.disagreement(speed, force)
        for speed in preload.SPEEDS
        for force in preload.COMMON
    }


def section(tell: Tell) -> Section:
    """Return the section."""
    tell("traces in speed")
    figures = {"frequency-810N": _in_speed((OIL_A, OIL_B), SPEED_810, (3.9,))}
    figures["frequency-2100N"] = _in_speed((HEAVY,), SPEED_2100, (14.5,))
    tell("traces in preload")
    figures["frequency-preload"] = _in_preload()
    found, meets = numbers(), meeting()
    return Section(
        title="Frequency domain: Figs. 9, 10 and 12",
        text=_text(found, meets),
        numbers=found,
        rows=_rows(found),
        figures=figures,
    )


def _in_speed(names: tuple[str, ...], reported: float, swings: tuple[float, ...]) -> Figure:
    figure, axes = panels(1, 1, height=4.4)
    for name, color in zip(names, (TRUSTED, SECOND), strict=False):
        found = branch(name)
        across, up = found.values / RPM, found.peak_to_peak("x") / MICRO
        labels = (f"{NAMES[name]}, stable", f"{NAMES[name]}, unstable")
        draw_curve(axes, across, up, solid(found), color=color, labels=labels)
        spine = np.array(resonance.backbone(name, PARTS))
        axes.plot(spine[:, 0], spine[:, 1] / MICRO, ":", color=color, marker=".", linewidth=1.0)
        _mark(axes, found, 1 / RPM, color)
    axes.plot([], [], "k:.", linewidth=1.0, label="highest points at 0 to 100 % of the waviness")
    axes.axvline(reported, color=PAPER, linewidth=1.0, label=f"paper's resonance, about {reported:g} rev/min")
    axes.plot([360] * len(swings), swings, "x", color=PAPER, markersize=8, label="paper at 360 rev/min")
    axes.set(xlabel="speed (rev/min)", ylabel="x peak to peak (µm)", xlim=(100, 500), ylim=(0, None))
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _in_preload() -> Figure:
    figure, both = panels(1, 2, height=3.2)
    for axes, speed, name in zip(both, preload.SPEEDS, "ab", strict=True):
        found = preload.branch(speed)
        draw_curve(axes, found.values, found.peak_to_peak("x") / MICRO, solid(found), color=TRUSTED)
        _mark(axes, found, 1.0, TRUSTED)
        common = found.labelled(periodic.Label.USER)
        axes.plot(
            [p.parameter for p in common],
            [p.peak_to_peak("x") / MICRO for p in common],
            "o",
            color=SECOND,
            markerfacecolor="none",
            label="also traced in speed",
        )
        if speed == 360.0:
            axes.plot([810, 2100], [3.9, 14.5], "x", color=PAPER, markersize=8, label="paper (P5, P6)")
        axes.set(xlabel="preload (N)", xlim=(0, 2600), ylim=(0, None), title=f"({name}) {speed:g} rev/min")
        axes.legend(loc="upper right" if speed == 200.0 else "upper left")
    both[0].set_ylabel("x peak to peak (µm)")
    return figure


def _mark(axes: Any, found: periodic.Branch, unit: float, color: str) -> None:
    for label, marker in ((periodic.Label.FOLD, "o"), (periodic.Label.DOUBLING, "D")):
        for point in found.labelled(label):
            axes.plot(
                point.parameter * unit, point.peak_to_peak("x") / MICRO, marker, color=color, markersize=4
            )


def _rows(n: dict[str, float]) -> tuple[Row, ...]:
    folds = "natural speed from the Jacobian; peak of the linear response; both in section 4"
    trends = {-1: "falls", 1: "rises", 0: "both rises and falls"}

    def trend(key: str, speed: float, wanted: int) -> Row:
        low, sign = n[f"contact kept down to at {speed:g} rpm N"], int(n[f"sign of dx/dQ at {speed:g} rpm"])
        return Row(
            key=key,
            what=f"x with rising preload at {speed:g} rev/min (Fig. 12)",
            paper=trends[wanted],
            ours=f"{trends[sign]} from {low:.0f} N to 2500 N, where contact is kept",
            check="meets the traces in speed at 810 N and 2100 N",
            given=Verdict.REPRODUCED if sign == wanted else Verdict.NOT_REPRODUCED,
        )

    natural = {name: n[f"{name} natural speed rpm"] for name in NAMES}
    return (
        compared("P8", "resonance speed, 810 N", SPEED_810, natural[OIL_A], "rev/min", folds),
        compared("P9", "resonance speed, 2100 N, oil A", SPEED_2100, natural[HEAVY], "rev/min", folds),
        trend("P15", 200.0, -1),
        trend("P16", 360.0, 1),
    )


def _resonances(n: dict[str, float]) -> str:
    lines = [
        "| disc | paper, about | natural, at rest | peak of the linear response | highest point of branch |",
        "|---|---|---|---|---|",
    ]
    for name, reported in ((OIL_A, SPEED_810), (OIL_B, SPEED_810), (HEAVY, SPEED_2100)):
        lines.append(
            f"| {NAMES[name]} | {reported:g} | {n[f'{name} natural speed rpm']:.2f} "
            f"| {n[f'{name} linear peak rpm']:.2f} | {n[f'{name} branch peak rpm']:.1f}, "
            f"x = {n[f'{name} branch peak um']:.2f} µm |"
        )
    return "\n".join(lines)


def _text(n: dict[str, float], meets: dict[str, float]) -> str:
    oils = n[f"{OIL_B} natural speed rpm"] - n[f"{OIL_A} natural speed rpm"]
    swing = {name: _at(name, 360.0) for name in NAMES}
    low, high = n["preload fold 1 at 200 rpm N"], n["preload fold 2 at 200 rpm N"]
    return f"""The periodic orbits were traced from 500 to 100 rev/min as one branch each, round every fold,
stable or not. The paper's figures could not be had, only what its text says of them; that is marked in red.

![Amplitude against speed at 810 N (the paper's Fig. 9). Solid: stable, dashed: unstable, dots: folds.
](frequency-810N.png)

![Amplitude against speed at 2100 N, oil A (Fig. 10).](frequency-2100N.png)

**Which speed is the resonance?** With linear motion there is one answer, the speed at which the
corrugations meet the natural frequency. The paper's disc is not linear there: contact softens as it is
unloaded, so the peak leans to lower speeds, and the highest point of the branch lies far below. The dotted
lines join the highest points of the branches with smaller waviness; this backbone begins at the natural
speed. The paper's round figures lie a little below the natural speeds; how they were read is not said.
All speeds in rev/min:

{_resonances(n)}

The paper says that the oil does not change the natural frequency and that the thinner oil gives slightly
larger amplitudes. Oil B's natural speed is {oils:+.2f} rev/min from oil A's; at 360 rev/min x is
{swing[OIL_B]:.3f} µm with oil B against {swing[OIL_A]:.3f} µm with oil A. Both statements hold away from the
resonance. On it they do not: oil B's branch goes on to {n[f"{OIL_B} branch peak um"]:.1f} µm,
oil A's ends at {n[f"{OIL_A} branch peak um"]:.1f} µm, because the film of oil A damps large motion more
(section 7).

**Preload** (Figs. 12a and 12b). Continuation in preload at a fixed speed:

![Amplitude against preload, oil A, at (a) 200 and (b) 360 rev/min. Dots: folds, diamonds: period
doublings.](frequency-preload.png)

At 200 rev/min x falls with preload from {n["contact kept down to at 200 rpm N"]:.0f} N on, and at
360 rev/min it rises from {n["contact kept down to at 360 rpm N"]:.0f} N on: everywhere on the stable orbits
that are joined to 2500 N, all of which keep contact, as the paper says and for the reason that it gives. What
it does not say: at 200 rev/min there are two folds, at {low:.2f} N and {high:.2f} N.
Between them a small and a large motion, the latter with loss of contact, are both stable.
At 360 rev/min the small motion loses stability by period doubling at
{n["preload doubling 1 at 360 rpm N"]:.2f} N (a multiplier passes -1) and is unstable from
there down to 100 N.

Continuation in preload and in speed are separate runs on separate meshes and scales. At their common points
x peak to peak differs by at most {max(meets.values()):.0e} (relative):
{"; ".join(f"{where} {difference:.0e}" for where, difference in meets.items())}.
"""


def _at(name: str, speed: float) -> float:
    """x peak to peak in µm at a speed on the upper sheet's side."""
    (point,) = branch(name, 365.0, 355.0, at=(speed,)).labelled(periodic.Label.USER)
    return point.peak_to_peak("x") / MICRO
