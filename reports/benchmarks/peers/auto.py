"""AUTO-07p through bifpy, its right-hand side transpiled (gfortran) or called back in Python.

The periodic force is an oscillator of its own (4 states). What bifpy does once, above all to compile, is
measured on a run of two points and taken off.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from typing import Any

from bifpy import auto

from reports.benchmarks.peers.answers import REPEATS, median, tell


def duffing(u: Sequence[Any], p: Sequence[Any]) -> list[Any]:
    """Return the rates of x, x', sin and cos."""
    x, v, sine, cosine = u[0], u[1], u[2], u[3]
    omega, r = p[0], sine * sine + cosine * cosine
    return [
        v,
        0.5 * cosine - 0.1 * v - x - x**3,
        sine + omega * cosine - sine * r,
        cosine - omega * sine - cosine * r,
    ]


def start(u: Any, p: Any, t: Any) -> None:
    """Set the linear response at the first frequency."""
    omega, tau = 0.3, 2 * math.pi * t
    p[0], p[10] = omega, 2 * math.pi / omega
    u[0], u[1] = 0.46 * math.cos(tau), -0.46 * omega * math.sin(tau)
    u[2], u[3] = math.sin(tau), math.cos(tau)


def settings(ntst: int, points: int) -> dict[str, float]:
    """AUTO's usual ones; tolerances 1e-8, steps up to 0.5, multipliers and folds."""
    steps = {"ds": 0.02, "dsmin": 1e-4, "dsmax": 0.5, "nmx": points, "rl0": 0.29, "rl1": 3.0, "npr": 100000}
    accuracy = {"ntst": ntst, "ncol": 4, "iad": 3, "epsl": 1e-8, "epsu": 1e-8, "epss": 1e-6}
    newton = {"itmx": 9, "itnw": 5, "nwtn": 3, "jac": 1}
    found = {"ilp": 1, "isp": 2, "iads": 1, "a0": -1e300, "a1": 1e300}
    return {"ips": auto.IPS_PERIODIC_ORBIT, "ndim": 4, "npar": 11} | steps | accuracy | newton | found


def run(ntst: int, points: int, *, transpile: bool) -> Any:
    """Trace so many points at the most, or the branch."""
    return auto.run(
        duffing,
        start,
        settings(ntst, points) | {"jac": int(transpile)},
        icu=[1, 11],
        jac=auto.AUTO_JACOBIAN if transpile else None,
        transpile=transpile,
    )


def main(ntst: int, most: int, *, transpile: bool) -> None:
    """Measure the branch, or so many points of it."""
    points = run(ntst, most, transpile=transpile).branches[0].points
    repeats = REPEATS if transpile else 1
    once = median(lambda: run(ntst, 2, transpile=transpile), repeats)
    seconds = median(lambda: run(ntst, most, transpile=transpile), repeats) - once
    tell(seconds, len(points), [p.parameters[0] for p in points if p.point_type.name == "FOLD"])


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), transpile=sys.argv[3] == "transpiled")
