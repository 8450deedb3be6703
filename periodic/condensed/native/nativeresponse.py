"""The response of modes in C (`modes.c`, `motion.c`, `slopes.c`), for systems that can compile it."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.modal.moments import SERIES_UP_TO, TERMS, Complex, Table
from periodic.condensed.modal.response import Response, moments_of
from periodic.orbit.mesh import Grid
from periodic.orbit.native.addresses import address, library_of, plain, routine
from periodic.orbit.scheme import Array, Scheme
from periodic.system import ModesLike, System

MANY = 12
"""Number of columns from which matrix products are left to BLAS."""

_SOURCES = tuple(f"periodic.condensed.native:{name}.c" for name in ("modes", "motion", "slopes"))

_SIZES = ("count", "points", "modes", "states", "forces", "widths", "terms")
_OF_MODES = ("exponents", "inputs", "outputs", "direct", "direct_rate")
_OF_SCHEME = ("place", "taylor", "derivatives")
_GIVEN = ("width", *_OF_SCHEME, *_OF_MODES)
_LAID = ("growth", "moment", "slope", "local", "impulse", "stage_outputs")


class _Call(ctypes.Structure):
    """`struct response` of modes.c."""

    _fields_ = (
        *((name, ctypes.c_ssize_t) for name in _SIZES),
        *((name, ctypes.c_void_p) for name in ("which", *_GIVEN, *_LAID)),
        ("near", ctypes.c_double),
    )


_CHANGE = ("stretch", *_OF_MODES, "begun", "found", "history", "inner", "kicks", "moved")


class _Change(ctypes.Structure):
    """`struct change` of slopes.c."""

    _fields_ = (
        *((name, ctypes.c_ssize_t) for name in ("wider", "others")),
        *((name, ctypes.c_void_p) for name in _CHANGE),
    )


@dataclass(frozen=True)
class NativeResponse(Response):
    """See `Response`. library: the compiled sources."""

    library: ctypes.CDLL

    @cached_property
    def _laid(self) -> tuple[_Call, dict[str, NDArray[Any]], Sequence[Any]]:
        """The call, its tables by name, of the distinct widths, and the arrays to be kept alive."""
        count, size, a = len(self._distinct[0]), len(self.modes.exponents), self.scheme.ncol
        s, k = self.modes.direct.shape
        table = (count, size, a)
        complex_ = [table, (*table, a), (*table, a), (*table, k), (count, a, s, size)]
        growth, moment, slope, impulse, stage_outputs = _room(complex_)
        local = np.empty((count, a, s, a, k))
        found = self._with((growth, moment, slope, local, impulse, stage_outputs))
        routine(self.library, "lay_out", 1)(ctypes.addressof(found[0]))
        return found

    def _with(self, tables: Sequence[NDArray[Any]]) -> tuple[_Call, dict[str, NDArray[Any]], Sequence[Any]]:
        """The call with tables."""
        widths, which = self._distinct
        modes, call = self.modes, _Call.from_buffer_copy(_of_scheme(self.scheme)[0])
        call.states, call.forces = modes.direct.shape
        call.count, call.modes, call.widths = len(which), len(modes.exponents), len(widths)
        kept: list[Any] = [np.ascontiguousarray(which, dtype=np.intp), plain(widths)]
        kept += map(_complex, (modes.exponents, modes.inputs, modes.outputs))
        kept += map(plain, (modes.direct, modes.direct_rate))
        kept += tables
        for name, array in zip(("which", "width", *_OF_MODES, *_LAID), kept, strict=True):
            setattr(call, name, address(array))
        return call, dict(zip(_LAID, tables, strict=True)), kept

    @cached_property
    def table(self) -> Table:
        """Moments for all intervals, (N, J, ...)."""
        return Table(*(self._each(name) for name in _LAID[:3]))

    @cached_property
    def grown(self) -> Complex:
        """Growth factors of the modes over each interval, (N, J)."""
        return np.asarray(self._laid[1]["growth"][:, :, -1][self._distinct[1]])

    @cached_property
    def local(self) -> Array:
        """States at the points of an interval per unit of its own forces, (N, a, s, b, k)."""
        return self._each("local")

    @cached_property
    def impulse(self) -> Complex:
        """Modes at the end of an interval per unit of the forces in it, (N, J, b, k)."""
        return self._each("impulse")

    @cached_property
    def stage_outputs(self) -> Complex:
        """States at the points per unit of the modes at the left end, (N, a, s, J)."""
        return self._each("stage_outputs")

    def _each(self, name: str) -> NDArray[Any]:
        laid, which = self._laid[1][name], self._distinct[1]
        return np.broadcast_to(laid, (len(which), *laid.shape[1:])) if len(laid) == 1 else laid[which]

    @property
    def _shared(self) -> Sequence[str]:
        return "_distinct", "closing"

    def between(self, states: NDArray[np.int_], forces: NDArray[np.int_]) -> Response:
        """Return the response of some of the states to some of the forces."""
        if self.modes.direct.shape == (len(states), len(forces)):
            return self
        found = super().between(states, forces)
        assert isinstance(found, NativeResponse)
        tables = dict(self._laid[1])
        tables["local"] = tables["local"][:, :, states][..., forces]
        tables["impulse"], tables["stage_outputs"] = (
            tables["impulse"][..., forces],
            tables["stage_outputs"][:, :, states],
        )
        vars(found)["_laid"] = found._with([np.ascontiguousarray(table) for table in tables.values()])
        return found

    def history(self, forces: Array, closing: Complex | None = None) -> Complex:
        """Return the modes at the left ends and at the end in periodic motion, as `Response.history`."""
        if not _few(forces):
            return super().history(forces, closing)
        found, _ = self._driven(forces, self.closing if closing is None else closing, None, with_states=False)
        return found.reshape(*found.shape[:2], *forces.shape[3:])

    def motion(self, forces: Array) -> tuple[Complex, Array]:
        """Return modes and states in periodic motion, as `Response.motion`."""
        if not _few(forces):
            return super().motion(forces)
        history, states = self._driven(forces, self.closing, None)
        return history[..., 0], states[..., 0]

    def stages(self, forces: Array, closing: Complex | float | None = None) -> Array:
        """Return the states at the points in periodic motion, as `Response.stages`."""
        if not _few(forces):
            return super().stages(forces, closing)
        _, states = self._driven(forces, self.closing if closing is None else closing, None)
        return states.reshape(*states.shape[:3], *forces.shape[3:])

    def motions(self, forces: Array, begun: Complex) -> tuple[Array, Complex]:
        """Return states at the points and modes at the end of motions from z(0), as `Response.motions`."""
        if not _few(forces):
            return super().motions(forces, begun)
        history, states = self._driven(forces, 0.0, begun)
        return states, history[-1]

    def driven(self, forces: Array) -> Complex:
        """Return the modes at the mesh points from z(0) = 0, as `Response.driven`."""
        return (
            self._driven(forces, 0.0, None, with_states=False)[0] if _few(forces) else super().driven(forces)
        )

    def _driven(
        self, forces: Array, closing: Complex | float, begun: Complex | None, *, with_states: bool = True
    ) -> tuple[Complex, Array]:
        """History (N+1, J, r), and states (N, a, s, r) if `with_states`."""
        call, size = self._laid[0], len(self.modes.exponents)
        given, count, columns = plain(forces), len(forces), math.prod(forces.shape[3:])
        ends = _complex(self._filled(closing))
        begin = None if begun is None else _complex(begun)
        kicks, history = _room([(count, size, columns), (count + 1, size, columns)])
        states = np.empty((count, self.scheme.ncol, call.states, columns) if with_states else 0)
        routine(self.library, "driven", 8)(
            *(ctypes.addressof(call), columns, address(given), address(ends)),
            *(None if begin is None else address(begin), address(kicks), address(history)),
            address(states) if with_states else None,
        )
        return history, states

    def _filled(self, closing: Complex | float) -> Complex:
        found = np.asarray(closing, dtype=np.complex128)
        return found if found.ndim else np.full(len(self.modes.exponents), found)

    def pulled(self, weights: Array, closing: Complex | float) -> Array:
        """Return weights of forces from weights of states, as `Response.pulled`."""
        if not _few(weights):
            return super().pulled(weights, closing)
        call, size = self._laid[0], len(self.modes.exponents)
        given, (count, points, _, columns) = plain(weights), weights.shape
        ends = _complex(self._filled(closing))
        states_at_points, after = _room([(count, size, columns), (size, columns)])
        found = np.empty((count, points, call.forces, columns))
        arrays = given, ends, states_at_points, after, found
        routine(self.library, "pulled", 7)(ctypes.addressof(call), columns, *map(address, arrays))
        return found

    def circulant(self, closing: Complex | None, states: NDArray[np.int_], forces: NDArray[np.int_]) -> Array:
        """Return the map from some forces to some states on a uniform mesh, as `Response.circulant`."""
        call, shape = self._laid[0], (self.scheme.ncol, len(forces))
        count, points, coupled = call.count, call.points, np.ascontiguousarray(states, dtype=np.intp)
        acting = np.ascontiguousarray(forces, dtype=np.intp)
        ends = None if closing is None else _complex(closing)
        passed, later = _room([(call.modes, *shape)])[0], np.empty((count, points, len(coupled), *shape))
        found = np.empty((count, points, len(coupled), count, *shape))
        routine(self.library, "circulant", 9)(
            *(ctypes.addressof(call), None if ends is None else address(ends)),
            *(len(coupled), address(coupled), len(acting), address(acting)),
            *(address(passed), address(later), address(found)),
        )
        return found

    def sloped(
        self,
        forces: Array,
        widths: Array,
        changes: Sequence[ModesLike],
        closing: Complex,
        history: Complex | None = None,
    ) -> tuple[NDArray[Any], Complex]:
        """Return derivatives of states and of modes at the beginning, as `Response.sloped`."""
        if np.iscomplexobj(forces):
            return super().sloped(forces, widths, changes, closing, history)
        history = self.history(forces, closing) if history is None else history
        found, begun, _ = self._sloped(forces, widths, changes, _complex(closing), history)
        return found, begun

    def sloped_within(
        self, forces: Array, changes: Sequence[ModesLike], history: Complex
    ) -> tuple[Array, Complex]:
        """Return derivatives in an interval's own width and in the modes, as `Response.sloped_within`."""
        own = np.ones((len(self.grid.width), 1))
        found, _, left = self._sloped(forces, own, changes, None, history)
        return found, left

    def _sloped(
        self,
        forces: Array,
        widths: Array,
        changes: Sequence[ModesLike],
        ends: Complex | None,
        history: Complex,
    ) -> tuple[Array, Complex, Complex]:
        """Derivatives of states, of modes at the beginning, and at the ends of intervals from its own."""
        call, size = self._laid[0], len(self.modes.exponents)
        (count, points), columns = forces.shape[:2], widths.shape[1] + len(changes)
        given, history = plain(forces), _complex(history)
        kept: list[NDArray[Any]] = [plain(widths)]
        for name in _OF_MODES:
            kept.append(np.ascontiguousarray([getattr(change, name) for change in changes]))
        found = np.empty((count, points, call.states, columns))
        each = (count, size, columns)
        shapes = [(size, columns), (count, size, points, columns), each, (count + 1, *each[1:])]
        begun, inner, kicks, moved, stages = _room([*shapes, (count, size, points)])
        own = _Change(widths.shape[1], len(changes))
        for name, array in zip(_CHANGE, (*kept, begun, found, history, inner, kicks, moved), strict=True):
            setattr(own, name, address(array))
        routine(self.library, "sloped", 5)(
            *(ctypes.addressof(call), ctypes.addressof(own), address(given)),
            *(None if ends is None else address(ends), address(stages)),
        )
        return found, begun, kicks


def response_of(system: System, modes: ModesLike, scheme: Scheme, grid: Grid, period: float) -> Response:
    """Return the response of modes on a mesh, in C where the system can compile it."""
    library = library_of(system, *_SOURCES)
    if library is None:
        return Response(modes, scheme, grid, period)
    return NativeResponse(modes, scheme, grid, period, library)


def _few(forces: Array) -> bool:
    return not np.iscomplexobj(forces) and math.prod(forces.shape[3:]) < MANY


def _complex(array: NDArray[Any]) -> Complex:
    """A contiguous array of complex numbers that C may take."""
    found = np.ascontiguousarray(array, dtype=np.complex128)
    return found if found.flags.writeable else found.copy()


def _room(shapes: Sequence[tuple[int, ...]]) -> list[Complex]:
    """Arrays of complex numbers, one after the other in memory."""
    sizes = [math.prod(shape) for shape in shapes]
    block, found, first = np.empty(sum(sizes), dtype=np.complex128), [], 0
    for shape, size in zip(shapes, sizes, strict=True):
        found.append(block[first : first + size].reshape(shape))
        first += size
    return found


@cache
def _of_scheme(scheme: Scheme) -> tuple[_Call, Sequence[Array]]:
    """A call with what belongs to a scheme, and the arrays that it has addresses of."""
    moments, call = moments_of(scheme), _Call(points=scheme.ncol, terms=TERMS, near=SERIES_UP_TO)
    kept = [plain(array) for array in (moments.places, moments.taylor, moments.derivatives)]
    for name, array in zip(_OF_SCHEME, kept, strict=True):
        setattr(call, name, address(array))
    return call, kept
