"""Models built in Python for the tests of `symbolic`, and random points at which to evaluate them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

import symbolic as sym
from support.kept import once
from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Coordinate, Value

Array = NDArray[np.float64]
RPM = 2 * math.pi / 60
MASS, PRELOAD, HERTZ, AMPLITUDE, WAVES, RADIUS = 20.4, 810.0, 28e9, 1.27e-6, 120, 0.051
VITREA = {"viscosity": 0.890, "piezoviscosity": 25.9e-9}


@dataclass(frozen=True)
class Disc:
    """The wavy disc of physics.md; None leaves a part out, `two` gives each disc a coordinate of its own.

    film is "squeeze", "quasistatic" or None. `support` (1/s^2) holds each disc with a spring of that
    stiffness per unit of its mass, so that X = x1 + x2 feels the same spring per unit of reduced mass.
    """

    film: str | None = "squeeze"
    zeta: Value | None = None
    beta: Value = 22.23
    squeeze: Value = 2734.3
    amplitude: Value | None = AMPLITUDE
    masses: tuple[float, float] = (MASS, MASS)
    support: float | None = None
    two: bool = False

    def parts(self) -> list[sym.Part]:
        """The parts of the scene, inertia first."""
        speed = sym.parameter("speed", 360 * RPM, "rad/s")
        coordinates, parts = self._bodies()
        pair = sym.ContactPair(*coordinates)
        parts += [sym.Preload(pair, PRELOAD), sym.Hertz(pair, HERTZ)]
        if self.amplitude is not None:
            parts.append(sym.Waviness(pair, self.amplitude, WAVES, speed))
        law = sym.films.CalibratedThickness(speed, RADIUS, **VITREA)
        if self.film == "squeeze":
            parts.append(sym.SqueezeFilm(pair, law, speed, RADIUS, self.beta, self.squeeze))
        if self.film == "quasistatic":
            parts.append(sym.films.QuasistaticFilm(pair, law, self.beta))
        if self.zeta is not None:
            parts.append(sym.ContactDamping(pair, self.zeta))
        return parts

    def _bodies(self) -> tuple[list[Coordinate], list[sym.Part]]:
        m1, m2 = (sym.parameter(f"m{i + 1}", m, "kg") for i, m in enumerate(self.masses))
        if self.two:
            x1, x2 = sym.coordinate("x1"), sym.coordinate("x2")
            coordinates, parts = [x1, x2], [sym.Mass(x1, m1), sym.Mass(x2, m2)]
            carried = list(self.masses)
        else:
            x = sym.coordinate("x")
            coordinates, parts = [x], [sym.ReducedMass(x, m1, m2)]
            carried = [self.masses[0] * self.masses[1] / sum(self.masses)]
        if self.support is not None:
            for i, (q, m) in enumerate(zip(coordinates, carried, strict=True)):
                parts.append(sym.Spring(q, sym.parameter(f"k{i + 1}", self.support * m, "N/m")))
        return coordinates, parts

    def compile(self) -> sym.CompiledSystem:
        """The compiled scene."""
        return sym.compile(sym.combine(self.parts()))


def duffing_parts(cubic: float | None = 1.0, damping: float | None = 0.1) -> list[sym.Part]:
    """Problem A: x'' + 0.1 x' + x + x^3 = 0.5 cos Omega t; None leaves a part out."""
    x = sym.coordinate("x")
    parts: list[sym.Part] = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.HarmonicForce(x, 0.5, 0.8)]
    if damping is not None:
        parts.append(sym.Damper(x, damping))
    if cubic is not None:
        parts.append(sym.CubicSpring(x, cubic))
    return parts


@dataclass(frozen=True)
class Relaxation(sym.Part):
    """A part from outside the package, the smallest that fills every array: one state, one parameter.

    omega T' + sin(T) (2 + cos tau) = 0, with a switch at T = omega cos tau.
    """

    def contribute(self, assembly: Assembly) -> None:
        """Add the state, its row, an output and the switch."""
        omega = assembly.parameter(1.3, "omega", "rad/s")
        assembly.excite(omega)
        T = assembly.state("T", "K", 2.0, 0 * omega)
        row = omega * T.derivative + ca.sin(T.symbol) * (2 + ca.cos(assembly.phase))
        assembly.differential_rows.append(row)
        assembly.output("T", "K", T.symbol)
        assembly.switch("T = omega cos tau", T.symbol - omega * ca.cos(assembly.phase), 0)


PARTS: dict[str, Callable[[], list[sym.Part]]] = {
    "dry": Disc(film=None, zeta=0.007).parts,
    "quasistatic": Disc(film="quasistatic", zeta=0.007).parts,
    "squeeze": Disc().parts,
    "two discs, dry": Disc(film=None, zeta=0.007, masses=(20.4, 31.0), two=True).parts,
    "two discs, squeeze": Disc(masses=(20.4, 31.0), two=True, support=1e4).parts,
    "duffing": duffing_parts,
    "relaxation": lambda: [Relaxation()],
}
"""Parts of every scene that the tests of `symbolic` go through."""

REGIMES = {"touching": (-3.0, 3.0), "pressed": (5.0, 35.0), "deep": (42.0, 60.0), "lost": (-45.0, -35.0)}
"""Ranges of xi, none of which holds a place where softplus is put together."""


@once
def scene(name: str) -> sym.CompiledSystem:
    """The compiled scene of that name."""
    return sym.compile(sym.combine(PARTS[name]()))


@dataclass(frozen=True)
class Points:
    """Arguments of a system: rate, state (N, n), algebraic (N, m), phase (N,), parameter (p,)."""

    rate: Array
    state: Array
    algebraic: Array
    phase: Array
    parameter: Array

    @property
    def arguments(self) -> tuple[Array, Array, Array, Array, Array]:
        """In the order in which a system takes them."""
        return self.rate, self.state, self.algebraic, self.phase, self.parameter


def draw(system: sym.CompiledSystem, regime: str = "touching", count: int = 7, seed: int = 0) -> Points:
    """Random points of a system in one regime of contact, the film near its steady thickness."""
    rng = np.random.default_rng(seed)
    parameter = system.nominal * rng.uniform(0.9, 1.1, len(system.parameters))
    low, high = REGIMES[regime]
    xi = rng.uniform(low, high, (count, len(system.algebraics)))
    rest = system.rest(parameter)[0]
    state = rest * rng.uniform(0.7, 1.4, (count, len(rest)))
    resting = rest == 0
    state[:, resting] = rng.uniform(-0.4, 0.4, (count, int(resting.sum())))
    for i, variable in enumerate(system.states):
        if variable.name in ("x", "x1") and regime != "touching" and system.outputs[-1].name == "load":
            state[:, i] -= math.copysign(1, high) * (3 + rng.uniform(0, 40, count))
    return Points(rng.uniform(-1, 1, state.shape), state, xi, rng.uniform(0, 2 * math.pi, count), parameter)


def reorder(points: Points, source: sym.CompiledSystem, target: sym.CompiledSystem) -> Points:
    """The same points for a system whose states and parameters come in another order."""
    states, parameters = indices(source.states, target.states), indices(source.parameters, target.parameters)
    rate, state, algebraic, phase, parameter = points.arguments
    return Points(rate[:, states], state[:, states], algebraic, phase, parameter[parameters])


def indices(source: tuple[sym.Variable, ...], target: tuple[sym.Variable, ...]) -> list[int]:
    """For each variable of the target its index in the source, by name."""
    names = [v.name for v in source]
    return [names.index(v.name) for v in target]


def residual_in_order(points: Points, source: sym.CompiledSystem, target: sym.CompiledSystem) -> Array:
    """Residual of the target at points of the source, its differential rows in the source's order."""
    residual = target.residual(*reorder(points, source, target).arguments)
    back = indices(target.states, source.states)
    count = len(back)
    return np.concatenate([residual[:, back], residual[:, count:]], axis=1)
