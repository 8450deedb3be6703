"""The boundary to linear algebra: equations linearised, factored once, solved for several borders."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from periodic.linear.unknowns import Increment
from periodic.orbit.jump import Jump
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import LinearisationLike, System


class Operator(Protocol):
    """The linearised equations J u + r = 0 of an orbit, u its increment and that of q free numbers.

    Side conditions close them: with rows c_i + C_i u, i = 1..q, `solve` finds

        J u = -s r,   C_i u = b_i - s c_i

    for each column (s, b_1, ..., b_q) of its right-hand side: (1, 0, ...) is Newton's step, (0, ..., 0, 1)
    the tangent of the branch when the last row is the arclength constraint.
    """

    @property
    def orbit(self) -> Orbit:
        """The orbit that the equations are linearised at."""

    @property
    def residual(self) -> float:
        """The largest residual."""

    @property
    def fundamental(self) -> Array:
        """Fundamental matrices at the mesh points, shape (N+1, n, n)."""

    @property
    def effect(self) -> Array:
        """About how much the states change with each free parameter over a period, shape (q,)."""

    def solve(self, rows: Sequence[Row], right: Array) -> tuple[Increment, ...]:
        """Solve the bordered system for several right-hand sides.

        Parameters
        ----------
        rows : sequence of Row
            The side conditions, linearised: (c_i, C_i).
        right : ndarray, shape (1 + len(rows), columns)
            The columns (s, b_1, ..., b_q).

        Returns
        -------
        tuple of Increment
            One for each column.

        Raises
        ------
        numpy.linalg.LinAlgError
            Where the bordered matrix is singular.
        """


LinearSolver = Callable[[System, Orbit, LinearisationLike, Sequence[Row], Sequence[Jump]], Operator]
"""Factors the collocation equations of an orbit, given at its collocation points, the rows of its event
nodes, and the jumps of its state there."""
