"""Supports of finite stiffness (Fig. 11): where they put the resonance, and what becomes of the folds."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import periodic
from reports.curve import draw_curve, solid
from reports.pages.figures import panels
from reports.pages.section import Section, Tell
from reports.paper.rows import Row
from reports.paper.scenes import branch, system
from reports.paper.stiffness import (
    RIGID,
    SCENE,
    antiresonance_speed,
    contact_stiffness,
    nominal,
    resonance_speed,
    rigid_resonance,
    second_speed,
    speeds,
    stiffness_for,
    with_leaf_springs,
)
from reports.paper.supports_text import text
from reports.view import MICRO, RPM
from symbolic.flow import Flow
from symbolic.linear import modes

SHARES = (0.1, 0.3, 0.5, 0.7)
"""Parts of each 20.4 kg that are taken to move with the disc."""

SHARE = 0.3
"""The share of the scene with supports."""

TARGETS = (275.0, 270.0, 260.0, 250.0, 240.0)
"""Speeds in rev/min to which the resonance is brought."""

EXAMPLE = 250.0
"""The speed to which the scene's own bearings bring it, rev/min."""

LEAF = 1e6
"""An example of a leaf spring, N/m: under 1 % of the contact's stiffness."""

CHECKED = (300.0, 225.0)
"""Speeds in rev/min at which orbits are integrated in time: in contact, and between the folds."""

DAMPINGS = (5000.0, 20000.0)
"""Damping of each bearing in N s/m: that of the scene, and four times as much."""

Override = tuple[str, str]


def numbers() -> dict[str, float]:
    """Return the key numbers of the linear system and of the two branches (rev/min, um, N/m)."""
    contact, bearing = contact_stiffness(), nominal(SCENE)["bearing_stiffness"]
    found = {
        "scene bearing stiffness N/m": bearing,
        "scene bearing damping N s/m": nominal(SCENE)["bearing_damping"],
        "rigid resonance rpm": rigid_resonance(),
        "scene resonance rpm": resonance_speed(bearing, SHARE),
        "scene second resonance rpm": second_speed(bearing, SHARE),
        "scene antiresonance rpm": antiresonance_speed(),
        "contact stiffness N/m": contact,
        "resonance with bearings of 10 contacts rpm": resonance_speed(10 * contact, SHARE),
        "resonance with bearings of 100 contacts rpm": resonance_speed(100 * contact, SHARE),
        "resonance with leaf springs rpm": with_leaf_springs(LEAF),
    }
    for share in SHARES:
        found |= {f"stiffness for {n:g} rpm share {share:g} N/m": stiffness_for(n, share) for n in TARGETS}
    ratios = modes(system(SCENE), {"speed": EXAMPLE * RPM}).damping_ratios
    rigid = modes(system(RIGID), {"speed": EXAMPLE * RPM}).damping_ratios
    return found | {
        "rigid damping ratio": float(rigid[0]),
        "scene damping ratio": float(ratios[0]),
        "scene second damping ratio": float(ratios[1]),
    }


def branch_numbers() -> dict[str, float]:
    """Return folds (rev/min and um), doublings (rev/min) and motion of the housings on both branches."""
    found: dict[str, float] = {}
    for name, traced in (("rigid", rigid_branch()), ("scene", scene_branch())):
        for label, word in ((periodic.Label.FOLD, "fold"), (periodic.Label.DOUBLING, "doubling")):
            for i, point in enumerate(traced.labelled(label), 1):
                found[f"{name} {word} {i} rpm"] = point.parameter / RPM
                if label is periodic.Label.FOLD:
                    found[f"{name} {word} {i} um"] = point.peak_to_peak("x") / MICRO
    fold = scene_branch().labelled(periodic.Label.FOLD)[0]
    return found | {"scene housings at fold 1 um": fold.peak_to_peak("y") / MICRO}


def rigid_branch() -> periodic.Branch:
    """Return the branch on rigid supports from 600 to 100 rev/min."""
    return branch(RIGID, 600.0, 100.0)


def scene_branch() -> periodic.Branch:
    """Return the branch of the scene with supports from 600 to 100 rev/min."""
    return branch(SCENE, 600.0, 100.0, CHECKED)


def supported_branch(rpm: float, share: float, damping: float) -> periodic.Branch:
    """Return the branch from 480 to 100 rev/min with bearings that bring the resonance to `rpm`."""
    support = {"stiffness": stiffness_for(rpm, share), "disc_share": share, "damping": damping}
    overrides = tuple((f"support.{key}", repr(value)) for key, value in support.items())
    return branch(SCENE, 480.0, 100.0, overrides=overrides)


def return_error(point: periodic.Point) -> float:
    """Return how far one period of time integration ends from where it began, as a part of delta0.

    It begins at the collocation point of deepest contact, where state and unknown are known together.
    """
    orbit, flow = point.orbit, Flow(system(SCENE), 1e-11)
    deepest = int(np.argmax(orbit.algebraic[:, -1, 0]))
    begin = float(orbit.stage_phases[deepest, -1])
    tau = np.array([begin, begin + 2 * np.pi])
    state, unknown = orbit.stages[deepest, -1], orbit.algebraic[deepest, -1]
    path = flow.run(state, unknown, orbit.parameter, tau).state
    return float(np.abs(path[-1] - path[0]).max())


def check_numbers() -> dict[str, float]:
    """Return the largest return error at each of the speeds CHECKED, over all sheets."""
    points = scene_branch().labelled(periodic.Label.USER)
    return {
        f"return error at {rpm:g} rpm": max(return_error(p) for p in points if p.parameter == rpm * RPM)
        for rpm in CHECKED
    }


def section(tell: Tell) -> Section:
    """Return the section."""
    tell("stiffness of the supports")
    found = numbers()
    figures = {"supports-stiffness": _map(found)}
    tell("branches with supports")
    found |= branch_numbers() | check_numbers()
    figures["supports-branches"] = _branches()
    return Section(
        title="Supports of finite stiffness: Fig. 11",
        text=text(found, SHARES, TARGETS),
        numbers=found,
        rows=_rows(found),
        figures=figures,
    )


def _rows(n: dict[str, float]) -> tuple[Row, ...]:
    ours = (
        f"bearings of {n['stiffness for 250 rpm share 0.3 N/m'] / 1e6:.0f} MN/m would bring "
        f"{n['rigid resonance rpm']:.1f} down to {EXAMPLE:g} rev/min (30 % of the mass in the disc)"
    )
    return (
        Row(
            key="P14",
            what="measured resonance lower, for the supports' sake",
            paper="lower; no number in the text",
            ours=ours,
            check="two coupled oscillators in closed form; time integration of the orbits",
        ),
    )


def _map(n: dict[str, float]) -> Figure:
    figure, (left, right) = panels(1, 2, height=3.2)
    k = np.geomspace(3e7, 3e10, 41)
    for share, color in zip(SHARES, _colours(), strict=True):
        first, second = speeds(k, share)
        left.semilogx(k, first, color=color, label=f"disc share {share:g}")
        right.loglog(k, second, color=color, label=f"disc share {share:g}")
    left.axhline(n["rigid resonance rpm"], color="black", linestyle=":", label="rigid supports")
    left.axvline(n["contact stiffness N/m"], color="grey", linestyle="--", label="contact's stiffness")
    right.axhspan(100, 500, color="grey", alpha=0.15, label="the paper's speeds")
    left.plot(
        n["scene bearing stiffness N/m"],
        n["scene resonance rpm"],
        "ko",
        markersize=4,
        label="scene supports-810N",
    )
    right.plot(n["scene bearing stiffness N/m"], n["scene second resonance rpm"], "ko", markersize=4)
    left.set(ylabel="first resonance (rev/min)", ylim=(100, 290))
    right.set(ylabel="second resonance (rev/min)", ylim=(100, 2e4))
    for axes in (left, right):
        axes.set_xlabel("stiffness of each bearing (N/m)")
        axes.legend(loc="lower right" if axes is left else "upper left", fontsize="x-small")
    return figure


def _branches() -> Figure:
    figure, (left, right) = panels(1, 2, height=3.6, sharey=True)
    _curve(left, rigid_branch(), "black", "rigid supports")
    for rpm, color in zip((270.0, 260.0, 250.0), _colours(), strict=False):
        name = f"resonance at {rpm:g} rev/min"
        _curve(
            left, scene_branch() if rpm == EXAMPLE else supported_branch(rpm, SHARE, DAMPINGS[0]), color, name
        )
    cases = [(share, DAMPINGS[0]) for share in SHARES[:3]] + [(SHARE, DAMPINGS[1])]
    for (share, damping), color in zip(cases, _colours(), strict=True):
        name = f"share {share:g}, {damping / 1000:g} kN s/m"
        _curve(right, supported_branch(EXAMPLE, share, damping), color, name)
    left.set(ylabel="x peak to peak (µm)", ylim=(0, 30))
    left.set_title(f"disc share {SHARE:g}, {DAMPINGS[0] / 1000:g} kN s/m", fontsize="medium")
    right.set_title(f"resonance at {EXAMPLE:g} rev/min", fontsize="medium")
    for axes, limits in ((left, (150, 480)), (right, (210, 270))):
        axes.set(xlabel="speed (rev/min)", xlim=limits)
        axes.legend(loc="upper right", fontsize="x-small")
    return figure


def _curve(axes: Any, traced: periodic.Branch, color: str, name: str) -> None:
    across = np.array([p.parameter for p in traced]) / RPM
    up = np.array([p.peak_to_peak("x") for p in traced]) / MICRO
    draw_curve(axes, across, up, solid(traced), color=color, labels=(name, ""), linewidth=1.4)


def _colours() -> tuple[str, ...]:
    return "tab:blue", "tab:orange", "tab:green", "tab:red"
