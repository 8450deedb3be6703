"""Supports of finite stiffness (Fig. 11): where they put the resonance, and what becomes of the folds."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from periodic import Branch, Label, Point
from reports.studies.pages.content import Found, Section, Tell
from reports.studies.pages.figures import panels
from reports.studies.paper.branches import stiffness
from reports.studies.paper.common.discs import MICRO
from reports.studies.paper.common.figures import COLOURS, SPEED, SWING, curve
from reports.studies.paper.common.scenes import nominal, system
from reports.studies.paper.common.tracing import at_speed, branch
from symbolic.integration.flow import Flow
from symbolic.motion.linear import modes
from symbolic.scenes.axes import RPM

SHARES, SHARE = (0.1, 0.3, 0.5, 0.7), 0.3
"""Parts of each 20.4 kg that are taken to move with the disc, and that of the scene with supports."""

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


def compute(tell: Tell) -> Found:
    """Find the stiffness that brings the resonance to given speeds, and trace with such supports."""
    tell("stiffness of the supports")
    found = numbers()
    figures = {"supports-stiffness": _map(found)}
    tell("branches with supports")
    found |= branch_numbers() | check_numbers()
    return Found(numbers=found, figures=figures | {"supports-branches": _branches()})


SECTION = Section(
    title="Supports of finite stiffness: Fig. 11",
    compute=compute,
    context=lambda _: {"shares": SHARES, "targets": TARGETS},
)


def numbers() -> dict[str, float]:
    """Return the key numbers of the linear system (rev/min, N/m)."""
    contact, bearing = stiffness.contact_stiffness(), nominal(stiffness.SCENE)["bearing_stiffness"]
    ratios = modes(system(stiffness.SCENE), {"speed": EXAMPLE * RPM}).damping_ratios
    rigid = modes(system(stiffness.RIGID), {"speed": EXAMPLE * RPM}).damping_ratios
    return {
        "scene bearing stiffness N/m": bearing,
        "scene bearing damping N s/m": nominal(stiffness.SCENE)["bearing_damping"],
        "rigid resonance rpm": stiffness.rigid_resonance(),
        "scene resonance rpm": stiffness.resonance_speed(bearing, SHARE),
        "scene second resonance rpm": stiffness.second_speed(bearing, SHARE),
        "scene antiresonance rpm": stiffness.antiresonance_speed(),
        "contact stiffness N/m": contact,
        "resonance with bearings of 10 contacts rpm": stiffness.resonance_speed(10 * contact, SHARE),
        "resonance with bearings of 100 contacts rpm": stiffness.resonance_speed(100 * contact, SHARE),
        "resonance with leaf springs rpm": stiffness.with_leaf_springs(LEAF),
        "rigid damping ratio": float(rigid[0]),
        "scene damping ratio": float(ratios[0]),
        "scene second damping ratio": float(ratios[1]),
    } | {
        f"stiffness for {rpm:g} rpm share {share:g} N/m": stiffness.stiffness_for(rpm, share)
        for share in SHARES
        for rpm in TARGETS
    }


def branch_numbers() -> dict[str, float]:
    """Return folds (rev/min and um), doublings (rev/min) and motion of the housings on both branches."""
    found: dict[str, float] = {}
    for name, traced in (("rigid", rigid_branch()), ("scene", scene_branch())):
        for i, point in enumerate(traced.labelled(Label.FOLD), 1):
            found[f"{name} fold {i} rpm"] = point.parameter / RPM
            found[f"{name} fold {i} um"] = point.peak_to_peak("x") / MICRO
        for i, point in enumerate(traced.labelled(Label.DOUBLING), 1):
            found[f"{name} doubling {i} rpm"] = point.parameter / RPM
    fold = scene_branch().labelled(Label.FOLD)[0]
    return found | {"scene housings at fold 1 um": fold.peak_to_peak("y") / MICRO}


def rigid_branch() -> Branch:
    """Return the branch on rigid supports from 600 to 100 rev/min."""
    return branch(stiffness.RIGID, 600.0, 100.0)


def scene_branch() -> Branch:
    """Return the branch of the scene with supports from 600 to 100 rev/min."""
    return branch(stiffness.SCENE, 600.0, 100.0, CHECKED)


def supported_branch(rpm: float, share: float, damping: float) -> Branch:
    """Return the branch from 480 to 100 rev/min with bearings that bring the resonance to `rpm`."""
    support = {"stiffness": stiffness.stiffness_for(rpm, share), "disc_share": share, "damping": damping}
    overrides = tuple((f"support.{key}", repr(value)) for key, value in support.items())
    return branch(stiffness.SCENE, 480.0, 100.0, overrides=overrides)


def return_error(point: Point) -> float:
    """Return how far one period of time integration ends from where it began, as a part of delta0.

    It begins at the collocation point of deepest contact, where state and unknown are known together.
    """
    orbit, flow = point.orbit, Flow(system(stiffness.SCENE), 1e-11)
    deepest = int(np.argmax(orbit.algebraic[:, -1, 0]))
    begin = float(orbit.stage_phases[deepest, -1])
    tau = np.array([begin, begin + 2 * np.pi])
    state, unknown = orbit.stages[deepest, -1], orbit.algebraic[deepest, -1]
    path = flow.run(state, unknown, orbit.parameter, tau).state
    return float(np.abs(path[-1] - path[0]).max())


def check_numbers() -> dict[str, float]:
    """Return the largest return error at each of the speeds CHECKED, over all sheets."""
    return {
        f"return error at {rpm:g} rpm": max(return_error(p) for p in at_speed(scene_branch(), rpm))
        for rpm in CHECKED
    }


def _map(n: dict[str, float]) -> Figure:
    figure, (left, right) = panels(1, 2, height=3.2)
    k, scene = np.geomspace(3e7, 3e10, 41), n["scene bearing stiffness N/m"]
    for share, color in zip(SHARES, COLOURS, strict=False):
        for axes, resonances in zip((left, right), stiffness.speeds(k, share), strict=True):
            axes.semilogx(k, resonances, color=color, label=f"disc share {share:g}")
    left.axhline(n["rigid resonance rpm"], color="black", linestyle=":", label="rigid supports")
    left.axvline(n["contact stiffness N/m"], color="grey", linestyle="--", label="contact's stiffness")
    left.plot(scene, n["scene resonance rpm"], "ko", markersize=4, label="scene supports-810N")
    right.axhspan(100, 500, color="grey", alpha=0.15, label="the paper's speeds")
    right.plot(scene, n["scene second resonance rpm"], "ko", markersize=4)
    left.set(ylabel="first resonance (rev/min)", ylim=(100, 290))
    right.set(ylabel="second resonance (rev/min)", yscale="log", ylim=(100, 2e4))
    for axes, place in ((left, "lower right"), (right, "upper left")):
        axes.set_xlabel("stiffness of each bearing (N/m)")
        axes.legend(loc=place, fontsize="x-small")
    return figure


def _branches() -> Figure:
    figure, (left, right) = panels(1, 2, height=3.6, sharey=True)
    curve(left, rigid_branch(), "black", ("rigid supports", ""))
    for rpm, color in zip((270.0, 260.0, 250.0), COLOURS, strict=False):
        found = scene_branch() if rpm == EXAMPLE else supported_branch(rpm, SHARE, DAMPINGS[0])
        curve(left, found, color, (f"resonance at {rpm:g} rev/min", ""))
    cases = [(share, DAMPINGS[0]) for share in SHARES[:3]] + [(SHARE, DAMPINGS[1])]
    for (share, damping), color in zip(cases, COLOURS, strict=False):
        name = f"share {share:g}, {damping / 1000:g} kN s/m"
        curve(right, supported_branch(EXAMPLE, share, damping), color, (name, ""))
    left.set(ylabel=SWING, ylim=(0, 30))
    left.set_title(f"disc share {SHARE:g}, {DAMPINGS[0] / 1000:g} kN s/m", fontsize="medium")
    right.set_title(f"resonance at {EXAMPLE:g} rev/min", fontsize="medium")
    for axes, limits in ((left, (150, 480)), (right, (210, 270))):
        axes.set(xlabel=SPEED, xlim=limits)
        axes.legend(loc="upper right", fontsize="x-small")
    return figure
