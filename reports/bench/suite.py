"""What is measured of this project: branches, Newton iterations, start-up."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

import periodic as per
import symbolic as sym
from periodic.mesh import uniform
from periodic.newton import Outcome, correct, linear_step
from periodic.orbit import transfer
from reports.bench.clock import ONE_THREAD, median, wall
from reports.build import build
from reports.scene import load
from reports.trade.problems import chain_model
from reports.view import RPM

NTST = (50, 100, 200, 400)
COUNTS = (2, 10, 20, 50, 100)
RADAU_4 = per.Scheme(per.Family.RADAU, 4)

FOLDS = (2.211935317020, 1.438670145514)
"""Of Duffing A in rad/s, by shooting with DOP853."""

OFF_RESONANCE = {"Omega": 1.5}
"""Where Newton finds the orbit of a chain from rest."""

Numbers = dict[str, float]
"""Results by name; a name ends with its unit."""


@dataclass(frozen=True)
class Benchmark:
    """A benchmark and what measures it."""

    name: str
    run: Callable[[], Numbers]


def disc(accuracy: per.Accuracy) -> Numbers:
    """Trace the disc from 500 to 100 rev/min."""
    system = build(load("vitrea79-810N"))
    return _branch(lambda: per.trace(system, "speed", (500 * RPM, 100 * RPM), accuracy=accuracy))


def duffing(accuracy: per.Accuracy) -> Numbers:
    """Trace Duffing A from 0.3 to 3 rad/s."""
    system = build(load("duffing"))
    found = per.trace(system, "Omega", (0.3, 3.0), accuracy=accuracy)
    folds = [p.parameter for p in found.labelled(per.Label.FOLD)]
    numbers = _branch(lambda: per.trace(system, "Omega", (0.3, 3.0), accuracy=accuracy))
    return numbers | {"fold error": fold_error(folds)}


def fold_error(folds: Sequence[float]) -> float:
    """Return the largest relative error of both folds of Duffing A, infinite where there are not two."""
    if len(folds) != len(FOLDS):
        return math.inf
    return max(abs(f / known - 1) for f, known in zip(folds, FOLDS, strict=True))


def _branch(traced: Callable[[], per.Branch]) -> Numbers:
    branch = traced()
    seconds = median(traced)
    return {
        "s": seconds,
        "points": float(len(branch)),
        "iterations": float(branch.newton_iterations),
        "per point ms": 1e3 * seconds / len(branch),
    }


def disc_iterations() -> Numbers:
    """Newton iterations on the disc at 360 rev/min, ncol 4: ms for each, by ntst."""
    system = build(load("vitrea79-810N"))
    return {f"ntst {ntst} ms": iteration(system, {"speed": 360 * RPM}, ntst) for ntst in NTST}


def chain_iterations() -> Numbers:
    """The same on chains of oscillators at ntst 20, by their number."""
    return {
        f"{count} oscillators ms": iteration(sym.compile(chain_model(count)), OFF_RESONANCE, 20)
        for count in COUNTS
    }


def iteration(system: sym.CompiledSystem, values: Mapping[str, float], ntst: int) -> float:
    """Return the ms of one Newton iteration: those of a converged orbit corrected again and again."""
    orbit, linearised = converged(system, values, ntst), 0

    def counted(*arguments: Any) -> Any:
        nonlocal linearised
        linearised += 1
        return linear_step(*arguments)

    # The first run is for the count: a correction may linearise once more at its end, for the multipliers.
    correct(system, orbit, increment=counted)
    return 1e3 * median(lambda: correct(system, orbit), 15) / linearised


def converged(system: sym.CompiledSystem, values: Mapping[str, float], ntst: int) -> per.Orbit:
    """Return the orbit that Newton finds from rest on an even mesh of Radau points, ncol 4."""
    (name, value), mesh = next(iter(values.items())), uniform(RADAU_4, ntst)
    parameter = np.array(system.nominal, dtype=float)
    parameter[[p.name for p in system.parameters].index(name)] = value
    rest = per.Collocation().rest(system, per.MeshSettings(scheme=RADAU_4, ntst=ntst), parameter)
    found = correct(system, transfer(rest, mesh, rest.phases))
    assert found.outcome is Outcome.CONVERGED
    return found.orbit


def memory() -> Numbers:
    """What Newton on a chain of 50 oscillators, 100 states, needs at ntst 400: peak in MB, fresh process."""
    told = _run([sys.executable, "-m", "reports.bench.memory"])
    before, peak = json.loads(told)
    return {"peak MB": peak, "of which Newton MB": peak - before}


def start_up() -> Numbers:
    """Fresh processes, wall time: the import, the help, a first trace from the command line to its files."""
    main = "import sys; from reports.cli import main; sys.exit(main())"
    with tempfile.TemporaryDirectory() as folder:
        trace = [sys.executable, "-c", main, "trace", "vitrea79-810N", "--out", folder]
        return {
            "import s": median(lambda: _run([sys.executable, "-c", "import periodic, symbolic"]), clock=wall),
            "help s": median(lambda: _run([sys.executable, "-c", main, "--help"]), clock=wall),
            "first trace s": median(lambda: _run(trace), 3, clock=wall),
        }


def _run(command: list[str]) -> str:
    return subprocess.run(
        command, check=True, capture_output=True, text=True, env=os.environ | ONE_THREAD
    ).stdout


OWN = (
    *(Benchmark(f"disc branch, {a.name.lower()}", partial(disc, a)) for a in per.Accuracy),
    *(Benchmark(f"Duffing A branch, {a.name.lower()}", partial(duffing, a)) for a in per.Accuracy),
    Benchmark("disc iteration", disc_iterations),
    Benchmark("chain iteration", chain_iterations),
    Benchmark("memory", memory),
    Benchmark("start", start_up),
)
