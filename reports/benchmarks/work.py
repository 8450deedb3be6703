"""What is measured, and what the results are held against."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache
from statistics import median
from time import process_time
from typing import Any

import numpy as np

import periodic as per
import symbolic as sym
from periodic.correction.newton import correct
from symbolic.system.compiled import with_values

LOOPS = 40
"""How often the calibration loop is run."""

AUTO = {1: (223, 9.8), 2: (309, 27.5), 5: (345, 161.0), 10: (345, 1000.0), 25: (345, 9200.0)}
"""Points of AUTO-07p's own executable (NTST 20, with multipliers) on the branch of a chain, and its time over
that of the calibration loop, by the number of oscillators: see `reports.benchmarks.peers.executable`."""

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


STOPPED = {"m": 1.0, "c": 0.05, "k": 1.0, "link": 0.05, "stop": 1.0, "gap": 1.0, "F": 0.3}
"""Of each oscillator of the chain with clearances in SI."""


def loop() -> float:
    """Solve small systems one by one and a large one, as much Python as LAPACK."""
    small, large = np.eye(4) + 0.1, np.eye(300) + 0.1
    total = sum(float(np.linalg.solve(small, small[k % 4])[0]) for k in range(300))
    return total + float(np.linalg.solve(large, large).trace())


@cache
def calibration() -> float:
    """Return the median processor time of that loop in s."""
    times = []
    for _ in range(LOOPS):
        begun = process_time()
        loop()
        times.append(process_time() - begun)
    return median(times)


def stopped_model(count: int) -> sym.Model:
    """Return the chain of linear oscillators, each with a spring that it meets at a clearance."""
    units = {"m": "kg", "c": "N s/m", "k": "N/m", "link": "N/m", "stop": "N/m"}
    m, c, k, link, stop = (sym.parameter(name, STOPPED[name], unit) for name, unit in units.items())
    x = [sym.coordinate(f"x{i + 1}") for i in range(count)]
    parts: list[sym.Part] = []
    for q in x:
        parts += [sym.Mass(q, m), sym.Damper(q, c), sym.Spring(q, k)]
        parts += [sym.Stop(q, sym.HertzLaw(stop, 1.0), STOPPED["gap"])]
    parts += [sym.Coupling(q, r, link) for q, r in zip(x[:-1], x[1:], strict=True)]
    return sym.combine([*parts, sym.HarmonicForce(x[0], STOPPED["F"])])


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
