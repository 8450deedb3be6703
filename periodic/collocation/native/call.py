"""What C is given of an orbit's equations (`struct call` of newton.c), and for which systems it is used."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from periodic.collocation.fastmotions.substeps import GROWING
from periodic.collocation.native.elimination import ELIMINATION, LARGE, full
from periodic.correction.newton import NewtonSettings
from periodic.events.modes import sides
from periodic.linear.bordering import GROWTH
from periodic.orbit.mesh import Mesh
from periodic.orbit.native.addresses import address, library_of, plain
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System, address_of, jumps_of, resets_of

MOST_STATES = 60
"""Largest number of states for which C is used; with full matrices it must be less than `LARGE`."""

_SOURCES = (ELIMINATION, *(f"periodic.collocation.native:{name}.c" for name in ("newton", "estimate")))

_SIZES = ("count", "ncol", "n", "m", "k", "e", "parameters", "switches", "exact", "free", "most")
_MARKS = ("segment", "starts", "switch_of", "ends", "ties")
_MESH = ("left", "width", "left_gradient", "width_gradient", "tied_left", "tied_width", "levels")
_SCHEME = ("points", "differentiation", "end", "weights")
_SYSTEM = {
    "rows": "linearise",
    "beside": "linearise_beside",
    "move": "move",
    "switch_values": "switch",
    "switch_slopes": "switch_gradient",
    "guards": "guards",
    "guard_slopes": "guards_gradient",
}
"""Members of `struct call` that are functions of the system, with the names of its kernels."""

_CONSTRAINT = ("weighted", "origin_nodes")
ORIGIN = ("node_rates", "knots", "knot_rates", "phases", "left", "width")
FOUND = ("nodes", "stages", "algebraic", "phases", "parameter")
SOLVED = ("maps", "steps", *(f"{of}_{part}" for of in ("step", "kernel") for part in (*FOUND[:3], "outer")))
_SETTINGS = (
    "period",
    "nominal",
    "tolerance",
    "close",
    "max_change",
    "shortest",
    "narrow",
    "negligible",
    "growth",
)
_MEASURED = ("residual", "size", "length", "stretch", "depth")
_NUMBERS = (*_SETTINGS, "origin_parameter", "slope", "distance", *_MEASURED, "growing")

_GIVEN = (*_MARKS, *_MESH, *_SCHEME, *_SYSTEM, "side", *_CONSTRAINT, *(f"origin_{name}" for name in ORIGIN))
_ADDRESSES = (*_GIVEN, "lengths", *FOUND, *SOLVED)


class Call(ctypes.Structure):
    """`struct call` of newton.c."""

    _fields_ = (
        *((name, ctypes.c_ssize_t) for name in _SIZES),
        *((name, ctypes.c_void_p) for name in _ADDRESSES),
        *((name, ctypes.c_double) for name in _NUMBERS),
        *((name, ctypes.c_ssize_t) for name in ("iterations", "columns", "jumping", "gentle")),
    )


class Prepared(NamedTuple):
    """A call, the library, and the modes of the surfaces at the collocation points, (points, columns)."""

    call: Call
    library: ctypes.CDLL
    side: Array

    def holds(self, system: System, orbit: Orbit) -> bool:
        """Whether an orbit that was solved for with these modes has them itself."""
        own = self.side[:: orbit.mesh.scheme.ncol]
        return own.size == 0 or np.array_equal(own, sides(system, orbit))


def prepared(
    system: System, orbit: Orbit, mesh: Mesh, free: tuple[int, ...], settings: NewtonSettings
) -> Prepared | None:
    """A call for an orbit on a mesh, with what belongs to mesh, system and settings, and the library.

    The modes are those of the orbit. None where NumPy must be used: C does periodic orbits of small systems
    without impacts whose kernels are compiled, in one free parameter.
    """
    n = orbit.nodes.shape[1]
    if n > MOST_STATES or orbit.equilibrium or len(free) != 1 or resets_of(system):
        return None
    own = sides(system, orbit)
    compiled = _compiled(system, free, bool(own.any()))
    if compiled is None or (n >= LARGE and _full(system, orbit)):
        return None
    functions, library, jumping = compiled
    call = Call.from_buffer_copy(_of_mesh(mesh)[0])
    call.n, call.m, call.parameters = n, orbit.algebraic.shape[2], len(orbit.parameter)
    call.switches, call.free = len(system.switches), free[0]
    call.nominal = max(abs(system.nominal[free[0]]), settings.tiny)
    call.tolerance, call.close, call.max_change = settings.tolerance, settings.close, settings.max_change
    call.shortest = 0.5**settings.max_halvings
    call.narrow, call.negligible = settings.short, settings.negligible
    for name, where in functions.items():
        setattr(call, name, where)
    call.jumping = jumping
    side = own
    if own.size:
        side = plain(np.repeat(own, mesh.ntst // orbit.mesh.ntst * mesh.scheme.ncol, axis=0))
    call.columns, call.side = side.shape[1], address(side) if side.size else None
    return Prepared(call, library, side)


def _full(system: System, orbit: Orbit) -> bool:
    """Whether the derivatives in the states at the first collocation point are mostly other than 0."""
    at = orbit.knot_rates[0, 1:2], orbit.stages[0, :1], orbit.algebraic[0, :1], orbit.stage_phases[0, :1]
    return full(system.linearise(*at, orbit.parameter).d_state)


_Compiled = tuple[dict[str, int], ctypes.CDLL, bool]

_systems: WeakKeyDictionary[System, dict[tuple[tuple[int, ...], bool], _Compiled]] = WeakKeyDictionary()


def _compiled(system: System, free: tuple[int, ...], sided: bool) -> _Compiled | None:
    """Addresses of the kernels, the library, and whether rates jump; once they are compiled from a cache."""
    known = _systems.setdefault(system, {})
    if (free, sided) not in known:
        functions, library = _functions(system, free, sided), library_of(system, *_SOURCES)
        if functions is None or library is None:
            return None
        known[free, sided] = functions, library, bool(jumps_of(system))
    return known[free, sided]


def _functions(system: System, free: tuple[int, ...], sided: bool) -> dict[str, int] | None:
    """Addresses of the kernels needed; `sided`: those in given modes. None where one is not compiled."""
    depend = getattr(system, "guards_depend", False)
    values = ("guards", "guard_slopes") if depend else ("switch_values", "switch_slopes")
    needed = ["beside" if sided else "rows"]
    needed += ["move"] if system.algebraics else []
    needed += values if system.switches else []
    chosen = {"rows": free, "beside": free}
    found = {name: address_of(system, _SYSTEM[name], chosen.get(name, ())) for name in needed}
    functions = {name: where for name, where in found.items() if where is not None}
    return functions if len(functions) == len(needed) else None


def given(call: ctypes.Structure, names: Sequence[str], arrays: Sequence[Array]) -> list[Array]:
    """Write the addresses of arrays into a call; return the arrays, to be kept alive while C uses them."""
    kept = [plain(array) for array in arrays]
    for name, array in zip(names, kept, strict=True):
        setattr(call, name, address(array))
    return kept


def laid_out(call: Call, names: Sequence[str], shapes: Sequence[tuple[int, ...]]) -> list[Array]:
    """Arrays of some shapes, one after the other in memory, for a call to write into."""
    sizes = [math.prod(shape) for shape in shapes]
    block = np.empty(sum(sizes))
    begin, arrays, first = address(block), [], 0
    for name, shape, size in zip(names, shapes, sizes, strict=True):
        setattr(call, name, begin + 8 * first)
        arrays.append(block[first : first + size].reshape(shape))
        first += size
    return arrays


_meshes: WeakKeyDictionary[Mesh, tuple[Call, Sequence[Any]]] = WeakKeyDictionary()


def _of_mesh(mesh: Mesh) -> tuple[Call, Sequence[Any]]:
    """A call with what belongs to a mesh and its scheme, and the arrays that it has addresses of."""
    if mesh not in _meshes:
        segment, left, width = mesh.segments
        marks = (segment, mesh.starts, [event.switch for event in mesh.events], mesh.exact_ends, mesh.ties)
        levels = np.array([event.level for event in mesh.events])
        numbers = (left, width, *mesh.gradients, *mesh.tie_gradients, levels)
        scheme = mesh.scheme
        of_scheme = (scheme.points, scheme.differentiation, scheme.end, scheme.barycentric)
        kept: list[Any] = [np.array(mark, dtype=np.intp) for mark in marks]
        kept += map(plain, (*numbers, *of_scheme))
        call = Call(count=mesh.ntst, ncol=scheme.ncol, k=len(mesh.events), exact=len(mesh.exact_ends))
        call.e = mesh.ties.shape[1]
        for name, array in zip((*_MARKS, *_MESH, *_SCHEME), kept, strict=True):
            setattr(call, name, address(array))
        call.period, call.growth, call.growing = mesh.period, GROWTH, GROWING
        _meshes[mesh] = call, kept
    return _meshes[mesh]
