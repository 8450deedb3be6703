"""The families of methods by name: a curve of a diagram, a row of a table; tolerances in words."""

from __future__ import annotations

import re
from enum import Enum

import periodic as per

SCHEMES = tuple(per.Scheme(family, ncol) for family in per.Family for ncol in range(2, 8))


class Mesh(Enum):
    """The meshes of collocation: equal intervals, chosen by the error estimate, and tied to events too."""

    EVEN = "even"
    ADAPTIVE = "adaptive"
    ANCHORED = "anchored"


def named(scheme: per.Scheme, mesh: Mesh) -> str:
    """Return the name of collocation with a scheme on a kind of mesh."""
    return f"{'Radau' if scheme.family is per.Family.RADAU else 'Gauss'} {scheme.ncol}, {mesh.value}"


def power(value: float) -> str:
    """Return a small number by its first digit, as in 3e-9."""
    return re.sub(r"e-0", "e-", f"{value:.0e}")


RK4, CVODES, SHOOTING = "RK4 to steady state", "CVODES to steady state", "shooting"
DIAL, BALANCE = "`--accuracy`", "harmonic balance"
RADAU_5, GAUSS_5 = (per.Scheme(family, 5) for family in per.Family)
EVEN, UNTIED, ANCHORED = (named(RADAU_5, mesh) for mesh in Mesh)
SWEEP = "sweep by CVODES"
INTEGRATIONS = (RK4, CVODES)
SHOWN = (EVEN, UNTIED, ANCHORED, named(GAUSS_5, Mesh.EVEN))
"""Collocation as it is drawn beside the other methods."""

MESHES = {(scheme, mesh): named(scheme, mesh) for scheme in SCHEMES for mesh in Mesh}
"""Collocation by scheme and mesh."""
