"""The orbits of a branch at a value of its parameter, of a branch from a file too."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from periodic.checks import shown
from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.correction.tolerance import Accuracy, Tolerance
from periodic.results.atvalue import points_at_value
from periodic.results.branch import Branch
from periodic.results.point import Point
from periodic.system import System
from periodic.tracing.trace import trace
from periodic.tracing.watch import Watch


def points_at(
    system: System,
    branch: Branch,
    value: float,
    *,
    tol: float | Tolerance = Accuracy.STANDARD,
    determined: Mapping[str, Condition] | None = None,
    method: Discretisation | None = None,
) -> tuple[Point, ...]:
    """Return the points of a branch at a value of its parameter, one for each time that it passes it.

    For a branch from a file; one that was traced just now has them itself, as `branch.at(Omega=2.0)`. Between
    two points of the branch it is traced anew from the nearer one to the value.

    Parameters
    ----------
    system : System
        The equations of the branch.
    branch : Branch
        A branch, as from `trace`.
    value : float
        The parameter (SI).
    tol, determined, method
        As in `trace`, and as the branch was traced.

    Returns
    -------
    tuple of Point
        In order along the branch; solved at the value itself, to the tolerance.

    Raises
    ------
    ValueError
        For a value that the branch does not pass.
    ArithmeticError
        Where the value is not reached from the points beside it, as where tol or method is another one.
    """
    if not isinstance(branch, Branch):
        raise ValueError(f"branch is {shown(branch)}; it must be a Branch")
    plain = Watch(peaks={})
    onwards = partial(
        trace, system, branch.parameter, tol=tol, determined=determined, method=method, watch=plain
    )
    return points_at_value(branch, onwards, value)
