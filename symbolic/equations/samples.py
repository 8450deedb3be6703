"""Functions of state, phase and parameters at sample points: their size, and whether two are multiples."""

from __future__ import annotations

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.equations.excitation import ROUNDED_RATIO
from symbolic.equations.packed import Packed

PARAMETER_SETS = 3
"""Sets of parameters on which two functions are compared, the nominal one first."""

SAMPLE_POINTS = 24
"""Number of points at which they are compared, for each set."""


class Samples:
    """Points at which functions of state, phase and parameters are compared, drawn about the rest.

    Parameters
    ----------
    packed : Packed
        The variables of a model, whose omega is a parameter or has been replaced.
    """

    def __init__(self, packed: Packed) -> None:
        self.packed, assembly = packed, packed.assembly
        draw = np.random.default_rng(1)
        nominal = np.array([p.value for p in assembly.parameters.values()])
        rest = packed.scaled([s.rest / s.scale for s in assembly.states])
        start = np.array(ca.Function("rest", [packed.parameter], [rest])(nominal)).reshape(-1, 1)
        self.points = []
        for k in range(PARAMETER_SETS):
            change = draw.uniform(0.02, 0.1, nominal.size) if k else np.zeros(nominal.size)
            parameter = np.where(nominal == 0, change, nominal * (1 + change))
            spread = 10 ** draw.uniform(-1, 1, SAMPLE_POINTS) * draw.normal(size=(len(start), SAMPLE_POINTS))
            self.points.append((start + spread, draw.uniform(0, 2 * np.pi, (1, SAMPLE_POINTS)), parameter))

    def _evaluated(self, column: ca.SX) -> list[Array]:
        """Values at the points for each set of parameters, shape (rows, POINTS)."""
        packed = self.packed
        function = ca.Function("sampled", [packed.state, packed.phase, packed.parameter], [column])
        return [np.array(function(*point)) for point in self.points]

    def values(self, expressions: list[ca.SX]) -> list[list[Array]]:
        """Values of each function in the assembly's symbols, a row for each set of parameters."""
        return self.rows(self.packed.scaled(expressions))

    def rows(self, column: ca.SX) -> list[list[Array]]:
        """Values of each row of a column in the vectors, a row for each set of parameters."""
        return [list(rows) for rows in zip(*self._evaluated(column), strict=True)]

    def size(self, expression: ca.SX) -> float:
        """Order of magnitude of a function, by its gradient in the phase and the scaled states."""
        packed = self.packed
        moving = ca.vertcat(packed.state, packed.phase)
        columns = self._evaluated(ca.jacobian(packed.scaled([expression]), moving).T)[0]
        with np.errstate(over="ignore"):
            steepness = np.linalg.norm(columns, axis=0)
        usable = steepness[np.isfinite(steepness) & (steepness > 0)]
        return float(np.median(usable)) if usable.size else 1.0


def constant(values: list[Array]) -> bool:
    """Whether a function does not vary with state and phase, for any parameters."""
    finite = [v[np.isfinite(v)] for v in values]
    with np.errstate(over="ignore"):
        return all(v.size and np.ptp(v) <= ROUNDED_RATIO * np.abs(v).max() for v in finite)


def multiples(values: list[Array], others: list[Array]) -> bool:
    """Whether two functions differ by a factor that depends on parameters alone."""
    for a, b in zip(values, others, strict=True):
        both = np.isfinite(a) & np.isfinite(b)
        a, b = a[both], b[both]
        if not a.size or not a.any() or not b.any():
            return False
        a, b = a / np.abs(a).max(), b / np.abs(b).max()
        if np.abs(a - (a @ b) / (b @ b) * b).max() > ROUNDED_RATIO:
            return False
    return True
