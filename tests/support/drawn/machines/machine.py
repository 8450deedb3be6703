"""A machine: its model as a user would write it, and its accelerations written out by hand beside it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import symbolic as sym

Array = NDArray[np.float64]
Random = np.random.Generator
Accelerations = Callable[[float, Array, Array, float], Array]
"""(tau, q, dq/dt, speed) to d2q/dt2, all in SI, (n, r) of r motions; tau is the phase, 2 pi a period."""

RPM = math.pi / 30
GRAVITY = 9.81


@dataclass(frozen=True)
class Machine:
    """A machine and the range through which it is traced.

    Parameters
    ----------
    model : Model
        Its parts.
    parameter : str
        What is traced.
    bounds : tuple of float
        Range, SI.
    told : str
        What it is, for whoever reads the row.
    accelerations : callable, optional
        Those of its coordinates in their order, for whoever judges; nothing of the packages is in them.
    pace : float
        d tau/dt over the parameter.
    """

    model: sym.Model
    parameter: str
    bounds: tuple[float, float]
    told: str
    accelerations: Accelerations | None = None
    pace: float = 1.0


def spread(draw: Random, least: float, most: float) -> float:
    """A number between two, evenly by its logarithm."""
    return float(math.exp(draw.uniform(math.log(least), math.log(most))))
