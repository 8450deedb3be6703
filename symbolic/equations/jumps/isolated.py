"""Whether a motion that slides along a jump all the time is determined by the equations.

Where friction holds a mass its place drops out of the equations: it rests anywhere. Sliding along
s = v + lambda x is another matter: x' = -lambda x leads to one motion.
"""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca
import numpy as np

from symbolic.equations.packed import Packed
from symbolic.equations.samples import Samples
from symbolic.equations.surfaces import HELD

NEUTRAL = 1e-9
"""A direction along which the equations change by less than this part of their largest change is neutral."""


def isolated(packed: Packed, rows: ca.SX, sides: Mapping[int, ca.SX], switch: int) -> bool:
    """Return whether no direction in the states leaves the equations as they are where a jump is HELD.

    Parameters
    ----------
    packed : Packed
        The variables.
    rows : casadi.SX
        The rows that tell the rates, on sides of their jumps.
    sides : mapping of int to casadi.SX
        The side of each switch.
    switch : int
        The jump; of others the state decides.

    Returns
    -------
    bool
        Whether there is none.
    """
    others = ca.vertcat(ca.SX(0, 1), *[s for k, s in sides.items() if k != switch and s.is_symbolic()])
    still = ca.vertcat(packed.rate, packed.unknown, others)
    held = ca.substitute(rows, still, ca.SX.zeros(still.numel()))
    slope = ca.densify(ca.jacobian(ca.substitute(held, sides[switch], ca.SX(HELD)), packed.state))
    values = np.array(Samples(packed).rows(ca.vec(slope.T))[0 : slope.numel()])
    found = values.reshape(slope.size1(), slope.size2(), -1)
    finite = np.isfinite(found).all(axis=(0, 1))
    each = np.moveaxis(found[:, :, finite], 1, 2).reshape(-1, slope.size2())
    size = np.abs(each).max(axis=1, initial=0.0)
    each = each[size > 0] / size[size > 0, None]
    sizes = np.linalg.svd(each, compute_uv=False)
    return len(sizes) == slope.size2() and bool(sizes[-1] > NEUTRAL * sizes[0])
