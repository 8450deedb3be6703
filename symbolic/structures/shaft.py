"""Rotor shafts by finite elements: round Euler-Bernoulli elements with rotary inertia, and rigid discs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from symbolic.arrays import Array
from symbolic.checks import finite, positive, refusal, typed, whole
from symbolic.structures.beam import bending_element, chained
from symbolic.structures.matrices import Matrices, Matrix, sparse


@dataclass(frozen=True)
class ShaftDisc:
    """A thin rigid disc on a shaft.

    Parameters
    ----------
    node : int
        Node of the shaft, counted from 0.
    mass : float
        Mass in kg.
    polar, diametral : float
        Moments of inertia about the shaft and about a diameter, kg m^2.

    Raises
    ------
    ValueError
        For a node that is no whole number, and numbers that are not positive.
    """

    node: int
    mass: float
    polar: float
    diametral: float

    def __post_init__(self) -> None:
        whole("node of a disc", self.node, 0)
        for name in ("mass", "polar", "diametral"):
            positive(f"{name} of a disc", getattr(self, name))


def shaft(
    *,
    length: float,
    diameter: float,
    elements: int = 10,
    bore: float = 0.0,
    modulus: float = 2.1e11,
    density: float = 7850.0,
    discs: Sequence[ShaftDisc] = (),
) -> Matrices:
    """Return a free rotor shaft of round cross-section, undamped: bearings are attached as parts.

    Each node has the deflections x, y and the slopes x_z, y_z. With rotary inertia and gyroscopic moments of
    shaft and discs (Nelson & McVaugh 1976 without shear): of a disc,

        I_d x_z'' + Omega I_p y_z' = 0,   I_d y_z'' - Omega I_p x_z' = 0.

    Parameters
    ----------
    length, diameter : float
        Length and outer diameter in m.
    elements : int
        Number of elements.
    bore : float
        Inner diameter in m.
    modulus, density : float
        Young's modulus (Pa) and density (kg/m^3).
    discs : sequence of ShaftDisc
        Rigid discs on it.

    Returns
    -------
    Matrices
        M, C = 0, K and G, with the places ``x0``, ``y0``, ``slope_x0``, ``slope_y0``, ``x1``, ...

    Raises
    ------
    ValueError
        For numbers out of range, and a disc beyond the shaft.

    References
    ----------
    .. [1] H. D. Nelson, J. M. McVaugh, J. Eng. Ind. 98 (1976) 593-600.
    """
    nodes = whole("elements", elements, 1) + 1
    outer, inner = positive("diameter", diameter), finite("bore", bore)
    if not 0 <= inner < outer:
        raise refusal("bore", bore, f"at least 0 and less than the diameter, {diameter:g}")
    second = math.pi * (outer**4 - inner**4) / 64
    area = math.pi * (outer**2 - inner**2) / 4
    h = positive("length", length) / elements
    stiffness, mass = bending_element(h, positive("modulus", modulus) * second)
    rotary = positive("density", density) * second * slope_element(h)
    of_discs, polar_of_discs = np.zeros(2 * nodes), np.zeros(2 * nodes)
    for disc in discs:
        node = typed("a disc", disc, ShaftDisc, "a ShaftDisc").node
        if node >= nodes:
            raise refusal("node of a disc", node, f"a whole number from 0 to {nodes - 1}")
        of_discs[2 * node : 2 * node + 2] += disc.mass, disc.diametral
        polar_of_discs[2 * node + 1] += disc.polar
    names = [f"{kind}{node}" for node in range(nodes) for kind in ("x", "y", "slope_x", "slope_y")]
    return Matrices(
        _planes(chained(density * area * mass + rotary, elements, 2, of_discs)),
        None,
        _planes(chained(stiffness, elements, 2)),
        _planes(chained(2 * rotary, elements, 2, polar_of_discs), np.array([[0.0, 1.0], [-1.0, 0.0]])),
        at={name: k for k, name in enumerate(names)},
    )


def slope_element(length: float) -> Array:
    """Return the integral of N_z' N_z over a beam element, N its cubic shape functions."""
    h = length
    return np.array(
        [
            [36, 3 * h, -36, 3 * h],
            [3 * h, 4 * h**2, -3 * h, -(h**2)],
            [-36, -3 * h, 36, -3 * h],
            [3 * h, -(h**2), -3 * h, 4 * h**2],
        ]
    ) / (30 * h)


def _planes(plane: Matrix, coupling: Array | None = None) -> Matrix:
    """Both planes from the matrix of one: order (w, slope) of a node to (x, y, slope_x, slope_y)."""
    pair = np.eye(2) if coupling is None else coupling
    return sparse.csr_array(sparse.kron(plane, pair)) if sparse.issparse(plane) else np.kron(plane, pair)
