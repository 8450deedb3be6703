"""pyHarm-os: harmonic balance in NumPy and Numba. It gives no multipliers; folds are between its points."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from pyHarm.Maestro import Maestro

from reports.benchmarks.peers.told import folds, median, tell

STEPS = {"ds0": 0.02, "ds_min": 1e-8, "ds_max": 0.1, "sign_ds": 1}
NEWTON = {"solver": "NewtonRaphson", "solver_options": {"max_iter": 20}}
PATH = {"study": "frf", "predictor": "tangent", "corrector": "arc_length", "puls_inf": 0.3, "puls_sup": 3.0}


def duffing(harmonics: int) -> dict[str, Any]:
    """Return Duffing A as its input."""
    one = np.eye(1)
    matrices = {"M": one, "C": 0.1 * one, "K": one, "G": 0 * one}
    at = {"connect": {"mass": [0]}, "dirs": [0]}
    return {
        "analysis": {"branch": PATH | STEPS | NEWTON | {"verbose": False}},
        "system": {"type": "Base", "nh": harmonics, "nti": 128, "adim": {"status": False}},
        "substructures": {"mass": {"matrix": matrices, "ndofs": 1, "nmodes": 0}},
        "connectors": {
            "spring": {"type": "CubicSpring", "k": 1.0} | at,
            "force": {"type": "CosinusForcing", "amp": 0.5} | at,
        },
    }


def run(harmonics: int) -> list[np.ndarray]:
    """Return the points of the branch: coefficients and frequency."""
    study = Maestro(duffing(harmonics))
    study.operate()
    return [point.x for point in study.nls["branch"].SolList if point.flag_accepted]


def main(harmonics: int) -> None:
    """Measure the branch, once compiled."""
    points = run(harmonics)
    tell(median(lambda: run(harmonics)), len(points), folds(points))


if __name__ == "__main__":
    main(int(sys.argv[1]))
