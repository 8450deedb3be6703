"""Section of the report: multipliers from 1e-300 to 1e15, all known exactly."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

import periodic as per
import symbolic as sym
from reports.studies.extremes.confirm import EXACT, MARGINAL, PHASES, Checked, joined, near
from reports.studies.extremes.study import Study
from reports.studies.extremes.survey import Case

DAMPED = (1e-1, 1e-3, 1e-6, 1e-10, 1e-16, 1e-30, 1e-100, 1e-300)
GROWING = (1e2, 1e4, 1e6, 1e8, 1e10, 1e12, 1e14, 1e15)
RANGE_ABOVE = (1.0, 1.01)
"""Range of Omega from the one that has the multiplier on."""


def system(damping: float, stiffness: float) -> sym.CompiledSystem:
    """Return x'' + c x' + k x = cos(Omega t)."""
    x = sym.coordinate("x")
    parts = sym.Mass(x, 1.0) + sym.Damper(x, damping) + sym.Spring(x, stiffness)
    return sym.compile(parts + sym.HarmonicForce(x, 1.0))


def rates(damping: float, stiffness: float) -> np.ndarray:
    """Return the two roots of s^2 + c s + k = 0."""
    return np.roots([1.0, damping, stiffness]).astype(complex)


def traced(omega: float, compiled: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
    """Return a short branch about a frequency."""
    low, high = (omega * end for end in RANGE_ABOVE)
    return per.trace(compiled, "Omega", (low, high), start=low, control=control)


def exact(damping: float, stiffness: float, compiled: sym.CompiledSystem, branch: per.Branch) -> Checked:
    """Hold every point against the exact orbit and the exact multipliers exp(2 pi s / Omega)."""
    roots, scale = rates(damping, stiffness), branch.layout.states[0].scale
    return joined([_exact(point, damping, stiffness, roots, scale) for point in branch])


def _exact(point: per.Point, damping: float, stiffness: float, roots: np.ndarray, length: float) -> Checked:
    omega, ours = point.parameter, point.multipliers
    response = 1 / (stiffness - omega**2 + 1j * damping * omega) / length
    x = (response * np.exp(1j * PHASES)).real
    slope = (1j * response * np.exp(1j * PHASES)).real
    away = float(np.abs(point.orbit.state(PHASES) - np.stack([x, slope], axis=1)).max())
    true = np.exp(2 * np.pi * roots / omega)
    true = true[np.argsort(-np.abs(true), kind="stable")]
    scale = max(1.0, float(np.abs(true).max()))
    off = np.abs(np.sort_complex(ours) - np.sort_complex(true)).max() / scale
    largest = float(np.abs(true).max())
    right = abs(largest - 1) < MARGINAL or point.stable == (largest < 1)
    error = away / point.orbit.span()
    return Checked(
        error=error,
        multiplier_error=float(off),
        near=near(error, point.error.orbit),
        stable=bool(right),
        count=1,
        by=EXACT,
        told=bool((np.abs(np.sort_complex(ours) - np.sort_complex(true)) <= point.floor).all()),
    )


def cases() -> list[Case]:
    """Return damped oscillators (c = k = 1), then inverted pendula (c = 0, k = -1)."""
    chosen = [("damped", 1.0, 1.0, -math.pi / math.log(mu), mu) for mu in DAMPED]
    chosen += [("growing", 0.0, -1.0, 2 * math.pi / math.log(mu), mu) for mu in GROWING]
    return [
        Case(
            value=mu,
            way=way,
            system=partial(system, c, k),
            trace=partial(traced, omega),
            confirm=partial(exact, c, k),
        )
        for way, c, k, omega, mu in chosen
    ]


STUDY = Study(
    key="multipliers",
    title="Multipliers",
    quantity="largest multiplier",
    cases=cases,
    quick=(1e-3, 1e4),
)
