"""How stiffly the parts of a model hold coordinates, at rest and at the parameters' nominal values."""

from __future__ import annotations

from collections.abc import Sequence

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.equations.assembly import Assembly
from symbolic.equations.terms import Motion


def stiffness(assembly: Assembly, motions: Sequence[Motion]) -> Array:
    """Return the stiffness of what parts do to k coordinates.

    Parameters
    ----------
    assembly : Assembly
        What the parts have contributed.
    motions : sequence of Motion
        The coordinates.

    Returns
    -------
    ndarray, shape (k,)
        Largest derivative of the force on each in any of them, N/m; 0 where it is not finite.
    """
    positions = ca.vertcat(*[motion.position.symbol for motion in motions])
    slopes = ca.jacobian(ca.vertcat(*[motion.force for motion in motions]), positions)
    rest = [(s.symbol, s.rest) for s in assembly.states] + [(u.symbol, u.rest) for u in assembly.unknowns]
    symbols, values = (ca.vertcat(*column) for column in zip(*rest, strict=True))
    slopes = assembly.with_frequency(ca.substitute(slopes, symbols, values))
    numbers = {item.symbol.name(): item.value for item in (n.parameter for n in assembly.numbers.taken)}
    free = ca.symvar(slopes)  # what is no parameter is of the excitation, or a rate
    at = [numbers.get(symbol.name(), 0.0) for symbol in free]
    found = ca.Function("stiffness", [ca.vertcat(ca.SX(0, 1), *free)], [slopes])(at)
    sizes = np.abs(np.array(found))
    return np.where(np.isfinite(sizes), sizes, 0.0).max(axis=1, initial=0.0)
