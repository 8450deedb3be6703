"""The same work by other tools, where they are installed: Duffing A from 0.3 to 3 rad/s with multipliers.

bifpy carries AUTO-07p and compiles the model for it (gfortran); the time of that is measured on a run of two
points and taken off.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Sequence
from functools import partial
from typing import Any

from reports.bench.clock import median
from reports.bench.suite import Benchmark, Numbers, fold_error


class MissingError(Exception):
    """A peer is not installed; the message says which."""


def auto(ntst: int) -> Numbers:
    """Trace Duffing A by AUTO-07p with the periodic force as an oscillator of its own (4 states)."""
    module = _imported("bifpy.auto", "bifpy")

    def run(points: int) -> Any:
        return module.run(
            _duffing,
            _start,
            _settings(module, ntst, points),
            icu=[1, 11],
            jac=module.AUTO_JACOBIAN,
            transpile=True,
        )

    points = run(1000).branches[0].points
    seconds = median(lambda: run(1000)) - median(lambda: run(2))
    folds = [p.parameters[0] for p in points if p.point_type.name == "FOLD"]
    return {
        "s": seconds,
        "points": float(len(points)),
        "per point ms": 1e3 * seconds / len(points),
        "fold error": fold_error(folds),
    }


def _duffing(u: Sequence[Any], p: Sequence[Any]) -> list[Any]:
    x, v, sine, cosine = u[0], u[1], u[2], u[3]
    omega, r = p[0], sine * sine + cosine * cosine
    return [
        v,
        0.5 * cosine - 0.1 * v - x - x**3,
        sine + omega * cosine - sine * r,
        cosine - omega * sine - cosine * r,
    ]


def _start(u: Any, p: Any, t: Any) -> None:
    omega, tau = 0.3, 2 * math.pi * t
    p[0], p[10] = omega, 2 * math.pi / omega
    u[0], u[1] = 0.46 * math.cos(tau), -0.46 * omega * math.sin(tau)
    u[2], u[3] = math.sin(tau), math.cos(tau)


def _settings(module: Any, ntst: int, points: int) -> dict[str, float]:
    """The usual settings of AUTO; tolerances 1e-8, steps up to 0.5, Jacobian given, multipliers and LP."""
    steps = {"ds": 0.02, "dsmin": 1e-4, "dsmax": 0.5, "nmx": points, "rl0": 0.29, "rl1": 3.0, "npr": 100000}
    accuracy = {"ntst": ntst, "ncol": 4, "iad": 3, "epsl": 1e-8, "epsu": 1e-8, "epss": 1e-6}
    newton = {"itmx": 9, "itnw": 5, "nwtn": 3, "jac": 1}
    found = {"ilp": 1, "isp": 2, "iads": 1, "a0": -1e300, "a1": 1e300}
    return {"ips": module.IPS_PERIODIC_ORBIT, "ndim": 4, "npar": 11} | steps | accuracy | newton | found


def _imported(module: str, package: str) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise MissingError(f"{package} is not installed (pip install 'orbitrace[peers]')") from error


PEERS = tuple(Benchmark(f"AUTO-07p, ntst {ntst}", partial(auto, ntst)) for ntst in (20, 50, 100))
