"""A number of an orbit, linearised: side conditions, functionals and constraints all come as such rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.orbit.scheme import Array


@dataclass(frozen=True)
class Row:
    """Value and gradient of a number c of an orbit: c + <nodes, dx> + <stages, dX> + <outer, dy>.

    Parameters
    ----------
    value : float
        c itself.
    nodes : ndarray, shape (N+1, n)
        Gradient in the states at the mesh points.
    outer : ndarray, shape (q,)
        Gradient in y: the phases of the event nodes, then the free parameters.
    stages : ndarray, shape (N, ncol, n), optional
        Gradient in the states at the collocation points, where c depends on them.
    """

    value: float
    nodes: Array
    outer: Array
    stages: Array | None = None

    def scaled(self, factor: float) -> Row:
        """Return value and gradient times a factor.

        Parameters
        ----------
        factor : float
            The factor.

        Returns
        -------
        Row
            The multiple.
        """
        stages = None if self.stages is None else factor * self.stages
        return Row(factor * self.value, factor * self.nodes, factor * self.outer, stages)

    def __add__(self, other: Row) -> Row:
        both = [row.stages for row in (self, other) if row.stages is not None]
        stages = np.sum(both, axis=0) if both else None
        return Row(self.value + other.value, self.nodes + other.nodes, self.outer + other.outer, stages)
