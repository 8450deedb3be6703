"""The paper's own method, and the band of speeds in which it breaks down."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import brentq

from periodic import Branch, Label, Point
from reports.studies.pages.content import Found, Section, Tell
from reports.studies.paper.common.discs import HEAVY, LUBRICATED, MICRO, OIL_A, OIL_B, RPM_SHOWN
from reports.studies.paper.common.scenes import film_at_rest, nominal, static_deflection, system
from reports.studies.paper.common.tracing import at_speed, branch, lost_from
from reports.studies.paper.marching import breakdown, equivalence
from reports.studies.paper.marching.beginnings import Beginning, beginnings
from reports.studies.paper.marching.breakdown import Band, Outcome
from reports.studies.paper.marching.histories import PAPER_STEP, ripple, trusted
from reports.studies.paper.marching.started import Form
from reports.studies.paper.method_figures import breakdown_at, limits, maps, responses
from symbolic.scenes.axes import RPM

GRID = tuple(float(rpm) for rpm in range(100, 501, 5))
"""Speeds of the map, rev/min."""

STEPS = (2e-4, 1e-4, 5e-5, 2e-5, 1e-5)
"""Steps of the map, s."""

CHECKED = {OIL_A: (250.0, 270.0, 290.0, 310.0), HEAVY: (310.0, 325.0, 340.0)}
"""Speeds inside the bands at which CVODES goes on from the same start, rev/min."""

SHORT = dict(zip(LUBRICATED, ("oil_a", "heavy", "oil_b", "oil_b_heavy"), strict=True))
"""What the names of numbers call the discs."""


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


def compute(tell: Tell) -> Found:
    """Map where the paper's method fails, say why, and compare what survives with the branch."""
    found = computed(tell)
    tell("the form as a scene")
    return Found(
        numbers=key_numbers(found) | form_numbers(),
        figures={
            "method-map": maps(found.third),
            "method-response": responses(found.at(PAPER_STEP), found.branches, found.trusted),
            "method-breakdown": breakdown_at(270.0),
            "method-step": limits(found.branches, PAPER_STEP),
        },
    )


SECTION = Section(
    title="The paper's method and its breakdown",
    compute=compute,
    context=lambda _: {"limit": breakdown.real_limit()},
)


def computed(tell: Tell) -> Computed:
    """Compute everything that the section shows."""
    tell("branches to compare with")
    branches = {name: branch(name, at=GRID) for name in LUBRICATED}
    known, third = list(branches.values()), []
    for step in STEPS:
        tell(f"map with steps of {step * 1e3:g} ms")
        third += breakdown.bands(Form.THIRD_ORDER, LUBRICATED, GRID, step, known)
    three = breakdown.bands(Form.THREE_STATE, LUBRICATED, GRID, PAPER_STEP, known)
    tell("CVODES within the bands")
    ends = {name: [(rpm, settles(name, rpm)) for rpm in speeds] for name, speeds in CHECKED.items()}
    return Computed(branches=branches, third=third, three=three, trusted=ends)


@cache
def settles(name: str, rpm: float) -> float:
    """Return x p-p (m) over the last 50 ms of 1 s by CVODES from the paper's start."""
    return ripple(trusted(name, 1.0, rpm).during(0.95, 1.0).x)


def off_branch(name: str, rpm: float, swing: float) -> float:
    """Return the relative distance of a p-p (m) from that of the nearest stable orbit at a speed."""
    known = [p.peak_to_peak("x") for p in at_speed(branch(name, at=GRID), rpm) if p.stable]
    return min(abs(swing / orbit - 1) for orbit in known)


def key_numbers(found: Computed) -> dict[str, float]:
    """Return the numbers of the maps."""
    numbers: dict[str, float] = {}
    for name, key in SHORT.items():
        band, fine = found.at(PAPER_STEP)[name], found.at(STEPS[-1])[name]
        numbers |= {f"{key}_{k}": v for k, v in _edges(band).items()}
        numbers |= {f"{key}_fine_{k}": v for k, v in _edges(fine).items()}
        numbers[f"{key}_step_limit_ms"] = breakdown.step_limit(name, RPM_SHOWN) * 1e3
        numbers[f"{key}_growth"] = breakdown.rest_growth(name, RPM_SHOWN, PAPER_STEP)
        if unstable := band.speeds[[o is Outcome.UNSTABLE for o in band.outcome]].tolist():
            numbers[f"{key}_unstable_rpm"] = min(unstable)
    return (
        numbers
        | {
            "oil_b_lambda_dt": breakdown.fastest(OIL_B, RPM_SHOWN) * PAPER_STEP,
            "oil_b_stable_film_um": stable_film(OIL_B) / MICRO,
            "oil_b_film_um": rest_film(OIL_B) / MICRO,
        }
        | _survivors(found)
        | _reasons([*found.third, *found.three])
        | _left()
    )


def _edges(band: Band) -> dict[str, float]:
    failed = band.failed
    if len(failed) == 0:
        return {"failed": 0.0}
    low, high = float(failed.min()), float(failed.max())
    return {
        "low_rpm": low,
        "high_rpm": high,
        "failed": float(len(failed)),
        "inside": float(np.sum((band.speeds >= low) & (band.speeds <= high))),
        "latest_ms": float(np.nanmax(band.time[np.isin(band.speeds, failed)])) * 1e3,
    }


def _survivors(found: Computed) -> dict[str, float]:
    """How far off the branch the survivors of the paper's step are, and what CVODES finds in the bands."""
    paper, coarse = found.at(PAPER_STEP), [found.at(STEPS[0])[name] for name in CHECKED]
    off = [
        off_branch(name, rpm, swing)
        for name in CHECKED
        for rpm, swing in zip(paper[name].speeds, paper[name].swing, strict=True)
        if np.isfinite(swing)
    ]
    runs = [pair for band in paper.values() for pair in zip(band.outcome, band.swing, strict=True)]
    unstable = [swing for outcome, swing in runs if outcome is Outcome.UNSTABLE]
    return {
        "survivors": float(len(off)),
        "survivors_off_percent": 100 * max(off),
        "unstable_runs": float(len(unstable)),
        "unstable_lasting": float(np.isfinite(unstable).sum()),
        "coarse_wrong": float(sum(band.outcome.count(Outcome.WRONG) for band in coarse)),
        "trusted_off": max(off_branch(name, *at) for name, ends in found.trusted.items() for at in ends),
        "largest_um": max(p.peak_to_peak("x") for p in found.branches[equivalence.THREE]) / MICRO,
        "contact_lost_rpm": lost_from(equivalence.THREE),
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


def _left() -> dict[str, float]:
    """Between which speeds (rev/min) the method, started on a stable orbit, does not stay on it."""
    points: list[Point] = [p for p in branch(equivalence.THREE, at=GRID).labelled(Label.USER) if p.stable]
    numbers: dict[str, float] = {}
    for key, step in (("orbit", PAPER_STEP), ("orbit_fine", STEPS[-1])):
        ends = zip(points, breakdown.on_orbits(equivalence.THREE, points, step), strict=True)
        left = [p.parameter / RPM for p, outcome in ends if outcome is not Outcome.SETTLED]
        numbers |= {f"{key}_low_rpm": min(left), f"{key}_high_rpm": max(left)}
    return numbers


def rest_film(name: str) -> float:
    """Return the steady film thickness at 360 rev/min in m."""
    return film_at_rest(system(name), speed=RPM_SHOWN * RPM)


def stable_film(name: str) -> float:
    """Return the thinnest film (m) with which the paper's step is stable at rest at 360 rev/min."""
    deflection = static_deflection(nominal(name))

    def excess(h: float) -> float:
        rate = float(breakdown.film_rate(name, h, deflection, RPM_SHOWN))
        return rate * PAPER_STEP - breakdown.real_limit()

    return float(brentq(excess, 1e-8, 1e-4))


def form_numbers() -> dict[str, float]:
    """Return how the two forms agree, and how far the third-order form can be traced."""
    third, three = equivalence.reached(equivalence.THIRD), equivalence.reached(equivalence.THREE)
    return {
        "eigenvalue_difference": max(equivalence.eigenvalue_difference(rpm) for rpm in equivalence.SPEEDS),
        "motion_difference_coarse_um": equivalence.motion_difference(PAPER_STEP) / MICRO,
        "motion_difference_um": equivalence.motion_difference(1e-5) / MICRO,
        "orbit_difference": max(equivalence.orbit_difference(output) for output in ("x", "film", "load")),
        "third_reached_rpm": third[-1].parameter / RPM,
        "third_points": float(len(third)),
        "three_reached_rpm": three[-1].parameter / RPM,
        "three_points": float(len(three)),
    }
