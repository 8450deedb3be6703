"""The tangents of the two branches of equilibria that cross at a branch point.

There R_u, u = (x, z, p), has a kernel of two dimensions, spanned by n1, n2, and one left null vector psi. The
tangents t = a n1 + b n2 fulfil the algebraic bifurcation equation psi R_uu t t = 0 (Keller 1977).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from periodic.equilibrium.linearise import crossing, direction, rows_at
from periodic.linear.unknowns import Increment
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.system.precision import difference_step

SHIFT = difference_step(order=2)
"""Length of the differences that give the second derivatives."""


def tangents(system: System, orbit: Orbit, index: int) -> list[Increment]:
    """Return the directions of the branches in a parameter through an equilibrium, the steepest first.

    Steepest: in which the parameter changes least. Empty where no two branches cross.
    """
    scale = _scale(system, orbit, index)
    matrix = rows_at(system, orbit, (index,)).balanced(scale)
    if not crossing(matrix):
        return []
    left, _, right = np.linalg.svd(matrix)
    kernel, psi = right[-2:], left[:, -1]
    form = np.array([[_second(system, orbit, index, scale, psi, a, b) for b in kernel] for a in kernel])
    found = [_unit(weights @ kernel, scale) for weights in _roots((form + form.T) / 2)]
    found.sort(key=lambda vector: abs(vector[-1]))
    return [direction(orbit, vector) for vector in found]


def _scale(system: System, orbit: Orbit, index: int) -> float:
    """A change of the parameter that acts on the equations as one of order one of the states does."""
    rows = np.abs(rows_at(system, orbit, (index,)).d_unknown)
    states, parameter = float(rows[:, :-1].max()), float(rows[:, -1].max())
    return states / parameter if parameter > SHIFT * states else abs(float(orbit.parameter[index])) or 1.0


def _second(system: System, orbit: Orbit, index: int, scale: float, psi: Array, a: Array, b: Array) -> float:
    """psi R_uu a b by central differences along a."""
    orbits = [_moved(orbit, index, scale, h * a) for h in (-SHIFT, SHIFT)]
    ends = [rows_at(system, moved, (index,)).balanced(scale) for moved in orbits]
    return float(psi @ (ends[1] - ends[0]) @ b) / (2 * SHIFT)


def _moved(orbit: Orbit, index: int, scale: float, change: Array) -> Orbit:
    n = orbit.nodes.shape[1]
    parameter = orbit.parameter.copy()
    parameter[index] += scale * change[-1]
    return replace(
        orbit, nodes=orbit.nodes + change[:n], algebraic=orbit.algebraic + change[n:-1], parameter=parameter
    )


def _roots(form: Array) -> list[Array]:
    """The directions w of the plane with w form w = 0: two, or none."""
    values, vectors = np.linalg.eigh(form)
    if not values[0] < 0 < values[1]:
        return []
    ratio = np.sqrt(-values[0] / values[1])
    return [vectors[:, 0] + sign * ratio * vectors[:, 1] for sign in (-1, 1)]


def _unit(vector: Array, scale: float) -> Array:
    """The vector with its parameter in SI units, and its largest component positive and of order one."""
    largest = vector[np.abs(vector).argmax()]
    return np.append(vector[:-1], scale * vector[-1]) / largest
