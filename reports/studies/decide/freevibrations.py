"""Nonlinear modes beside closed forms, and the damping of the paper's disc over its amplitude."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.special import ellipk

import periodic as per
import symbolic as sym
from periodic.decisions.modebranch import LOSS, RATIO
from periodic.results.betweenpoints import PER_SEGMENT, smooth
from reports.studies.pages.content import Found, Kept, Section, Tell

JENKINS = ((0.5, math.sqrt(1.25), 0.01 / (2 * math.sqrt(1.25))), (2.0, 1.04568564, 0.03976646))
"""Amplitude, frequency and damping ratio of the literature's joint: stuck (exact) and slipping."""

DISCS = ("dry-810N", "vitrea79-810N", "quasistatic-film-810N")
"""The disc without oil, with the oil of the paper, and with a film that is not squeezed."""

MICRO = 1e-6


X = sym.coordinate("x")


def oscillator(*parts: sym.Part) -> sym.CompiledSystem:
    """A mass on a spring, m = k = 1, with parts."""
    own = [sym.Mass(X, 1.0), sym.Spring(X, 1.0), sym.HarmonicForce(X, 0.1)]
    return sym.compile(sym.combine([*own, *parts]))


def anchors(tell: Tell) -> Found:
    """Compute modes whose numbers are known."""
    rows: list[dict[str, Any]] = []
    tell("Jenkins")
    joint = oscillator(sym.Damper(X, 0.01), sym.Jenkins(X, 0.25, 0.2))
    branch = per.mode_branch(joint, "x", (0.5, 2.0))
    for point, (amplitude, omega, ratio) in zip((branch[0], branch[-1]), JENKINS, strict=True):
        rows += [
            {"what": f"Jenkins, frequency at {amplitude:g}", "found": point.orbit.omega, "known": omega},
            {
                "what": f"Jenkins, damping ratio at {amplitude:g}",
                "found": point.columns[RATIO],
                "known": ratio,
            },
        ]
    point = branch[-1]
    t = np.linspace(0, point.orbit.period, 20001)
    damper = 0.01 * float(np.trapezoid(point.orbit["x'"](t) ** 2, t))
    top = float(np.ptp(point.orbit["x"](t))) / 2
    rows.append(
        {
            "what": "Jenkins, energy per period at 2",
            "found": point.columns[LOSS],
            "known": damper + 0.8 * (top - 0.8),
        }
    )
    tell("cubic")
    cubic = per.mode_branch(oscillator(sym.CubicSpring(X, 1.0)), "x", (0.1, 2.0), tol=1e-9)[-1]
    top = float(cubic.maximum["x"])
    turn = math.sqrt(1 + top**2)
    exact = math.pi * turn / (2 * float(ellipk(top**2 / (2 * turn**2))))
    rows.append({"what": "cubic backbone, frequency at 2", "found": cubic.orbit.omega, "known": exact})
    tell("a second spring")
    one = per.mode_branch(oscillator(sym.OneSidedSpring(X, 3.0)), "x", (0.5, 1.0))[-1]
    rows.append({"what": "one-sided spring, period", "found": one.orbit.period, "known": 1.5 * math.pi})
    worst = max(abs(row["found"] / row["known"] - 1) for row in rows)
    return Found(numbers={"worst_ratio": worst}, rows=rows)


def _anchors(kept: Kept) -> Mapping[str, Any]:
    table = [
        [
            row["what"],
            f"{row['found']:.10g}",
            f"{row['known']:.10g}",
            f"{abs(row['found'] / row['known'] - 1):.0e}",
        ]
        for row in kept.rows
    ]
    return {"table": table}


def disc(tell: Tell) -> Found:
    """Compute the mode of the paper's disc, dry and in oil."""
    rows: list[dict[str, Any]] = []
    drawn = Figure(figsize=(7.0, 5.0), layout="constrained")
    upper, lower = drawn.subplots(2, 1, sharex=True)
    for k, name in enumerate(DISCS):
        tell(name)
        branch = per.mode_branch(
            sym.scene(name), "x", (0.1 * MICRO, 20 * MICRO), frequency="speed", at=[5 * MICRO]
        )
        across = branch.values / MICRO
        omega = np.array([point.orbit.omega for point in branch])
        for axes, heights in ((upper, omega / (2 * math.pi)), (lower, branch.column(RATIO))):
            axes.plot(*smooth(across, heights, PER_SEGMENT), color=f"C{k}", label=name)
        for at in (0, int(np.argmin(np.abs(across - 5))), len(branch) - 1):
            rows.append(
                {
                    "scene": name,
                    "amplitude_um": float(across[at]),
                    "omega": float(omega[at]),
                    "ratio": float(branch[at].columns[RATIO]),
                }
            )
    lower.axhline(0.007, color="0.5", linestyle=":", label="the paper's .007")
    upper.set(ylabel="frequency (Hz)")
    lower.set(xlabel="amplitude of x (µm)", ylabel="damping ratio", yscale="log")
    for axes in (upper, lower):
        axes.grid(alpha=0.25)
    lower.legend(fontsize="small")
    ratios = {row["scene"]: row["ratio"] for row in rows[::3]}
    return Found(
        numbers={f"small_{name.partition('-')[0]}_ratio": ratio for name, ratio in ratios.items()},
        rows=rows,
        figures={"disc-modes": drawn},
    )


def _disc(kept: Kept) -> Mapping[str, Any]:
    table = [
        [
            f"`{row['scene']}`",
            f"{row['amplitude_um']:.3g}",
            f"{row['omega'] / (2 * math.pi):.2f}",
            f"{row['ratio']:.5f}",
        ]
        for row in kept.rows
    ]
    return {"table": table}


ANCHORS = Section(
    title="Modes whose numbers are known", compute=anchors, context=_anchors, template="anchors.md.j2"
)
DISC = Section(
    title="The paper's disc: damping over amplitude", compute=disc, context=_disc, template="disc.md.j2"
)
