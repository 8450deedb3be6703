"""The distance from a centre, with which directions are made that fade at the centre itself."""

from __future__ import annotations

import casadi as ca

CENTRE = 1e-12
"""Distance, in a given unit, within which a direction fades."""


def radius(x: ca.SX, y: ca.SX, unit: ca.SX) -> ca.SX:
    """Return sqrt(x^2 + y^2 + (CENTRE unit)^2), by which x and y may be divided."""
    return ca.sqrt(x**2 + y**2 + (CENTRE * unit) ** 2)
