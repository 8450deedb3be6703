"""What is measured, and what the results are held against."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

import periodic as per
import symbolic as sym
from periodic.correction.newton import correct
from symbolic.system.compiled import with_values

NTST = (50, 100, 200, 400)
COUNTS = (2, 10, 20, 50, 100)
RADAU_4 = per.Scheme(per.Family.RADAU, 4)

FOLDS = (2.211935317020, 1.438670145514)
"""Of Duffing A in rad/s, by shooting with DOP853."""

OFF_RESONANCE = {"Omega": 1.5}
"""Where Newton finds the orbit of a chain from rest."""

CHAIN = {"m": 1.0, "c": 0.05, "k": 1.0, "k3": 0.1, "link": 0.05, "F": 0.3}
"""Of each oscillator of the chain in SI: mass, damper, linear and cubic spring to ground, spring to the next;
force on the first."""


def chain_model(count: int) -> sym.Model:
    """Return the chain: m x_i'' + c x_i' + k x_i + k3 x_i^3 + link (2 x_i - x_i-1 - x_i+1) = F cos, i = 1."""
    units = {"m": "kg", "c": "N s/m", "k": "N/m", "k3": "N/m^3", "link": "N/m"}
    m, c, k, k3, link = (sym.parameter(name, CHAIN[name], unit) for name, unit in units.items())
    x = [sym.coordinate(f"x{i + 1}") for i in range(count)]
    parts: list[sym.Part] = []
    for q in x:
        parts += [sym.Mass(q, m), sym.Damper(q, c), sym.Spring(q, k), sym.CubicSpring(q, k3)]
    parts += [sym.Coupling(q, r, link) for q, r in zip(x[:-1], x[1:], strict=True)]
    return sym.combine([*parts, sym.HarmonicForce(x[0], CHAIN["F"])])


def converged(system: sym.CompiledSystem, values: Mapping[str, float], ntst: int) -> per.Orbit:
    """Return the orbit that Newton finds from rest on an even mesh of Radau points, ncol 4."""
    method = per.Collocation(scheme=RADAU_4, ntst=ntst)
    rest = method.guess(system, with_values(system, values), None)
    found = correct(method.linearise, system, rest)
    assert found.ok
    return found.orbit


def linearisations(system: sym.CompiledSystem, orbit: per.Orbit) -> int:
    """Return how often a correction linearises: it may do so once more at its end, for the multipliers."""
    count, method = 0, per.Collocation()

    def counted(*arguments: Any) -> Any:
        nonlocal count
        count += 1
        return method.linearise(*arguments)

    correct(counted, system, orbit)
    return count


def fold_error(folds: Sequence[float]) -> float:
    """Return the largest relative error of both folds of Duffing A, infinite where there are not two."""
    if len(folds) != len(FOLDS):
        return math.inf
    return float(np.abs(np.array(folds) / FOLDS - 1).max())
