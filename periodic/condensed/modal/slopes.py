"""Derivatives of the modes' motion in the intervals' widths and in the modes themselves, forces fixed."""

from __future__ import annotations

import numpy as np

from periodic.condensed.modal.moments import Complex
from periodic.condensed.modal.response import Response
from periodic.orbit.scheme import Array
from periodic.system import ModesLike


def slopes(
    response: Response,
    forces: Array,
    widths: Array,
    changes: list[ModesLike | None],
    multiplier: complex = 1.0,
    history: Complex | None = None,
) -> tuple[Array, Complex]:
    """Return the derivatives of states at the points, (N, a, s, q), and of modes at the beginning, (J, q).

    Parameters
    ----------
    response : Response
        The modes on the mesh.
    forces : ndarray, shape (N, b, k)
        The forces.
    widths : ndarray, shape (N, q1)
        Changes of the widths in the first q1 directions.
    changes : list of ModesLike or None
        Changes of the modes in further ones.
    multiplier : complex
        The factor of forces and motion over the period. Where it is complex the forces may be complex; the
        derivatives of the modes at the beginning then lack those of the conjugate modes.
    history : ndarray of complex, shape (N+1, J), optional
        The modes' motion under real forces, if it is known.
    """
    count, points = len(response.grid.width), response.scheme.ncol
    s, q = response.modes.direct.shape[0], widths.shape[1] + len(changes)
    turning = np.iscomplexobj(forces)
    found = np.zeros((count, points, s, q), dtype=complex if turning else float)
    begun = np.zeros((len(response.modes.exponents), q), dtype=complex)
    active = [i for i, change in enumerate(changes) if change is not None]
    given = [change for change in changes if change is not None]
    if widths.shape[1] + len(given) == 0:
        return found, begun
    columns = [*range(widths.shape[1]), *(widths.shape[1] + i for i in active)]
    closing, conjugate = response.closings(multiplier)
    shown, begun[:, columns] = response.sloped(forces, widths, given, closing, history)
    if turning:
        other, _ = response.sloped(forces.conj(), widths, given, conjugate.conj())
        found[..., columns] = (shown + other.conj()) / 2
    else:
        found[..., columns] = shown.real
    return found, begun


def slopes_within(
    response: Response, forces: Array, changes: list[ModesLike | None], history: Complex
) -> tuple[Array, Complex]:
    """Return the derivatives of an interval's states, (N, a, s, 1+q), and of modes at its end, (N, J, 1+q).

    The first direction changes the interval's own width, further ones the modes; forces (N, b, k) and the
    modes at the left ends, `history` (N+1, J), are held.
    """
    count, points = len(response.grid.width), response.scheme.ncol
    found = np.zeros((count, points, response.modes.direct.shape[0], 1 + len(changes)))
    left = np.zeros((count, len(response.modes.exponents), 1 + len(changes)), dtype=complex)
    given = [change for change in changes if change is not None]
    columns = [0, *(1 + i for i, change in enumerate(changes) if change is not None)]
    found[..., columns], left[..., columns] = response.sloped_within(forces, given, history)
    return found, left
