"""pyHarm-os: harmonic balance in NumPy and Numba. It gives no multipliers; folds are between its points."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from pyHarm.Maestro import Maestro

from reports.benchmarks.peers.answers import TIMING_SECONDS, folds, median, spent, tell

STEPS = {"ds0": 0.02, "ds_min": 1e-8, "ds_max": 0.1, "sign_ds": 1}
NEWTON = {"solver": "NewtonRaphson", "solver_options": {"max_iter": 20}}
PATH = {"study": "frf", "predictor": "tangent", "corrector": "arc_length", "puls_inf": 0.3, "puls_sup": 3.0}


Input = dict[str, Any]


def study(path: Input, harmonics: int, matrices: dict[str, np.ndarray], connectors: Input) -> Input:
    """Return the input of a frequency response of a structure and of what is attached to it."""
    body = matrices | {"G": np.zeros_like(matrices["M"])}
    return {
        "analysis": {"branch": path | STEPS | NEWTON | {"verbose": False}},
        "system": {"type": "Base", "nh": harmonics, "nti": 128, "adim": {"status": False}},
        "substructures": {"body": {"matrix": body, "ndofs": 1, "nmodes": 0}},
        "connectors": connectors,
    }


def duffing(harmonics: int) -> Input:
    """Return Duffing A as its input."""
    one = np.eye(1)
    return study(PATH, harmonics, {"M": one, "C": 0.1 * one, "K": one}, attached(0, 1.0, 0.5))


def beam(harmonics: int, file: str) -> Input:
    """Return a structure that a file of NumPy holds: M, C, K; its tip, with a cubic spring and a force."""
    given = np.load(file)
    begin, end = (float(value) for value in given["range"])
    path = PATH | {"puls_inf": begin, "puls_sup": end}
    tip = attached(int(given["tip"]), float(given["cubic"]), float(given["force"]))
    return study(path, harmonics, {name: given[name] for name in "MCK"}, tip)


def attached(place: int, cubic: float, force: float) -> Input:
    """Return a cubic spring and a harmonic force at a degree of freedom."""
    at = {"connect": {"body": [place]}, "dirs": [0]}
    return {
        "spring": {"type": "CubicSpring", "k": cubic} | at,
        "force": {"type": "CosinusForcing", "amp": force} | at,
    }


def run(given: Input) -> list[np.ndarray]:
    """Return the points of the branch: coefficients and frequency."""
    maestro = Maestro(given)
    maestro.operate()
    return [point.x for point in maestro.nls["branch"].SolList if point.flag_accepted]


def main(harmonics: int, file: str | None = None) -> None:
    """Measure the branch, once compiled."""
    run(duffing(harmonics))
    given = duffing(harmonics) if file is None else beam(harmonics, file)
    begun = spent()
    points = run(given)
    took = spent() - begun
    tell(took if took > TIMING_SECONDS else median(lambda: run(given)), len(points), folds(points))


if __name__ == "__main__":
    main(int(sys.argv[1]), *sys.argv[2:3])
