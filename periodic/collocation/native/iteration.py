"""Newton's iteration of small systems in one call of C (`newton.c`), where their kernels are compiled.

It takes orbits on arclength constraints of systems without impacts and sliding. Where it does not come
through (a singular matrix, event nodes that cross) it returns None: NumPy does it all.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from periodic.collocation.native.elimination import ELIMINATION, LARGE
from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.condition import SideCondition
from periodic.correction.newton import Correction, Linearised, NewtonSettings
from periodic.correction.outcome import Outcome
from periodic.linear.bordering import GROWTH
from periodic.linear.unknowns import Increment
from periodic.orbit.mesh import Mesh
from periodic.orbit.native.arrays import address, plain, source
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System, address_of, compiling, jumps_of, resets_of

MOST = LARGE - 1
"""Number of states up to which it is worth its while, whatever the matrices: see `LARGE`."""

_SIZES = ("count", "ncol", "n", "m", "k", "parameters", "switches", "exact", "free", "most")
_MARKS = ("segment", "starts", "switch_of", "ends")
_MESH = ("left", "width", "left_gradient", "width_gradient", "levels")
_SCHEME = ("points", "differentiation", "end", "weights")
_SYSTEM = ("rows", "move", "switch_values", "switch_slopes")
_CONSTRAINT = ("weighted", "origin_nodes")
_ORIGIN = ("node_rates", "knots", "knot_rates", "phases", "left", "width")
_FOUND = ("nodes", "stages", "algebraic", "phases", "parameter")
_SOLVED = ("maps", *(f"{of}_{part}" for of in ("step", "kernel") for part in (*_FOUND[:3], "outer")))
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
_NUMBERS = (*_SETTINGS, "origin_parameter", "slope", "distance", "residual", "size", "length", "stretch")

_GIVEN = (*_MARKS, *_MESH, *_SCHEME, *_SYSTEM, *_CONSTRAINT, *(f"origin_{name}" for name in _ORIGIN))
_ADDRESSES = (*_GIVEN, *_FOUND, *_SOLVED)


_OUTCOMES = {0: Outcome.CONVERGED, 5: Outcome.TOO_MANY}
"""What newton answers, where it needs no other to say what is wrong."""


class Call(ctypes.Structure):
    """`struct call` of newton.c."""

    _fields_ = (
        *((name, ctypes.c_ssize_t) for name in _SIZES),
        *((name, ctypes.c_void_p) for name in _ADDRESSES),
        *((name, ctypes.c_double) for name in _NUMBERS),
        ("iterations", ctypes.c_ssize_t),
    )


@dataclass(frozen=True)
class _Solved:
    """What a call has found: the orbit, the last increment, the kernel, the fundamental matrices."""

    call: Call
    outcome: Outcome
    orbit: Orbit
    increment: Increment
    kernel: Increment
    fundamental: Array


def corrected(
    system: System,
    guess: Orbit,
    free: tuple[int, ...],
    conditions: Sequence[SideCondition],
    settings: NewtonSettings,
) -> Correction | None:
    """Return what `periodic.correction.newton.correct` does, or None."""
    found = _called(system, guess, free, conditions, settings, settings.max_iterations)
    if found is None:
        return None
    call = found.call
    ended = (found.outcome, int(call.iterations), call.size, call.residual)
    if found.outcome is not Outcome.CONVERGED:
        return Correction(found.orbit, *ended, np.full((1, call.n, call.n), np.nan), None)
    return Correction(found.orbit, *ended, found.fundamental, found.kernel)


def linearised(
    system: System,
    orbit: Orbit,
    free: tuple[int, ...],
    conditions: Sequence[SideCondition],
    settings: NewtonSettings,
    off: Array | None = None,
) -> Linearised | None:
    """Return what `periodic.correction.newton.linearised` does, or None; event nodes lie `off` levels."""
    found = _called(system, orbit, free, conditions, settings, 0, off)
    return None if found is None else Linearised(orbit, found.increment, found.kernel, found.fundamental)


def _called(
    system: System,
    guess: Orbit,
    free: tuple[int, ...],
    conditions: Sequence[SideCondition],
    settings: NewtonSettings,
    most: int,
    off: Array | None = None,
) -> _Solved | None:
    """Call C with an orbit; None where NumPy is to do, or has to."""
    constraint = conditions[0] if len(conditions) == 1 else None
    if not (isinstance(constraint, ArclengthConstraint) and free == (constraint.index,)):
        return None
    if guess.nodes.shape[1] > MOST or guess.equilibrium or resets_of(system) or jumps_of(system):
        return None
    with_compiler, functions = compiling(system), _functions(system, free)
    if with_compiler is None or functions is None:
        return None
    library = with_compiler.library(source(ELIMINATION, "periodic.collocation.native:newton.c"))
    if library is None:
        return None
    call = Call.from_buffer_copy(_of_mesh(guess.mesh)[0])
    call.n, call.m, call.parameters = guess.nodes.shape[1], guess.algebraic.shape[2], len(guess.parameter)
    call.switches, call.free, call.most = len(system.switches), free[0], most
    call.nominal = max(abs(system.nominal[constraint.index]), settings.tiny)
    call.tolerance, call.close, call.max_change = settings.tolerance, settings.close, settings.max_change
    call.shortest = 0.5**settings.max_halvings
    call.narrow, call.negligible = settings.short, settings.negligible
    kept = _constrained(call, constraint)
    if off is not None and len(off):
        kept.append(np.array([event.level for event in guess.mesh.events]) - off)
        call.levels = address(kept[-1])
    for name, where in zip(_SYSTEM, functions, strict=True):
        setattr(call, name, where)
    orbit, parts, maps = _laid_out(call, guess)
    outcome = _OUTCOMES.get(_routine(library)(ctypes.addressof(call)))
    del kept
    if outcome is None:
        return None
    if most and outcome is not Outcome.CONVERGED:  # what C has left there, if anything, is no change
        for array in (*parts[0], *parts[1]):
            array.fill(0.0)
    increment, kernel = (_change(orbit, part) for part in parts)
    return _Solved(call, outcome, orbit, increment, kernel, maps[:, :, 1 : 1 + call.n])


def _functions(system: System, free: tuple[int, ...]) -> tuple[int, ...] | None:
    """Where the kernels are that are needed, 0 for others; None where some of them are not compiled."""
    rows = address_of(system, "linearise", free)
    needed = {"move": bool(system.algebraics), "switch": bool(system.switches)}
    needed["switch_gradient"] = needed["switch"]
    found = [address_of(system, name) if there else 0 for name, there in needed.items()]
    functions = tuple(where for where in (rows, *found) if where is not None)
    return functions if len(functions) == len(_SYSTEM) else None


def _constrained(call: Call, constraint: ArclengthConstraint) -> list[Array]:
    """Give a constraint to a call; return the arrays that are to be kept meanwhile."""
    origin = constraint.origin
    names, arrays = list(_CONSTRAINT), [constraint.weighted, origin.nodes]
    if call.k:
        names += [f"origin_{name}" for name in _ORIGIN]
        arrays += [origin.node_rates, origin.knots, origin.knot_rates, origin.phases]
        arrays += [origin.grid.left, origin.grid.width]
    kept = [plain(array) for array in arrays]
    for name, array in zip(names, kept, strict=True):
        setattr(call, name, address(array))
    call.origin_parameter = origin.parameter[constraint.index]
    call.slope = constraint.direction.parameter / constraint.scale**2
    call.distance = constraint.distance
    return kept


def _laid_out(call: Call, guess: Orbit) -> tuple[Orbit, tuple[list[Array], list[Array]], Array]:
    """The orbit, which begins as the guess, parts of increment and kernel, and maps: where C writes them."""
    begun = (guess.nodes, guess.stages, guess.algebraic, guess.phases, guess.parameter)
    shapes = [array.shape for array in begun]
    own = _blocks(call, _FOUND, shapes)
    for array, value in zip(own, begun, strict=True):
        array[...] = value
    change = [*shapes[:3], (call.k + 1,)]
    maps, *parts = _blocks(call, _SOLVED, [(call.count + 1, call.n, 2 + call.n + call.k), *change, *change])
    nodes, stages, algebraic, phases, parameter = own
    orbit = Orbit(guess.mesh, nodes, stages, algebraic, phases, parameter, layout=guess.layout)
    return orbit, (parts[:4], parts[4:]), maps


def _blocks(call: Call, names: Sequence[str], shapes: Sequence[tuple[int, ...]]) -> list[Array]:
    """Arrays of some shapes, one after the other in memory, their addresses given to a call."""
    sizes = [math.prod(shape) for shape in shapes]
    block = np.empty(sum(sizes))
    begin, arrays, first = address(block), [], 0
    for name, shape, size in zip(names, shapes, sizes, strict=True):
        setattr(call, name, begin + 8 * first)
        arrays.append(block[first : first + size].reshape(shape))
        first += size
    return arrays


def _change(orbit: Orbit, parts: list[Array]) -> Increment:
    """Increment of an orbit from its parts."""
    nodes, stages, algebraic, outer = parts
    k = len(orbit.phases)
    return Increment.of(orbit, nodes, stages, algebraic, outer[:k], outer[k:])


_meshes: WeakKeyDictionary[Mesh, tuple[Call, Sequence[Any]]] = WeakKeyDictionary()


def _of_mesh(mesh: Mesh) -> tuple[Call, Sequence[Any]]:
    """A call with what belongs to a mesh and its scheme, and the arrays that it has addresses of."""
    if mesh not in _meshes:
        segment, left, width = mesh.segments
        marks = (segment, mesh.starts, [event.switch for event in mesh.events], mesh.exact_ends)
        numbers = (left, width, *mesh.gradients, np.array([event.level for event in mesh.events]))
        scheme = mesh.scheme
        of_scheme = (scheme.points, scheme.differentiation, scheme.end, scheme.barycentric)
        kept: list[Any] = [np.array(mark, dtype=np.intp) for mark in marks]
        kept += map(plain, (*numbers, *of_scheme))
        call = Call(count=mesh.ntst, ncol=scheme.ncol, k=len(mesh.events), exact=len(mesh.exact_ends))
        for name, array in zip((*_MARKS, *_MESH, *_SCHEME), kept, strict=True):
            setattr(call, name, address(array))
        call.period, call.growth = mesh.period, GROWTH
        _meshes[mesh] = call, kept
    return _meshes[mesh]


@cache
def _routine(library: ctypes.CDLL) -> Callable[[int], int]:
    function = library.newton
    function.argtypes, function.restype = [ctypes.c_void_p], ctypes.c_int
    run: Callable[[int], int] = function
    return run
