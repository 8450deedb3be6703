"""Problems and measurements of the dial: whole branches at a tolerance, held against tight ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cache
from itertools import zip_longest
from time import process_time
from typing import Any

import numpy as np

import periodic as per
import symbolic as sym
from periodic.orbit.construction import bisect
from reports.studies.trade.methods import problems
from symbolic.parts.equations import Names
from symbolic.scenes.axes import RPM
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

TIGHTEST = 1e-11
"""Tolerance of the references, and ten times as much where that is not reached."""


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A branch between two values of a parameter, with points at some; born: from a Hopf point."""

    name: str
    system: Callable[[], sym.CompiledSystem]
    parameter: str
    ends: tuple[float, float]
    at: tuple[float, ...]
    born: bool = False

    def traced(self, tol: float) -> per.Branch:
        """Return the branch at a tolerance."""
        system = self.system()
        options: dict[str, Any] = {"start": self.ends[0], "at": self.at, "tol": tol}
        if self.born:
            equilibria = per.trace(system, self.parameter, self.ends, method=per.Equilibrium())
            rest = equilibria.labelled(per.Label.HOPF)[0]
            options = {
                "guess": per.hopf(system, rest.orbit, self.parameter),
                "determined": {"omega": per.PhaseCondition()},
                "at": self.at,
                "tol": tol,
            }
        return per.trace(system, self.parameter, (min(self.ends), max(self.ends)), **options)


@cache
def _scene(name: str) -> sym.CompiledSystem:
    return build(load(name))


@cache
def _oscillator(damping: float, cubic: float, force: float) -> sym.CompiledSystem:
    """x'' + damping x' + x + cubic x^3 = force cos Omega t."""
    x = sym.coordinate("x")
    oscillator = sym.Mass(x, 1.0) + sym.Damper(x, damping) + sym.Spring(x, 1.0)
    return sym.compile(oscillator + sym.CubicSpring(x, cubic) + sym.HarmonicForce(x, force))


@cache
def _feedback() -> sym.CompiledSystem:
    # x_ttt + alpha x_tt + x_t + x = x^2

    def rates(x: Names, p: Names) -> dict[str, Any]:
        return {"x": x.v, "v": x.w, "w": -p.alpha * x.w - x.v - x.x + x.x**2}

    return sym.compile(sym.Equations(rates, states=dict.fromkeys("xvw", 0.0), parameters={"alpha": 1.2}))


@cache
def _entrained() -> sym.CompiledSystem:
    """x'' - mu (1 - x^2) x' + x = F cos Omega t."""
    return sym.compile(
        sym.Equations(
            lambda x, p, wave: {"x": x.v, "v": p.mu * (1 - x.x**2) * x.v - x.x + p.F * wave.cos},
            states={"x": 0.0, "v": 0.0},
            parameters={"mu": 0.2, "F": 0.2, "Omega": 1.0},
            frequency="Omega",
        )
    )


def _disc(name: str, end: float) -> Problem:
    speeds = tuple(v * RPM for v in (450.0, 360.0, 300.0, 287.0, 260.0, 245.0) if v > end)
    return Problem(
        name=name, system=lambda: _scene(name), parameter="speed", ends=(500 * RPM, end * RPM), at=speeds
    )


def _forced(name: str, values: tuple[float, float, float], ends: tuple[float, float], *at: float) -> Problem:
    return Problem(name=name, system=lambda: _oscillator(*values), parameter="Omega", ends=ends, at=at)


PROBLEMS = (
    _forced("linear oscillator", (0.05, 0.0, 0.5), (0.5, 2.0), 0.7, 0.99, 1.2, 1.5),
    _forced("Duffing A", (0.1, 1.0, 0.5), (0.3, 3.0), 0.5, 1.0, 1.7, 2.0, 2.5),
    _forced("Duffing (NLvib)", (0.05, 0.1, 0.18), (0.5, 2.0), 0.7, 1.05, 1.2, 1.5),
    Problem(
        name="forced van der Pol", system=_entrained, parameter="Omega", ends=(1.0, 1.3), at=(1.01, 1.03)
    ),
    Problem(
        name="feedback control",
        system=_feedback,
        parameter="alpha",
        ends=(1.2, 0.6),
        at=(0.9, 0.8, 0.7),
        born=True,
    ),
    Problem(
        name="chain of 3",
        system=lambda: problems.chain(3).system,
        parameter="Omega",
        ends=(0.6, 1.6),
        at=(0.8, 1.0, 1.1, 1.3),
    ),
    _disc("vitrea79-810N", 100.0),
    _disc("vitrea79-2100N", 150.0),
    _disc("turbo33-810N", 270.0),
    _disc("dry-810N", 150.0),
    _disc("quasistatic-film-810N", 150.0),
    _disc("cavitating-film-810N", 150.0),
    _disc("supports-810N", 100.0),
)


@dataclass(frozen=True, kw_only=True)
class Compared:
    """Errors of one branch at one tolerance, all relative, and what it said of itself.

    extent, place, multiplier: the largest errors of x peak to peak (at given values of the parameter), of the
    LPs and of the multipliers. orbits: (estimate, true error) of every orbit compared. failure: why there is
    nothing to compare.
    """

    problem: str
    tol: float
    extent: float = 0.0
    place: float = 0.0
    multiplier: float = 0.0
    estimated: float = 0.0
    orbits: tuple[tuple[float, float], ...] = ()
    seconds: float = 0.0
    points: int = 0
    failure: str = ""

    @property
    def worst(self) -> float:
        """The largest of the three errors."""
        return max(self.extent, self.place, self.multiplier)

    def kept(self) -> dict[str, Any]:
        """Return what is kept of it."""
        return asdict(self)


def references(problem: Problem) -> tuple[float, per.Branch]:
    """Return the tolerance of the tightest branch that reaches its end, and the branch."""
    for tol in (TIGHTEST, 10 * TIGHTEST, 100 * TIGHTEST):
        found = problem.traced(tol)
        if found.stop.reason is per.Reason.BOUND:
            break
    return tol, found


def compared(problem: Problem, tol: float, reference: per.Branch) -> Compared:
    """Return the errors of a branch at a tolerance."""
    clock = process_time()
    found = problem.traced(tol)
    spent = process_time() - clock
    own = [_marked(branch) for branch in (found, reference)]
    if [p.label for p in own[0]] != [p.label for p in own[1]]:
        why = f"{len(own[0])} marked points, reference {len(own[1])}; {found.stop}"
        return Compared(problem=problem.name, tol=tol, seconds=spent, points=len(found), failure=why)
    pairs = list(zip_longest(*own))
    fixed = [(a, b) for a, b in pairs if a.label is per.Label.USER]
    turns = [(a, b) for a, b in pairs if a.label is per.Label.FOLD]
    name = found.layout.outputs[0].name
    return Compared(
        problem=problem.name,
        tol=tol,
        extent=max((_relative(_extent(a, name), _extent(b, name)) for a, b in fixed), default=0.0),
        place=max((_relative(a.parameter, b.parameter) for a, b in turns), default=0.0),
        multiplier=max(_apart(a, b) for a, b in pairs),
        estimated=max(point.error.worst for point in found),
        orbits=() if problem.born else tuple((a.error.orbit, _distance(a, b)) for a, b in fixed),
        seconds=spent,
        points=len(found),
    )


def _marked(branch: per.Branch) -> list[per.Point]:
    return [point for point in branch if point.label in (per.Label.USER, per.Label.FOLD)]


def _extent(point: per.Point, output: str) -> float:
    return point.maximum[output] - point.minimum[output]


def _relative(found: float, true: float) -> float:
    return abs(found - true) / abs(true)


def _apart(found: per.Point, true: per.Point) -> float:
    """Distance of two spectra, each multiplier from its nearest, relative to the largest above 1."""
    left = list(found.multipliers)
    distances = []
    for multiplier in true.multipliers:
        nearest = int(np.argmin(np.abs(np.array(left) - multiplier)))
        distances.append(abs(left.pop(nearest) - multiplier))
    return float(max(distances) / max(1.0, np.abs(true.multipliers).max()))


def _distance(found: per.Point, true: per.Point) -> float:
    """Largest distance of two orbits in their states over their largest peak to peak."""
    phases = bisect(found.orbit).stage_phases.ravel()
    states = [point.orbit.state(phases) for point in (found, true)]
    return float(np.abs(states[0] - states[1]).max() / np.ptp(states[1], axis=0).max())
