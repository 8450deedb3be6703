"""Linearised motions about an orbit that are multiplied by a number over the period, as at special points.

An orbit has the Floquet multiplier mu where its linearised equations, closed by v(T) = mu v(0), are singular,

    K_mu (u, v_y) = 0,

where u determines the motion v (its start, or forces and own states of a system that is split), and v_y is
the change of the parameters.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array

Complex = NDArray[np.complex128]


class UnknownVariationsError(ValueError):
    """The linearised motions about an orbit are not known, so that methods that need them cannot be used."""


@dataclass(frozen=True)
class Tangent:
    """A solution of the linearised equations: mesh points (N+1, n), stages (N, ncol, n), unknowns
    (N, ncol, m), and the parameters' part (p,)."""

    nodes: Array
    stages: Array
    algebraic: Array
    parameter: Array

    def moved(self, orbit: Orbit, step: float) -> Orbit:
        """Return the orbit a step along the tangent."""
        return replace(
            orbit,
            nodes=orbit.nodes + step * self.nodes,
            stages=orbit.stages + step * self.stages,
            algebraic=orbit.algebraic + step * self.algebraic,
            parameter=orbit.parameter + step * self.parameter,
        )


class Repeating(Protocol):
    """The linearised equations closed by v(T) = mu v(0), with v_y of the free parameters."""

    @property
    def matrix(self) -> Array:
        """K_mu, as many rows as u has numbers; columns of u, then of v_y."""

    def functional(self, row: Row) -> Array:
        """Return a row as a functional of (u, v_y)."""

    def tangent(self, unknown: Array) -> Tangent:
        """Return the motion of (u, v_y)."""

    def gradient(self, unknown: Array, left: Array, source: Row | None, free: tuple[int, ...]) -> Row:
        """Return the gradient of left . K_mu (u, v_y) + source . v at fixed (u, v_y), left and source.

        In the orbit's unknowns and the parameters `free`; the value is the contribution of algebraic rows
        that are not met yet.
        """


class Variations(Protocol):
    """All linearised motions about an orbit: solutions of the variational equations."""

    def repeating(self, multiplier: float) -> Repeating:
        """Return the equations of the motions that are multiplied by a number."""

    @property
    def multipliers(self) -> Complex:
        """The multipliers that are known, in no order."""

    def outside(self, radius: float) -> int:
        """Return how many multipliers have a modulus larger than `radius`, those not known included.

        Raises FloatingPointError where it cannot be told.
        """

    def multiplier(self, which: int, factor: complex, free: tuple[int, ...]) -> Row:
        """Return the gradient of Re(factor mu) of a simple multiplier, by its index in `multipliers`."""

    def pair(self, near: Array | None, free: tuple[int, ...]) -> tuple[Row, Array]:
        """Return the product of a pair of multipliers less 1, and data that identify the pair nearby.

        It is the pair whose product is nearest to 1, or the one that `near`, such data, identifies.
        """
