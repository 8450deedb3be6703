"""How it is told that a system is the same as before, on another day, and what computes."""

from __future__ import annotations

from functools import cache
from importlib import metadata
from typing import Any

import numpy as np

from periodic.orbit.layout import layout_of
from periodic.results.described import described
from periodic.system import System


def identity(system: System) -> dict[str, Any]:
    """Return what tells a system from others, as plain data: its variables, and its residual at one point.

    Parameters
    ----------
    system : System
        The equations.

    Returns
    -------
    dict
        Equal for equal systems; other equations under the same names have another residual, to six digits.
    """
    return {"layout": described(layout_of(system)), "residual": _residual(system)}


def _residual(system: System) -> list[str]:
    n, m = len(system.states), len(getattr(system, "algebraics", ()))
    rate, state = 0.1 * np.cos(1.0 + np.arange(2.0 * n)).reshape(2, 1, n)
    algebraic, phase = 0.1 + 0.01 * np.arange(float(m))[None], np.array([0.7])
    parameter = np.array(system.nominal, dtype=float)
    found = system.linearise(rate, state, algebraic, phase, parameter).residual
    return [f"{value:.5e}" for value in found.ravel()]


def versions() -> dict[str, str]:
    """Return the versions of what computes, by name.

    Returns
    -------
    dict
        Of orbitrace, numpy and scipy.
    """
    return {name: _version(name) for name in ("orbitrace", "numpy", "scipy")}


@cache
def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "not installed"
