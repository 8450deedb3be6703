"""What a proof costs as equations become stiffer, and more."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.proof.cycles import from_cycle
from reports.studies.proof.proving import row, shown

Made = Callable[[int], tuple[sym.CompiledSystem, per.Point]]


@dataclass(frozen=True, kw_only=True)
class Cost:
    """Systems by a number, and an orbit of each."""

    key: str
    title: str
    axis: str
    made: Made
    numbers: tuple[int, ...]
    words: str

    @cached_property
    def section(self) -> Section:
        """The section of the page."""
        return Section(
            title=self.title, compute=self._compute, context=self._context, template="proven.md.j2"
        )

    def _compute(self, tell: Tell) -> Found:
        rows = []
        for number in self.numbers:
            tell(f"{self.axis} {number}")
            rows.append({**row(*self.made(number), None), "place": float(number)})
        return Found(numbers={"proven": sum(each["proven"] for each in rows)}, rows=rows)

    def _context(self, kept: Kept) -> Mapping[str, Any]:
        return {"words": self.words, "axis": self.axis, "table": shown(kept.rows)}


def van_der_pol(mu: int) -> tuple[sym.CompiledSystem, per.Point]:
    """A relaxation oscillation, from a settled motion."""
    system = sym.compile(
        sym.Equations(
            lambda x, p: {"x": x.v, "v": p.mu * (1 - x.x**2) * x.v - x.x},
            states={"x": 0.0, "v": 0.0},
            parameters={"mu": float(mu)},
        )
    )

    def rates(_: float, y: np.ndarray) -> list[float]:
        return [y[1], mu * (1 - y[0] ** 2) * y[1] - y[0]]

    def falls(_: float, y: np.ndarray) -> float:
        return float(y[0])

    falls.direction = -1.0  # type: ignore[attr-defined]
    settled = solve_ivp(
        rates, (0, 12 * (mu + 4)), [2.0, 0.0], method="Radau", events=falls, rtol=1e-10, atol=1e-12
    )
    times, states = np.array(settled.t_events)[0], np.array(settled.y_events)[0]
    period = times[-1] - times[-2]
    times = np.linspace(0, period, 4001)
    cycle = solve_ivp(
        rates, (0, period), states[-2], method="Radau", t_eval=times, rtol=1e-10, atol=1e-12
    ).y.T
    return system, from_cycle(system, ("mu", float(mu)), cycle, period)


def chain(states: int) -> tuple[sym.CompiledSystem, per.Point]:
    """Masses in a row, each with a cubic spring to ground, the first one forced, near the first resonance."""
    count, Omega = states // 2, sym.parameter("Omega", 1.1)
    masses = [sym.coordinate(f"x{k}") for k in range(count)]
    parts: list[sym.Part] = [sym.HarmonicForce(masses[0], force=0.2, frequency=Omega)]
    for k, x in enumerate(masses):
        parts += [sym.Mass(x, 1.0), sym.Damper(x, 0.1), sym.Spring(x, 1.0), sym.CubicSpring(x, 0.5)]
        if k:
            parts.append(sym.Spring(masses[k - 1], 0.3, to=x))
    system = sym.compile(sym.combine(parts))
    return system, per.trace(system, "Omega", (1.1, 1.2))[0]


COSTS = (
    Cost(
        key="stiffness",
        title="Stiffness: van der Pol's cycle as μ grows",
        axis="μ",
        made=van_der_pol,
        numbers=(1, 2, 4, 8, 16, 32),
        words="A step is about as long as the fastest motion takes.",
    ),
    Cost(
        key="states",
        title="States: a chain of cubic oscillators",
        axis="states",
        made=chain,
        numbers=(2, 4, 6, 8, 12, 16),
        words="",
    ),
)
"""In the order of the page."""
