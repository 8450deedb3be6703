"""Machines whose parameters are known, measured by integrators that share nothing with the engine."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym

SETTLING = 150
"""Periods of the excitation until a motion has settled."""

STEPS = 4096
"""Steps of a period of the damper's integration, whose error falls with their square."""

Motion = Callable[[float, bool], complex]
"""First harmonic of x at a frequency, from a large motion or a small one."""


@dataclass(frozen=True, kw_only=True)
class Truth:
    """A machine with hidden parameters.

    scene: the model that is fitted. hidden: the true values of what is sought, with their ranges. rising,
    falling: frequencies measured on the sheets that are reached from large and from small motions. bounds:
    the response's range. jump: which fold was seen, and how well its place is known; none if empty.
    """

    key: str
    scene: str
    hidden: Mapping[str, float]
    free: Mapping[str, tuple[float, float]]
    motion: Motion
    rising: tuple[float, ...]
    falling: tuple[float, ...]
    bounds: tuple[float, float]
    jump: tuple[int, float] | None = None

    @cached_property
    def system(self) -> sym.CompiledSystem:
        """The model that is fitted."""
        return sym.scene(self.scene)

    @property
    def response(self) -> per.Response:
        """What was measured."""
        return per.Response("Omega", self.bounds)

    @cached_property
    def exact(self) -> np.ndarray:
        """The amplitudes without noise."""
        both = [(w, True) for w in self.rising] + [(w, False) for w in self.falling]
        return np.array([abs(self.motion(*each)) for each in both])

    @cached_property
    def fold(self) -> float:
        """The place of the fold that was seen, of the model at the hidden values."""
        assert self.jump is not None
        branch = per.trace(self.system, "Omega", self.bounds, values=self.hidden, tol=1e-8)
        return float(branch.labelled("LP")[self.jump[0]].parameter)

    def measured(self, noise: float, rng: np.random.Generator) -> list[per.Measured | per.MeasuredQuantity]:
        """Return data with a relative noise of amplitudes, 1e-4 of frequencies, and of the jump."""
        omegas = np.array([*self.rising, *self.falling])
        seen = omegas * (1 + 1e-4 * rng.standard_normal(len(omegas)))
        amplitudes = self.exact * (1 + noise * rng.standard_normal(len(omegas)))
        size = per.Amplitude("x")
        data: list[per.Measured | per.MeasuredQuantity] = [
            per.Measured(
                self.response,
                seen.tolist(),
                {size: amplitudes.tolist()},
                sigma={size: (noise * self.exact).tolist()},
            )
        ]
        if self.jump is not None:
            which, sigma = self.jump
            place = self.fold + sigma * float(rng.standard_normal())
            data.append(per.MeasuredQuantity(self.response.place("LP", which=which), place, sigma))
        return data


def _harmonic(omega: float, t: np.ndarray, x: np.ndarray) -> complex:
    period = 2 * math.pi / omega
    return complex(2 * np.trapezoid(x * np.exp(-1j * omega * t), t) / period)


def _settled(rate: Callable, omega: float, begin: list[float]) -> complex:
    period = 2 * math.pi / omega
    last = solve_ivp(rate, (0, SETTLING * period), begin, method="DOP853", rtol=1e-8, atol=1e-10).y[:, -1]
    t = np.linspace(0, period, 513)
    found = solve_ivp(rate, (0, period), last, method="DOP853", rtol=1e-9, atol=1e-11, t_eval=t)
    return _harmonic(omega, t, found.y[0])


def duffing(omega: float, large: bool) -> complex:
    """x'' + c x' + k x + k3 x^3 = F cos(Omega t), F = .5."""
    k, k3, c = HIDDEN["duffing"].values()

    def rate(t: float, y: np.ndarray) -> list[float]:
        return [y[1], 0.5 * math.cos(omega * t) - c * y[1] - k * y[0] - k3 * y[0] ** 3]

    return _settled(rate, omega, [2.2, 0.0] if large else [0.0, 0.0])


def gear(omega: float, large: bool) -> complex:
    """x'' + c x' + k(t) g(x) = F - e'', g without force in the backlash: as the scene has it."""
    stiffness, damping = HIDDEN["gear-pair"].values()
    system = sym.scene("gear-pair")
    known = {p.name: p.value for p in system.parameters}
    waves = [(known["k1"], known["e1"]), (known["k2"], known["e2"]), (known["k3"], known["e3"])]

    def rate(t: float, y: np.ndarray) -> list[float]:
        tau = omega * t
        mesh = stiffness * (1 - sum(k * math.cos(n * tau) for n, (k, _) in enumerate(waves, 1)))
        error = omega**2 * sum(n**2 * e * math.cos(n * tau) for n, (_, e) in enumerate(waves, 1))
        gap = known["backlash"]
        beyond = y[0] - gap if y[0] > gap else (y[0] + gap if y[0] < -gap else 0.0)
        return [y[1], known["F_m"] + error - damping * y[1] - mesh * beyond]

    return _settled(rate, omega, [2.0, 0.0] if large else [1.1, 0.0])


def damper(omega: float, large: bool) -> complex:
    """A mass on a spring with a Jenkins element, by half steps of the midpoint rule and its return map."""
    limit, damping = HIDDEN["jenkins-damper"].values()
    known = {p.name: p.value for p in sym.scene("jenkins-damper").parameters}
    elastic, force = known["k_slider"], known["F"]
    h = 2 * math.pi / omega / STEPS
    x, v, z = 0.0, 0.0, 0.0
    kept = np.zeros(STEPS + 1)
    periods = 160
    waves = force * np.cos(2 * math.pi * (np.arange(STEPS) + 0.5) / STEPS)

    def moved(x: float, z: float) -> tuple[float, float]:
        pull = elastic * (x - z)
        if pull > limit:
            return limit, x - limit / elastic
        if pull < -limit:
            return -limit, x + limit / elastic
        return pull, z

    for turn in range(periods):
        for k in range(STEPS):
            if turn == periods - 1:
                kept[k] = x
            middle = x + 0.5 * h * v
            joint, z = moved(middle, z)
            accelerated = (waves[k] - middle - joint - damping * v) / (1 + 0.5 * h * damping)
            v += h * accelerated
            x = middle + 0.5 * h * v
    kept[STEPS] = x
    return _harmonic(omega, np.linspace(0, STEPS * h, STEPS + 1), kept)


HIDDEN = {
    "duffing": {"k": 1.05, "k3": 0.9, "c": 0.12},
    "gear-pair": {"mesh_stiffness": 1.03, "c": 0.11},
    "jenkins-damper": {"F_slider": 0.11, "c": 0.03},
}
"""The parameters that fits look for."""

TRUTHS = (
    Truth(
        key="coverage-duffing",
        scene="duffing",
        hidden=HIDDEN["duffing"],
        free={"k": (0.5, 2.0), "k3": (0.2, 3.0), "c": (0.02, 0.4)},
        motion=duffing,
        rising=(0.7, 0.9, 1.1, 1.3, 1.5, 1.7, 1.85),
        falling=(2.4, 2.2, 2.0, 1.8),
        bounds=(0.4, 2.8),
        jump=(0, 0.01),
    ),
    Truth(
        key="coverage-gear-pair",
        scene="gear-pair",
        hidden=HIDDEN["gear-pair"],
        free={"mesh_stiffness": (0.8, 1.3), "c": (0.05, 0.2)},
        motion=gear,
        rising=(0.62, 0.68, 0.74, 0.8),
        falling=(0.9, 1.0, 1.1, 1.2, 1.3, 1.4),
        bounds=(0.5, 1.5),
    ),
    Truth(
        key="coverage-jenkins-damper",
        scene="jenkins-damper",
        hidden=HIDDEN["jenkins-damper"],
        free={"F_slider": (0.05, 0.2), "c": (0.005, 0.1)},
        motion=damper,
        rising=(0.9, 0.98, 1.02, 1.06, 1.09, 1.12, 1.16, 1.22, 1.3),
        falling=(),
        bounds=(0.8, 1.5),
    ),
)
"""In the order of the page."""
