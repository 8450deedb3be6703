"""Designs beside brute force: how good they are, and how many orbits they take."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, cast

import numpy as np
from scipy.optimize import minimize

import periodic as per
import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell

SWING = per.PeakToPeak("x")

Free = dict[str, tuple[float, float]]


def absorber() -> sym.CompiledSystem:
    """A cubic oscillator with an absorber of a twentieth of its mass (Habib et al. 2015)."""
    x, y, p = sym.coordinate("x"), sym.coordinate("y"), sym.Parameter
    own = [
        sym.Mass(x, 1.0),
        sym.Spring(x, p("k1", 1.0)),
        sym.Damper(x, p("c1", 0.002)),
        sym.CubicSpring(x, p("knl1", 1.0)),
        sym.HarmonicForce(x, p("F", 0.05), p("Omega", 0.6)),
    ]
    other = [
        sym.Mass(y, 0.05),
        sym.Spring(y, p("k2", 0.0453506), to=x),
        sym.Damper(y, p("c2", 0.0127559), to=x),
        sym.CubicSpring(y, p("knl2", 0.00416667), to=x),
    ]
    return sym.compile(sym.combine([*own, *other]))


DESIGNS: dict[str, tuple[Callable[[], sym.CompiledSystem], tuple[float, float], Free]] = {
    "friction damper": (lambda: sym.scene("jenkins-damper"), (0.9, 1.4), {"F_slider": (0.09, 0.25)}),
    "absorber, linear": (absorber, (0.6, 1.8), {"k2": (0.03, 0.06), "c2": (0.004, 0.03)}),
    "absorber, cubic": (
        absorber,
        (0.6, 1.8),
        {"k2": (0.03, 0.06), "c2": (0.004, 0.03), "knl2": (0.0, 0.01)},
    ),
    "gear, profile correction": (
        lambda: sym.scene("gear-pair"),
        (1.5, 0.5),
        {"e1": (-0.2, 0.2), "e2": (-0.1, 0.1)},
    ),
}
"""System, range of Omega, and what is free."""

EVALUATIONS = 300
"""Branches that brute force may trace."""


def designs(tell: Tell) -> Found:
    """Optimise, and let Nelder and Mead's method go on from beside the optimum, with branches alone."""
    rows: list[dict[str, Any]] = []
    for name, (made, bounds, free) in DESIGNS.items():
        tell(name)
        system = made()
        found = per.optimise(system, free, minimise=per.Response("Omega", bounds).highest(SWING))
        tell(f"{name}, brute force")
        brute, orbits = _brute(system, bounds, free, found.values)
        rows.append(
            {
                "name": name,
                "objective": found.objective,
                "values": dict(found.values),
                "reason": found.reason,
                "peaks": len(found.decisive),
                "orbits": found.orbits,
                "brute": brute,
                "brute_orbits": orbits,
                "before": _highest(system, bounds, {})[0],
            }
        )
    worst = max(row["objective"] / row["brute"] - 1 for row in rows)
    return Found(numbers={"worst_excess_ratio": worst}, rows=rows)


def _highest(
    system: sym.CompiledSystem, bounds: tuple[float, float], values: Mapping[str, float]
) -> tuple[float, int]:
    branch = per.trace(system, "Omega", bounds, values=values)
    return max(point.peak_to_peak("x") for point in branch), len(branch)


def _brute(
    system: sym.CompiledSystem, bounds: tuple[float, float], free: Free, best: Mapping[str, float]
) -> tuple[float, int]:
    """The best of a direct search by traces that begins a hundredth of the ranges beside an optimum."""
    names, orbits = list(free), 0
    low, high = np.array([free[name] for name in names]).T

    def height(x: np.ndarray) -> float:
        nonlocal orbits
        inside = np.clip(x, 0, 1)
        value, count = _highest(system, bounds, dict(zip(names, low + inside * (high - low), strict=True)))
        orbits += count
        return value * (1 + float(np.abs(x - inside).sum()))

    begin = (np.array([best[name] for name in names]) - low) / (high - low)
    simplex = np.vstack([begin + 0.01, *(begin + 0.01 + 0.02 * unit for unit in np.eye(len(names)))])
    options = {"initial_simplex": simplex, "xatol": 1e-5, "fatol": 1e-8, "maxfev": EVALUATIONS}
    found: Any = minimize(height, begin, method="Nelder-Mead", options=cast(Any, options))
    return float(found.fun), orbits


def _designs(kept: Kept) -> Mapping[str, Any]:
    table = [
        [
            row["name"],
            f"{row['before']:.6g}",
            f"{row['objective']:.9g}" + (f" ({row['reason']})" if row["reason"] else ""),
            ", ".join(f"`{name}` {value:.6g}" for name, value in row["values"].items()),
            str(row["peaks"]),
            f"{row['brute'] / row['objective'] - 1:+.0e}",
            str(row["orbits"]),
            f"{row['brute_orbits']} ({row['brute_orbits'] / row['orbits']:.0f} times as many)",
        ]
        for row in kept.rows
    ]
    return {"table": table}


SECTION = Section(
    title="Designs beside brute force", compute=designs, context=_designs, template="designs.md.j2"
)
