"""Cycles of equations without excitation, which others have proven too."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

import periodic as per
import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.proof.proving import proven, shown

Rates = Callable[[float, np.ndarray], Sequence[float]]


def from_cycle(
    system: sym.CompiledSystem, parameter: tuple[str, float], values: np.ndarray, period: float
) -> per.Point:
    """Return the engine's cycle at a parameter's value, from states at equal times over the period."""
    phase, values = np.linspace(0, 2 * np.pi, len(values)), values.copy()
    values[-1] = values[0]
    name, value = parameter
    given = {name: value, "omega": 2 * np.pi / period}
    branch = per.trace(
        system,
        name,
        (value, value * 1.001),
        guess=per.sampled(phase, values, np.zeros((len(phase), 0)), given, system=system),
        determined={"omega": per.PhaseCondition()},
        watch=per.Watch(peaks={}),
        control=per.ArclengthControl(max_points=2),
    )
    return branch[0]


@dataclass(frozen=True, kw_only=True)
class Cycle:
    """Cycles of equations with a parameter, each by a state near it and its period."""

    key: str
    title: str
    equations: sym.Equations
    rates: Rates
    parameter: tuple[str, float]
    near: tuple[tuple[tuple[float, ...], float], ...]
    words: str = ""

    @cached_property
    def section(self) -> Section:
        """The section of the page."""
        return Section(
            title=self.title, compute=self._compute, context=self._context, template="proven.md.j2"
        )

    def _compute(self, tell: Tell) -> Found:
        system = sym.compile(self.equations)
        points = []
        for state, period in self.near:
            tell(f"period {period:g}")
            points.append((self.traced(system, *self._closed(state, period)), None))
        return proven(system, points, tell)

    def traced(self, system: sym.CompiledSystem, state: tuple[float, ...], period: float) -> per.Point:
        """The engine's cycle, from a state on it."""
        times = np.linspace(0, period, 1001)
        values = solve_ivp(self.rates, (0, period), state, t_eval=times, rtol=1e-11, atol=1e-12).y.T
        return from_cycle(system, self.parameter, values, period)

    def _closed(self, state: tuple[float, ...], period: float) -> tuple[tuple[float, ...], float]:
        """A state of the cycle, and its period, by shooting, the first component held."""
        first = state[0]

        def missed(u: np.ndarray) -> np.ndarray:
            begin = np.array([first, *u[:-1]])
            return solve_ivp(self.rates, (0, u[-1]), begin, rtol=1e-11, atol=1e-12).y[:, -1] - begin

        *rest, period = fsolve(missed, [*state[1:], period], xtol=1e-10)
        return (first, *rest), period

    def _context(self, kept: Kept) -> Mapping[str, Any]:
        return {"words": self.words, "axis": self.parameter[0], "table": shown(kept.rows)}


def _roessler(_: float, y: np.ndarray) -> list[float]:
    return [-y[1] - y[2], y[0] + 0.2 * y[1], 0.2 + y[2] * (y[0] - 5.7)]


def _van_der_pol(_: float, y: np.ndarray) -> list[float]:
    return [y[1], (1 - y[0] ** 2) * y[1] - y[0]]


def lorenz(_: float, y: np.ndarray) -> list[float]:
    """Rates of his equations."""
    return [10 * (y[1] - y[0]), 28 * y[0] - y[1] - y[0] * y[2], y[0] * y[1] - 8 / 3 * y[2]]


ROESSLER = (
    ((0.0, -8.38094174, 0.02959006), 5.88108846),
    ((0.0, -9.51986079, 0.02909214), 11.75862607),
    ((0.0, -10.38798908, 0.02873552), 17.51579107),
)
"""Of one, two and three turns, where they pass x = 0: a state, and the period."""

LORENZ = (
    ((-2.14736763, 2.07804821, 27.0), 1.55865221),
    ((-2.52882238, 1.55505506, 27.0), 2.30590726),
    ((2.52882238, -1.55505506, 27.0), 2.30590726),
    ((-2.69013751, 1.32875997, 27.0), 3.02358370),
    ((-0.39094435, 4.25683755, 27.0), 3.02358370),
    ((3.35641314, -0.36270541, 27.0), 3.08427678),
    ((4.57016649, 1.51775613, 27.0), 3.72564177),
    ((-5.04150027, -2.28884461, 27.0), 3.72564177),
    ((-3.16277724, 0.64849027, 27.0), 3.82025416),
    ((-4.25045710, -1.00850192, 27.0), 3.82025416),
    ((-2.49685428, 1.59940206, 27.0), 3.86953911),
    ((-1.97401645, 2.31010019, 27.0), 3.86953911),
    ((-4.81895679, -1.92255574, 27.0), 4.53410795),
    ((4.26478925, 1.03042741, 27.0), 4.53410795),
    ((4.12651943, 0.81348044, 27.0), 4.56631114),
    ((-2.66513848, 1.36385254, 27.0), 4.59381435),
    ((2.26306529, -1.92130343, 27.0), 4.59381435),
    ((-2.01592760, 2.25440721, 27.0), 4.63714079),
    ((1.46757715, -2.96716923, 27.0), 4.63714079),
    ((4.82525091, 1.93178964, 27.0), 5.23419821),
)
"""Twenty of the shortest, where they pass z = 27: a state, and the period."""

CYCLES = (
    Cycle(
        key="van-der-pol",
        title="Van der Pol's cycle, μ = 1",
        equations=sym.Equations(
            lambda x, p: {"x": x.v, "v": p.mu * (1 - x.x**2) * x.v - x.x},
            states={"x": 0.0, "v": 0.0},
            parameters={"mu": 1.0},
        ),
        rates=_van_der_pol,
        parameter=("mu", 1.0),
        near=(((0.0, 2.17), 6.6633),),
    ),
    Cycle(
        key="roessler",
        title="Rössler's equations: the cycles of one, two and three turns",
        equations=sym.Equations(
            lambda x, p: {"x": -x.y - x.z, "y": x.x + 0.2 * x.y, "z": p.b + x.z * (x.x - 5.7)},
            states={"x": 0.0, "y": 0.0, "z": 0.0},
            parameters={"b": 0.2},
        ),
        rates=_roessler,
        parameter=("b", 0.2),
        near=ROESSLER,
        words="Proven by Wilczak and Zgliczyński with CAPD; the period of the first is 5.8810884555.",
    ),
    Cycle(
        key="lorenz",
        title="Lorenz' equations: the shortest cycles",
        equations=sym.Equations(
            lambda x, p: {
                "x": 10 * (x.y - x.x),
                "y": p.rho * x.x - x.y - x.x * x.z,
                "z": x.x * x.y - 8 / 3 * x.z,
            },
            states={"x": 0.0, "y": 0.0, "z": 0.0},
            parameters={"rho": 28.0},
        ),
        rates=lorenz,
        parameter=("rho", 28.0),
        near=LORENZ,
    ),
)
"""In the order of the page."""
