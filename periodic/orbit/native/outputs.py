"""Outputs of an orbit, and their extremes, in one call of C (`outputs.c`, `extremes.c`)."""

from __future__ import annotations

import ctypes

import numpy as np

from periodic.orbit.native.addresses import address, library_of, plain, routine
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System, address_of

_SOURCES = ("periodic.orbit.native:outputs.c", "periodic.orbit.native:extremes.c")
_SIZES = ("count", "ncol", "n", "m", "outputs", "points")
_ORBIT = ("left", "width", "nodes", "stages", "algebraic", "parameter", "tau")
_SCHEME = ("places", "weights", "inner_weights", "derivatives")


class Call(ctypes.Structure):
    """`struct call` of outputs.c."""

    _fields_ = (
        *((name, ctypes.c_ssize_t) for name in _SIZES),
        *((name, ctypes.c_void_p) for name in (*_ORBIT, *_SCHEME, "rows", "values_at", "values")),
        ("period", ctypes.c_double),
    )


def outputs(system: System, orbit: Orbit, tau: Array) -> Array | None:
    """Return what `periodic.orbit.extrema.outputs` does, or None where NumPy must be used."""
    return _called("outputs", system, orbit, tau, np.zeros((len(tau), len(system.outputs))))


def extremes(system: System, orbit: Orbit) -> Array | None:
    """Return minima and maxima of the outputs and the phases of both, (4, outputs), or None likewise."""
    return _called("extremes", system, orbit, np.zeros(0), np.zeros((4, len(system.outputs))))


def _called(what: str, system: System, orbit: Orbit, tau: Array, values: Array) -> Array | None:
    """Return the values that a function of C writes, or None where NumPy must be used.

    Only piecewise polynomials are read in C; a Fourier series interpolates between its samples itself.
    """
    if type(orbit) is not Orbit:
        return None
    values_at = address_of(system, "output")
    if values_at is None:
        return None
    (count, ncol, n), m = orbit.stages.shape, orbit.algebraic.shape[2]
    rows = address_of(system, "linearise") if m else 0
    library = library_of(system, *_SOURCES)
    if rows is None or library is None:
        return None
    scheme, grid = orbit.mesh.scheme, orbit.grid
    own = grid.left, grid.width, orbit.nodes, orbit.stages, orbit.algebraic, orbit.parameter, tau
    fixed = scheme.knots, scheme.barycentric, scheme.inner_barycentric, scheme.differentiation
    kept = [plain(array) for array in (*own, *fixed)]
    sizes, found = (count, ncol, n, m, len(system.outputs), len(tau)), address(values)
    call = Call(*sizes, *map(address, kept), rows, values_at, found, orbit.mesh.period)
    return values if routine(library, what)(ctypes.addressof(call)) == 0 else None
