"""Rows that are combinations of few forces, with constant coefficients."""

from __future__ import annotations

import casadi as ca
import numpy as np

from symbolic.system.combinations import combined

Q, V, PHASE, STIFFNESS = ca.SX.sym("q"), ca.SX.sym("v"), ca.SX.sym("phase"), ca.SX.sym("k")
MOVING = ca.vertcat(Q, V)


def rows(*forces: ca.SX, matrix: list[list[float]]) -> ca.SX:
    """Rows as a matrix that was multiplied out."""
    return ca.vertcat(*[sum(m * f for m, f in zip(line, forces, strict=True)) for line in matrix])


def test_contact_and_drive_are_told_apart() -> None:
    """Assert that of four rows one force depends on the motion and one does not, and what they make."""
    contact, drive = STIFFNESS * ca.fmax(Q - 0.02, 0) + V**3, 0.3 * ca.cos(PHASE)
    column = rows(contact, drive, matrix=[[2.0, 1.0], [0.0, 3.0], [-4.0, 0.5], [6.0, 0.0]])
    found = combined([column], MOVING)
    assert found is not None and (found.moved, found.matrix.shape) == (1, (4, 2))
    assert not ca.depends_on(found.forces[0][1], MOVING)
    both = ca.Function("both", [Q, V, PHASE, STIFFNESS], [found.forces[0], column])
    for given in ((0.5, 0.2, 1.0, 7.0), (-0.5, 1.2, 2.0, 3.0)):
        forces, made = (np.array(value).ravel() for value in both(*given))
        assert np.allclose(found.matrix @ forces, made, rtol=1e-14, atol=0)


def test_what_varies_is_no_coefficient() -> None:
    """Assert that rows in parts of each other that parameters decide, or another law, are left alone."""
    one = ca.fmax(Q, 0)
    assert combined([ca.vertcat(one, STIFFNESS * one)], MOVING) is None
    assert combined([ca.vertcat(one, ca.fmax(Q + 1e-9, 0))], MOVING) is None
    assert combined([ca.vertcat(one, 2 * one), ca.vertcat(V, 3 * V)], MOVING) is None


def test_rounding_makes_no_force() -> None:
    """Assert that a linear term that falls out of the rows but for rounding is none of them."""
    contact = ca.fmax(Q, 0)
    left = 0.1 * Q + 0.2 * Q - 0.3 * Q
    found = combined([ca.vertcat(contact + left, -3 * contact, contact / 7 + 2 * left)], MOVING)
    assert found is not None and found.matrix.shape == (3, 1)
