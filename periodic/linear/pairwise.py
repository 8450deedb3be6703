"""Stable elimination: the chain of intervals reduced in pairs by orthogonal transformations.

Products of the intervals' maps lose all digits where motions grow by many orders of magnitude over a period.
Here neighbouring intervals are joined instead: of

    S_j x_j + R_j x_{j+1} + G_j (1, y) = 0,    S_j+1 x_{j+1} + R_j+1 x_{j+2} + G_j+1 (1, y) = 0

a QR factorisation of (R_j; S_j+1) gives x_{j+1} from its neighbours and one equation between these, until
the first and the last mesh point are left. Every mesh point then follows from both ends, not from the first.

References
----------
Wright, SIAM J. Sci. Stat. Comput. 13 (1992) 742 (structured orthogonal factorisation).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.orbit.scheme import Array


@dataclass(frozen=True)
class Reduced:
    """A reduced chain: ends (n, 1+2n+q) with ends (1, dx_0, dx_N, dy) = 0, all mesh points from both ends.

    maps: affine maps (1, dx_0, dx_N, dy) -> dx_j, shape (N+1, n, 1+2n+q).
    """

    ends: Array
    maps: Array


def reduce(step: Array) -> Reduced:
    """Reduce a chain dx_{j+1} = step[j] (1, dx_j, dy), step (N, n, 1+n+q).

    Raises numpy.linalg.LinAlgError where a mesh point does not follow from its neighbours.
    """
    count, n, width = step.shape
    left = -step[:, :, 1 : 1 + n]
    right = np.broadcast_to(np.eye(n), left.shape)
    given = -np.delete(step, np.s_[1 : 1 + n], axis=2)
    active, levels = np.arange(count + 1), []
    while len(active) > 2:
        even = len(left) // 2 * 2
        middle = np.concatenate([right[0:even:2], left[1:even:2]], axis=1)
        nothing = np.zeros_like(left[0:even:2])
        above = np.concatenate([left[0:even:2], nothing, given[0:even:2]], axis=2)
        below = np.concatenate([nothing, right[1:even:2], given[1:even:2]], axis=2)
        orthogonal, triangle = np.linalg.qr(middle, mode="complete")
        both = np.swapaxes(orthogonal, 1, 2) @ np.concatenate([above, below], axis=1)
        levels.append((active, even, -np.linalg.solve(triangle[:, :n], both[:, :n])))
        rest = both[:, n:]
        left = np.concatenate([rest[:, :, :n], left[even:]])
        right = np.concatenate([rest[:, :, n : 2 * n], right[even:]])
        given = np.concatenate([rest[:, :, 2 * n :], given[even:]])
        active = np.append(active[0:even:2], active[even:])
    ends = np.concatenate([given[0, :, :1], left[0], right[0], given[0, :, 1:]], axis=1)
    maps = np.zeros((count + 1, n, width + n))
    maps[0, :, 1 : 1 + n] = maps[-1, :, 1 + n : 1 + 2 * n] = np.eye(n)
    for nodes, even, found in reversed(levels):
        a, b, c = nodes[0:even:2], nodes[1:even:2], nodes[2 : even + 1 : 2]
        maps[b] = found[:, :, :n] @ maps[a] + found[:, :, n : 2 * n] @ maps[c]
        maps[b, :, 0] += found[:, :, 2 * n]
        maps[b, :, 1 + 2 * n :] += found[:, :, 2 * n + 1 :]
    return Reduced(ends, maps)
