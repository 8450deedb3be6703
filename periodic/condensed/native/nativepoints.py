"""The rows of a split system at the collocation points in C (`points.c`), for systems that can compile it."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.native.addresses import address, library_of, plain, routine
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import LinearisationLike, LinearPart, System

_SOURCE = "periodic.condensed.native:points.c"

_SIZES = ("count", "ncol", "n", "m", "e", "q", "linear", "acting", "own")
_GIVEN = ("residual", "d_rate", "d_state", "d_algebraic", "d_phase", "d_parameter")
_MESH = ("rates", "place", "width", "left_gradient", "width_gradient")
_FOUND = ("states", "forces", "unknowns", "rows", "work", "filled")


class _Points(ctypes.Structure):
    """`struct points` of points.c."""

    _fields_ = (
        *((name, ctypes.c_ssize_t) for name in _SIZES),
        *((name, ctypes.c_void_p) for name in (*_GIVEN, *_MESH, *_FOUND)),
        ("largest", ctypes.c_double),
        ("found", ctypes.c_ssize_t),
        ("accelerations", ctypes.c_ssize_t),
    )


@dataclass(frozen=True)
class Eliminated:
    """Rows at the points in (1, d rate, d state, dphi, dp), dphi the phases of `Mesh.ties`.

    own (P, o, w): the differential rows that are not 0 everywhere, `filled`, unknowns eliminated;
    unknowns (P, m, w): increments of the unknowns; residual: the largest one.
    """

    own: Array
    unknowns: Array
    filled: NDArray[np.int_]
    residual: float


def eliminated(system: System, part: LinearPart, orbit: Orbit, line: LinearisationLike) -> Eliminated | None:
    """Return the rows of evaluated equations; None where NumPy must be used, also to report errors."""
    library = library_of(system, _SOURCE)
    (count, ncol, n), m = orbit.stages.shape, orbit.algebraic.shape[2]
    if library is None or line.d_state.shape[1:] != (n + m, n) or line.d_algebraic.shape[2] != m:
        return None
    left, stretch = orbit.mesh.tie_gradients
    q, own = line.d_parameter.shape[2], n - len(part.states)
    width = 1 + 2 * n + left.shape[1] + q
    rates = orbit.knot_rates[:, 1:].reshape(-1, n)
    given = [plain(getattr(line, name)) for name in _GIVEN]
    given += map(plain, (rates, orbit.mesh.scheme.points, orbit.grid.width, left, stretch))
    states, forces = (np.array(each, dtype=np.intp) for each in (part.states, part.forces))
    unknowns, rows = np.empty((count * ncol, m, width)), np.empty((count * ncol, own, width))
    filled, work = np.zeros(n, dtype=np.intp), np.empty(max(m, 1) * (m + width))
    call = _Points(count, ncol, n, m, left.shape[1], q, len(states), len(forces), own)
    every = (*given, states, forces, unknowns, rows, work, filled)
    for name, array in zip((*_GIVEN, *_MESH, *_FOUND), every, strict=True):
        setattr(call, name, address(array))
    if routine(library, "eliminate_points")(ctypes.addressof(call)) or call.found != own:
        return None
    if not (np.abs(rows).max(axis=(0, 2), initial=0.0) > 0).all() or call.accelerations:
        return None
    return Eliminated(rows, unknowns, filled[:own], call.largest)
