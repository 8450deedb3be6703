"""Linearised motions about an orbit, and its linearised equations, as they suit a system: whole or split."""

from __future__ import annotations

from collections.abc import Sequence

from periodic.condensed.condensedcollocation import mesh_method
from periodic.conditions.adjoint import Linear, polynomial
from periodic.linear.operator import Operator
from periodic.linear.variation import Variations
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System


def variations(system: System, orbit: Orbit, free: tuple[int, ...]) -> Variations:
    """Return the linearised motions about an orbit.

    Parameters
    ----------
    system : System
        The equations; gradients ask for their second derivatives.
    orbit : Orbit
        A piecewise polynomial.
    free : tuple of int
        Parameters that the motions may change.

    Returns
    -------
    Variations
        The motions.

    Raises
    ------
    ValueError
        For a Fourier series; for gradients of a system without second derivatives.
    """
    polynomial(orbit)
    own = mesh_method(system).variations(system, orbit, free)
    return Linear.about(system, orbit, free) if own is None else own


def equations(system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
    """Return the equations of a piecewise polynomial, linearised.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        The orbit.
    free : tuple of int
        Indices of the free parameters.

    Returns
    -------
    Operator
        The linearised equations.
    """
    return mesh_method(system).linearise(system, orbit, free)


def weighted(rows: Sequence[Row], weights: Array) -> Row | None:
    """Return the sum of rows times weights; None of none."""
    total: Row | None = None
    for weight, row in zip(weights, rows, strict=True):
        scaled = row.scaled(float(weight))
        total = scaled if total is None else total + scaled
    return total
