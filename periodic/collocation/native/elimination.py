"""Elimination of the stages in C (`elimination.c`), for systems that can compile it: see `Compiling`.

NumPy's calls cost more than the work that they do where matrices are small, and C leaves zeros out; large
full ones are BLAS's.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from periodic.collocation.residual import Evaluated
from periodic.orbit.native.addresses import library_of, plain
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import LinearisationLike, System

NOT_FINITE, SINGULAR = 1, 2
"""What `eliminate_stages` answers where it fails."""

LARGE = 32
"""Number of states from which full matrices are BLAS's,"""

FULL = 0.25
"""... full where more than this part of their elements is not 0."""

ELIMINATION = "periodic.collocation.native:elimination.c"

MEMORY = 16e6
"""Bytes of derivatives that are held at a time."""

_Address = ctypes.c_char * 0


@dataclass(frozen=True)
class Routines:
    """The functions of a library; arrays and errors as in `periodic.collocation.elimination`."""

    library: ctypes.CDLL

    def __post_init__(self) -> None:
        size, array, lib = ctypes.c_ssize_t, ctypes.c_void_p, self.library
        lib.eliminate_stages.argtypes, lib.eliminate_stages.restype = [size] * 7 + [array] * 22, ctypes.c_int
        lib.chain.argtypes, lib.chain.restype = [size] * 3 + [array] * 2, None
        lib.recover.argtypes, lib.recover.restype = [size] * 7 + [ctypes.c_double] + [array] * 11, None

    def eliminate_stages(self, orbit: Orbit, line: LinearisationLike) -> tuple[Array, Array, Array, float]:
        """Return step, stages, algebraic and residual of the equations linearised at an orbit.

        Raises as `periodic.collocation.elimination.eliminate_stages`, and ValueError for
        derivatives of a wrong shape.
        """
        (count, ncol, n), m, residual = orbit.stages.shape, orbit.algebraic.shape[2], 0.0
        step: Array | None = None
        for part, own in _parts(orbit, line):
            k, p = len(orbit.phases), own.d_parameter.shape[2]
            w = 1 + n + min(k, 2) + p
            if step is None:
                step, stages = np.empty((count, n, 1 + n + k + p)), np.empty((count, ncol, n, w))
                algebraic = np.empty((count, ncol, m, w + n))
            _check(own, (part.stop - part.start) * ncol, n, m)
            into = step[part], stages[part], algebraic[part]
            residual = max(residual, self._eliminate(orbit, part, own, into))
        assert step is not None
        return step, stages, algebraic, residual

    def _eliminate(
        self, orbit: Orbit, part: slice, line: LinearisationLike, into: tuple[Array, Array, Array]
    ) -> float:
        """Condense some intervals; return their largest residual."""
        (ncol, n), m, residual = orbit.stages.shape[1:], orbit.algebraic.shape[2], np.empty(1)
        w, nodes = into[1].shape[3], orbit.nodes[part.start : part.stop + 1]
        room = (ncol * n + m) * (w + n) + m * (m + w + n) + ncol * n * (ncol * n + w + 1) + 3 * ncol**2
        mesh, scheme = orbit.mesh, orbit.mesh.scheme
        left_gradient, width_gradient = mesh.tie_gradients
        code = self.library.eliminate_stages(
            *(part.stop - part.start, ncol, n, m),
            *(len(orbit.phases), mesh.ties.shape[1], line.d_parameter.shape[2]),
            *_marks(mesh.ties[part]),
            *_given(line.residual, line.d_rate, line.d_state),
            *_given(line.d_algebraic, line.d_phase, line.d_parameter),
            *_given(orbit.grid.width[part], left_gradient[part], width_gradient[part]),
            *_given(scheme.points, scheme.stage_rates, scheme.end),
            *_given(orbit.knots[part], orbit.knot_rates[part], nodes),
            *_given(*into, residual, np.empty(room), np.empty(n * (n + 4))),
        )
        if code == NOT_FINITE:
            raise FloatingPointError("the residual or a derivative is not finite")
        if code == SINGULAR:
            raise np.linalg.LinAlgError("a local matrix is singular")
        return float(residual[0])

    def chain(self, step: Array) -> Array:
        """Return the affine maps from the first mesh point to all, see `periodic.linear.bordering.chain`."""
        count, n, w = step.shape
        maps = np.empty((count + 1, n, w))
        self.library.chain(count, n, w, *_given(step, maps))
        return maps

    def recover(
        self,
        orbit: Orbit,
        by_stage: Array,
        by_unknown: Array,
        nodes: Array,
        outer: Array,
        constant: float,
    ) -> tuple[Array, Array]:
        """Return the increments of stages and unknowns from their maps."""
        (count, ncol, n), m = orbit.stages.shape, orbit.algebraic.shape[2]
        ties, k = orbit.mesh.ties, len(orbit.phases)
        stages, algebraic = np.empty((count, ncol, n)), np.empty((count, ncol, m))
        self.library.recover(
            *(count, ncol, n, m, k, ties.shape[1], len(outer) - k, constant),
            *_marks(ties),
            *_given(by_stage, by_unknown, orbit.mesh.scheme.stage_rates),
            *_given(orbit.grid.width, nodes, outer, stages, algebraic, np.empty(n), np.empty(len(outer))),
        )
        return stages, algebraic


def routines(system: System, line: LinearisationLike) -> Routines | None:
    """Return what a system has compiled, or None where NumPy must be used for its linearised equations."""
    if len(system.states) >= LARGE and _full(line):
        return None
    library = library_of(system, ELIMINATION)
    return None if library is None else _routines(library)


def _full(line: LinearisationLike) -> bool:
    """Whether the derivatives in the states at the first point are mostly other than 0."""
    first = line.part(slice(0, 1)) if isinstance(line, Evaluated) else line
    return full(first.d_state[:1])


def full(matrix: Array) -> bool:
    """Return whether a matrix is mostly other than 0."""
    return bool(np.count_nonzero(matrix) > FULL * matrix.size)


def _parts(orbit: Orbit, line: LinearisationLike) -> Iterator[tuple[slice, LinearisationLike]]:
    """Yield intervals and their equations: so many at a time that derivatives stay below MEMORY."""
    (count, ncol, n), m = orbit.stages.shape, orbit.algebraic.shape[2]
    if not isinstance(line, Evaluated):
        yield slice(0, count), line
        return
    each = max(1, int(MEMORY / (8 * ncol * (n + m) * (2 * n + m + 3))))
    for begin in range(0, count, each):
        part = slice(begin, min(begin + each, count))
        yield part, line.part(part)


@cache
def _routines(library: ctypes.CDLL) -> Routines:
    return Routines(library)


def _check(line: LinearisationLike, points: int, n: int, m: int) -> None:
    """Refuse what C would read past the end of."""
    lengths = {"residual": (), "d_rate": (n,), "d_state": (n,), "d_algebraic": (m,), "d_phase": ()}
    for name, tail in {**lengths, "d_parameter": line.d_parameter.shape[2:]}.items():
        shape, wanted = getattr(line, name).shape, (points, n + m, *tail)
        if shape != wanted:
            raise ValueError(f"{name} of the linearised equations has shape {shape}; it must be {wanted}")


def _given(*arrays: Array) -> list[ctypes.Array[ctypes.c_char]]:
    return [_Address.from_buffer(plain(array).data) for array in arrays]


def _marks(array: NDArray[np.int_]) -> list[ctypes.Array[ctypes.c_char]]:
    return [_Address.from_buffer(np.array(array, dtype=np.intp).data)]
