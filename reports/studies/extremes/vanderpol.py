"""Section of the report: the van der Pol oscillator up to mu = 1e5."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

import periodic as per
import symbolic as sym
from reports.studies.extremes.confirm import Checked, confirmed, near
from reports.studies.extremes.study import Study
from reports.studies.extremes.survey import Case
from symbolic.parts.equations import Names

Rates = dict[str, Any]

FIRST = 0.1
"""Where the branch begins, from x = 2 cos t."""

LARGE = 1e3
"""mu from which the asymptotic period is more accurate than orbits have to be."""

LIENARD, SCALED, PHASE_PLANE = "Liénard", "phase plane, x' in units of 4μ/3", "phase plane"


def system(form: str, mu: float) -> sym.CompiledSystem:
    """Return x'' - mu (1 - x^2) x' + x = 0 in a plane.

    Liénard: x' = mu (y + x - x^3/3), y' = -x/mu. Phase plane: x' = y, y' = mu (1 - x^2) y - x, with y
    scaled to its largest value at `mu` or not at all.
    """

    def lienard(x: Names, p: Names) -> Rates:
        return {"x": p.mu * (x.y + x.x - x.x**3 / 3), "y": -x.x / p.mu}

    def plane(x: Names, p: Names) -> Rates:
        return {"x": x.y, "y": p.mu * (1 - x.x**2) * x.y - x.x}

    scales = {"y": 4 * mu / 3} if form == SCALED else {}
    rates = lienard if form == LIENARD else plane
    states = {"x": 0.0, "y": 0.0}
    return sym.compile(sym.Equations(rates, states=states, parameters={"mu": FIRST}, scales=scales))


def circle(compiled: sym.CompiledSystem, form: str) -> per.Orbit:
    """Return x = 2 cos t, the orbit for small mu."""
    tau = np.linspace(0, 2 * np.pi, 193)
    x, speed = 2 * np.cos(tau), -2 * np.sin(tau)
    y = speed / FIRST - x + x**3 / 3 if form == LIENARD else speed / compiled.states[1].scale
    return per.sampled(tau, np.stack([x, y], axis=1), np.zeros((len(tau), 0)), compiled.nominal)


def traced(form: str, mu: float, compiled: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
    """Return the branch from mu = FIRST on; the frequency goes with it."""
    guess = circle(compiled, form)
    free = {"omega": per.PhaseCondition()}
    return per.trace(compiled, "mu", (FIRST, mu), guess=guess, determined=free, control=control)


def period(mu: float) -> float:
    """Return the period for large mu, to O(mu^-5/3): Zonneveld, Indag. Math. 28 (1966)."""
    return (3 - 2 * math.log(2)) * mu + 7.014322 / math.cbrt(mu) - (2 * math.log(mu) / 3 + 1.3233) / mu


def confirm(compiled: sym.CompiledSystem, branch: per.Branch) -> Checked:
    """Confirm orbits by CVODES, and the last period by its asymptotic series where mu is large."""
    found = confirmed(compiled, branch, free=("omega",))
    if branch[-1].parameter < LARGE:
        return found
    off = abs(2 * np.pi / float(branch.column("omega")[-1]) / period(branch[-1].parameter) - 1)
    together = found.near and near(off)
    return replace(found, error=max(found.error, off), near=together, by=f"{found.by}, asymptotic period")


def cases() -> list[Case]:
    """Return both forms, mu by decades."""
    return [
        Case(
            value=mu,
            way=form,
            at_end=True,
            system=partial(system, form, mu),
            trace=partial(traced, form, mu),
            confirm=confirm,
        )
        for form in (LIENARD, SCALED, PHASE_PLANE)
        for mu in (1.0, 10.0, 1e2, 1e3, 1e4, 1e5)
    ]


STUDY = Study(
    key="vanderpol",
    title="Van der Pol: relaxation",
    quantity="μ",
    cases=cases,
    quick=(10.0,),
)
