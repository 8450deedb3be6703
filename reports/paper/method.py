"""Section of the report: the paper's own method, and the band of speeds in which it breaks down."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import brentq

from periodic import Branch, Label, Point
from reports.pages.section import Section, Tell
from reports.paper.beginnings import Beginning, beginnings
from reports.paper.breakdown import (
    Band,
    Outcome,
    bands,
    fastest,
    film_rate,
    on_orbits,
    real_limit,
    rest_growth,
    step_limit,
)
from reports.paper.contact import lost_from
from reports.paper.equivalence import (
    SPEEDS,
    THIRD,
    THREE,
    eigenvalue_difference,
    motion_difference,
    orbit_difference,
    reached,
)
from reports.paper.histories import PAPER_STEP, RPM_SHOWN, ripple, trusted
from reports.paper.method_figures import breakdown_at, limits, maps, responses
from reports.paper.method_text import text
from reports.paper.rows import Row, Verdict
from reports.paper.scenes import LUBRICATED, branch, system
from reports.paper.started import Form, runs
from reports.view import MICRO, RPM

GRID = tuple(float(rpm) for rpm in range(100, 501, 5))
"""Speeds of the map, rev/min."""

STEPS = (2e-4, 1e-4, 5e-5, 2e-5, 1e-5)
"""Steps of the map, s."""

CHECKED = {"vitrea79-810N": (250.0, 270.0, 290.0, 310.0), "vitrea79-2100N": (310.0, 325.0, 340.0)}
"""Speeds inside the bands at which CVODES goes on from the same start, rev/min."""


def section(tell: Tell) -> Section:
    """Map where the paper's method fails, say why, and compare what survives with the branch."""
    everything = computed(tell)
    tell("the form as a scene")
    numbers = key_numbers(everything) | form_numbers()
    figures = {
        "method-map": maps(everything.third),
        "method-response": responses(everything.at(PAPER_STEP), everything.branches, everything.trusted),
        "method-breakdown": breakdown_at(270.0),
        "method-step": limits(everything.branches, PAPER_STEP),
    }
    return Section(
        title="The paper's method and its breakdown",
        text=text(numbers),
        numbers=numbers,
        rows=(_row(numbers),),
        figures=figures,
    )


@dataclass(frozen=True, kw_only=True)
class Computed:
    """third, three: maps of the two forms; trusted: (rev/min, x p-p in m) by CVODES, by scene."""

    branches: dict[str, Branch]
    third: list[Band]
    three: list[Band]
    trusted: dict[str, list[tuple[float, float]]]

    def at(self, step: float) -> dict[str, Band]:
        """Return the bands of the third-order form with one step, by scene."""
        return {band.name: band for band in self.third if band.step == step}


def computed(tell: Tell) -> Computed:
    """Compute everything that the section shows."""
    tell("branches to compare with")
    branches = {name: branch(name, at=GRID) for name in LUBRICATED}
    third: list[Band] = []
    for step in STEPS:
        tell(f"map with steps of {step * 1e3:g} ms")
        third += mapped(Form.THIRD_ORDER, LUBRICATED, GRID, step)
    three = mapped(Form.THREE_STATE, LUBRICATED, GRID, PAPER_STEP)
    tell("CVODES within the bands")
    settled = {name: [(rpm, settles(name, rpm)) for rpm in speeds] for name, speeds in CHECKED.items()}
    return Computed(branches=branches, third=third, three=three, trusted=settled)


def mapped(form: Form, names: Sequence[str], speeds: Sequence[float], step: float) -> list[Band]:
    """Return the bands of some discs for one step (s)."""
    known = [branch(name, at=GRID) for name in names]
    return bands(form, names, speeds, step, known)


@cache
def settles(name: str, rpm: float) -> float:
    """Return x p-p (m) over the last 50 ms of 1 s by CVODES from the paper's start."""
    return ripple(trusted(name, 1.0, rpm).during(0.95, 1.0).x)


def off_branch(name: str, rpm: float, swing: float) -> float:
    """Return the relative distance of a p-p (m) from that of the nearest stable orbit at a speed."""
    known = [p.peak_to_peak("x") for p in stable_points(name) if abs(p.parameter / RPM - rpm) < 1e-6]
    return min(abs(swing / orbit - 1) for orbit in known)


def stable_points(name: str) -> list[Point]:
    """Return the stable points of a branch at the speeds of the map."""
    return [p for p in branch(name, at=GRID).labelled(Label.USER) if p.stable]


def key_numbers(found: Computed) -> dict[str, float]:
    """Return the numbers of the maps."""
    numbers: dict[str, float] = {}
    for key, name in zip(("oil_a", "heavy", "oil_b", "oil_b_heavy"), LUBRICATED, strict=True):
        band, fine = found.at(PAPER_STEP)[name], found.at(STEPS[-1])[name]
        numbers |= {f"{key}_{k}": v for k, v in _edges(band).items()}
        numbers |= {f"{key}_fine_{k}": v for k, v in _edges(fine).items()}
        numbers[f"{key}_step_limit_ms"] = step_limit(name, RPM_SHOWN) * 1e3
        numbers[f"{key}_growth"] = rest_growth(name, RPM_SHOWN, PAPER_STEP)
        unstable = [v for v, o in zip(band.speeds, band.outcome, strict=True) if o is Outcome.UNSTABLE]
        if unstable:
            numbers[f"{key}_unstable_rpm"] = float(min(unstable))
    numbers["oil_b_lambda_dt"] = fastest("turbo33-810N", RPM_SHOWN) * PAPER_STEP
    numbers["oil_b_stable_film_um"] = stable_film("turbo33-810N") / MICRO
    numbers["oil_b_film_um"] = rest_film("turbo33-810N") / MICRO
    numbers |= _survivors(found)
    return numbers


def _edges(band: Band) -> dict[str, float]:
    failed = band.failed
    if len(failed) == 0:
        return {"failed": 0.0}
    latest = np.nanmax(band.time[np.isin(band.speeds, failed)])
    return {
        "low_rpm": float(failed.min()),
        "high_rpm": float(failed.max()),
        "failed": float(len(failed)),
        "inside": float(np.sum((band.speeds >= failed.min()) & (band.speeds <= failed.max()))),
        "latest_ms": float(latest) * 1e3,
    }


def _survivors(found: Computed) -> dict[str, float]:
    """How far off the branch the survivors of the paper's step are, and what CVODES finds in the bands."""
    paper, coarse = found.at(PAPER_STEP), found.at(STEPS[0])
    off = [
        off_branch(name, rpm, swing)
        for name in CHECKED
        for rpm, swing in zip(paper[name].speeds, paper[name].swing, strict=True)
        if np.isfinite(swing)
    ]
    unstable = [
        swing
        for band in paper.values()
        for o, swing in zip(band.outcome, band.swing, strict=True)
        if o is Outcome.UNSTABLE
    ]
    inside = [off_branch(name, *case) for name, cases in found.trusted.items() for case in cases]
    return _reasons([*found.third, *found.three]) | {
        "survivors": float(len(off)),
        "survivors_off_percent": 100 * max(off),
        "unstable_runs": float(len(unstable)),
        "unstable_lasting": float(np.isfinite(unstable).sum()),
        "coarse_wrong": float(sum(o is Outcome.WRONG for name in CHECKED for o in coarse[name].outcome)),
        "trusted_off": max(inside),
        "largest_um": max(p.peak_to_peak("x") for p in found.branches[THREE]) / MICRO,
        "orbit_low_rpm": min(left_orbits(THREE, PAPER_STEP)),
        "orbit_high_rpm": max(left_orbits(THREE, PAPER_STEP)),
        "orbit_fine_low_rpm": min(left_orbits(THREE, STEPS[-1])),
        "orbit_fine_high_rpm": max(left_orbits(THREE, STEPS[-1])),
        "contact_lost_rpm": lost_from(THREE),
    }


def _reasons(found: Sequence[Band]) -> dict[str, float]:
    """How many failures with a step stable at rest begin with what, and how many early ones at STEPS[0]."""
    begun = [(band.step, way) for band in found for way in beginnings(band)]
    early = [step for step, way in begun if way is Beginning.EARLY]
    return {
        "failures": float(len(begun)),
        "failures_contact_lost": float(sum(way is Beginning.CONTACT for _, way in begun)),
        "failures_step_unstable": float(sum(way is Beginning.STEP for _, way in begun)),
        "failures_early": float(len(early)),
        "failures_early_coarse": float(early.count(STEPS[0])),
    }


@cache
def left_orbits(name: str, step: float) -> tuple[float, ...]:
    """Return the speeds (rev/min) at which the method, started on a stable orbit, does not stay on it."""
    points = stable_points(name)
    kept = on_orbits(name, points, step)
    return tuple(p.parameter / RPM for p, o in zip(points, kept, strict=True) if o is not Outcome.SETTLED)


def rest_film(name: str, rpm: float = RPM_SHOWN) -> float:
    """Return the steady film thickness in m."""
    case = runs(Form.THIRD_ORDER, [(name, rpm)])
    return float(case.state[0, 0] * case.system.states[0].scale)


def stable_film(name: str, rpm: float = RPM_SHOWN, step: float = PAPER_STEP) -> float:
    """Return the thinnest film (m) with which the step is stable at rest."""
    named = {p.name: p.value for p in system(name).parameters}
    deflection = (named["preload"] / named["stiffness"]) ** (1 / named["exponent"])

    def excess(h: float) -> float:
        return float(film_rate(name, h, deflection, rpm)) * step - real_limit()

    return float(brentq(excess, 1e-8, 1e-4))


def form_numbers() -> dict[str, float]:
    """Return how the two forms agree, and how far the third-order form can be traced."""
    third, three = reached(THIRD), reached(THREE)
    return {
        "eigenvalue_difference": max(eigenvalue_difference(rpm) for rpm in SPEEDS),
        "motion_difference_coarse_um": motion_difference(PAPER_STEP) / MICRO,
        "motion_difference_um": motion_difference(1e-5) / MICRO,
        "orbit_difference": max(orbit_difference(output) for output in ("x", "film", "load")),
        "third_reached_rpm": third.rpm,
        "third_points": float(third.points),
        "three_reached_rpm": three.rpm,
        "three_points": float(three.points),
    }


def _row(n: dict[str, float]) -> Row:
    return Row(
        key="P13",
        what="no finite amplitude around resonance",
        paper="breakdown as dh/dt grows; no band given",
        ours=(
            f"its method fails from {n['oil_a_low_rpm']:.0f} to {n['oil_a_high_rpm']:.0f} rev/min "
            f"(Vitrea 79, 810 N); the response is finite, up to {n['largest_um']:.1f} µm"
        ),
        check="Runge-Kutta with five steps; collocation and CVODES go through",
        given=Verdict.REPRODUCED,
    )
