"""A cantilever in plane stress: of many degrees of freedom, and well conditioned all the same."""

from __future__ import annotations

import numpy as np
import scipy

import symbolic as sym
from symbolic.arrays import Array

POISSON = 0.3

SLENDER = 24
"""Length over height."""


def plane_beam(rows: int) -> sym.Matrices:
    """Return a cantilever of square bilinear elements, `rows` over its height, 24 times as many along.

    Length, bending stiffness and mass per length are 1; the place ``tip`` is the transverse displacement at
    the middle of its free end (of an even number of rows).
    """
    along, height = SLENDER * rows, 1 / SLENDER
    thickness, modulus = 1 / height, 12 / height**2  # rho t H = 1, E t H^3 / 12 = 1
    stiffness, mass = _element(modulus * thickness, thickness * (1 / along) ** 2)
    node = np.arange((along + 1) * (rows + 1)).reshape(along + 1, rows + 1)
    corners = np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]], axis=2).reshape(-1, 4)
    freedoms = np.stack([2 * corners, 2 * corners + 1], axis=2).reshape(-1, 8)
    row, column = np.repeat(freedoms, 8, axis=1).ravel(), np.tile(freedoms, 8).ravel()

    def assembled(element: Array) -> scipy.sparse.csr_array:
        entries = np.tile(element.ravel(), len(freedoms))
        whole = scipy.sparse.csr_array((entries, (row, column)), shape=(2 * node.size, 2 * node.size))
        held = 2 * (rows + 1)  # the first column of nodes is clamped
        return whole[held:, held:]

    tip = 2 * int(node[-1, rows // 2]) + 1 - 2 * (rows + 1)
    return sym.Matrices(assembled(mass), None, assembled(stiffness), at={"tip": tip})


def _element(stiff: float, mass: float) -> tuple[Array, Array]:
    """Stiffness and consistent mass of a square element, u and v of its four corners in turn."""
    elastic = stiff / (1 - POISSON**2)
    law = elastic * np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]])
    corner = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    stiffness: Array = np.zeros((8, 8))
    weights: Array = np.zeros((4, 4))
    for place in corner / np.sqrt(3):  # Gauss
        shape = (1 + corner * place).prod(axis=1) / 4
        slope = corner * (1 + corner * place)[:, ::-1] / 4  # on the square from -1 to 1
        strain = np.zeros((3, 8))
        strain[0, ::2] = strain[2, 1::2] = slope[:, 0]
        strain[1, 1::2] = strain[2, ::2] = slope[:, 1]
        stiffness += strain.T @ law @ strain
        weights += np.outer(shape, shape) / 4
    both: Array = mass * np.kron(weights, np.eye(2)).astype(float)
    return stiffness, both
