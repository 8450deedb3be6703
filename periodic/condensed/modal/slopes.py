"""How the motion of the modes changes where intervals are wider and the modes are others, forces held."""

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
) -> tuple[Array, Complex]:
    """Return how states at the points, (N, a, s, q), and modes at the beginning, (J, q), change.

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
        What forces and motion are multiplied by over the period; with a complex one the forces may be
        complex, and the modes at the beginning are left out.
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
    shown, begun[:, columns] = _slopes(response, forces, widths, given, closing)
    if turning:
        other, _ = _slopes(response, forces.conj(), widths, given, conjugate.conj())
        found[..., columns] = (shown + other.conj()) / 2
    else:
        found[..., columns] = shown.real
    return found, begun


def _slopes(
    response: Response, forces: Array, widths: Array, changes: list[ModesLike], closing: Complex
) -> tuple[Complex, Complex]:
    modes, table, width = response.modes, response.table, response.grid.width
    first, q = widths.shape[1], widths.shape[1] + len(changes)
    stretch = np.zeros((len(width), q))
    stretch[:, :first] = widths
    faster = np.zeros((len(modes.exponents), q), dtype=complex)
    for i, change in enumerate(changes):
        faster[:, first + i] = change.exponents
    # x = lambda h
    shift = width[:, None, None] * faster + stretch[:, None, :] * modes.exponents[:, None]
    history = response.history(forces, closing)
    driven = _driving(forces, modes.inputs)
    answer, steeper = _applied(response, table.moment, driven), _applied(response, table.slope, driven)
    inner = stretch[:, None, None, :] * answer[..., None]
    inner += (width[:, None, None] * steeper)[..., None] * shift[:, :, None, :]
    turn = response.scheme.points[:, None] * shift[:, :, None, :]
    inner += (table.growth * history[:-1, :, None])[..., None] * turn
    for i, change in enumerate(changes):
        other = _driving(forces, change.inputs)
        inner[..., first + i] += width[:, None, None] * _applied(response, table.moment, other)
    moved = response.closed(inner[:, :, -1], closing)
    states = inner + table.growth[..., None] * moved[:-1, :, None]
    count, points = len(width), len(response.scheme.points)
    flat = states.transpose(1, 0, 2, 3).reshape(len(modes.exponents), -1)
    found = (modes.outputs @ flat).reshape(-1, count, points, q).transpose(1, 2, 0, 3).copy()
    stages = table.growth * history[:-1, :, None] + width[:, None, None] * answer
    rates = np.einsum("ab,nbk->nak", response.moments.derivatives[1, 1:], forces) / width[:, None, None]
    for i, change in enumerate(changes):
        found[..., first + i] += (change.outputs @ stages).transpose(0, 2, 1)
        found[..., first + i] += forces @ change.direct.T + rates @ change.direct_rate.T
    lost = rates @ modes.direct_rate.T
    found -= lost[..., None] * (stretch / width[:, None])[:, None, None, :]
    return np.asarray(found), moved[0]


def _driving(forces: Array, inputs: Complex) -> Complex:
    """Forces (N, b, k) as they drive the modes, (N, J, b)."""
    return np.asarray((forces @ inputs.T).transpose(0, 2, 1))


def _applied(response: Response, moment: Complex, driven: Complex) -> Complex:
    """Moments (N, J, a, b) of what drives the modes, (N, J, b): shape (N, J, a)."""
    if response.uniform:
        return np.asarray((moment[0] @ driven.transpose(1, 2, 0)).transpose(2, 0, 1))
    return np.asarray((moment @ driven[..., None])[..., 0])
