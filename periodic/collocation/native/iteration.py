"""Newton's iteration of small systems in one call of C (`newton.c`), where their kernels are compiled.

It takes orbits on arclength constraints of systems without impacts and sliding. Where it does not come
through (a singular matrix, a step to be damped, event nodes that cross) it returns None: NumPy does it all.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from periodic.collocation.native.elimination import ELIMINATION
from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.condition import SideCondition
from periodic.correction.newton import Correction, Linearised, NewtonSettings
from periodic.correction.outcome import Outcome
from periodic.linear.bordering import GROWTH
from periodic.linear.unknowns import Increment
from periodic.orbit.mesh import Mesh
from periodic.orbit.native.arrays import address, plain, source
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.system import System, address_of, compiling, jumps_of, resets_of

MOST = 16
"""Number of states up to which it is worth its while."""

_SIZES = ("count", "ncol", "n", "m", "k", "parameters", "switches", "exact", "free", "most")
_MARKS = ("segment", "starts", "switch_of", "ends")
_MESH = ("left", "width", "left_gradient", "width_gradient", "levels")
_SCHEME = ("points", "differentiation", "end", "weights")
_SYSTEM = ("rows", "move", "switch_values", "switch_slopes")
_CONSTRAINT = ("weighted", "origin_nodes")
_ORIGIN = ("node_rates", "knots", "knot_rates", "phases", "left", "width")
_FOUND = ("nodes", "stages", "algebraic", "phases", "parameter", "maps")
_CHANGES = tuple(f"{of}_{part}" for of in ("step", "kernel") for part in (*_FOUND[:3], "outer"))
_SETTINGS = ("period", "nominal", "tolerance", "close", "max_change", "narrow", "negligible", "growth")
_NUMBERS = (*_SETTINGS, "origin_parameter", "slope", "distance", "residual", "size", "length")

_GIVEN = (*_MARKS, *_MESH, *_SCHEME, *_SYSTEM, *_CONSTRAINT, *(f"origin_{name}" for name in _ORIGIN))
_ADDRESSES = (*_GIVEN, *_FOUND, *_CHANGES)


class Call(ctypes.Structure):
    """`struct call` of newton.c."""

    _fields_ = (
        *((name, ctypes.c_ssize_t) for name in _SIZES),
        *((name, ctypes.c_void_p) for name in _ADDRESSES),
        *((name, ctypes.c_double) for name in _NUMBERS),
        ("iterations", ctypes.c_ssize_t),
    )


class _Held(NamedTuple):
    """Addresses by field, and the arrays that they are those of."""

    addresses: dict[str, int]
    arrays: Sequence[Any]


@dataclass(frozen=True)
class _Solved:
    """What a call has found: the orbit, the last increment, the kernel, the affine maps."""

    call: Call
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
    ended = (
        Outcome.CONVERGED,
        int(call.iterations),
        call.size,
        call.residual,
        found.fundamental,
        found.kernel,
    )
    return Correction(found.orbit, *ended)


def linearised(
    system: System,
    orbit: Orbit,
    free: tuple[int, ...],
    conditions: Sequence[SideCondition],
    settings: NewtonSettings,
) -> Linearised | None:
    """Return what `periodic.correction.newton.linearised` does, or None."""
    found = _called(system, orbit, free, conditions, settings, 0)
    return None if found is None else Linearised(orbit, found.increment, found.fundamental)


def _called(
    system: System,
    guess: Orbit,
    free: tuple[int, ...],
    conditions: Sequence[SideCondition],
    settings: NewtonSettings,
    most: int,
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
    call, kept = _given(system, guess, constraint, settings)
    call.free, call.most = free[0], most
    for name, where in zip(_SYSTEM, functions, strict=True):
        setattr(call, name, where)
    orbit, parts, maps = _laid_out(call, guess)
    if _routine(library)(ctypes.addressof(call)) != 0:
        return None
    del kept
    n = guess.nodes.shape[1]
    increment, kernel = (_change(orbit, part) for part in parts)
    return _Solved(call, orbit, increment, kernel, maps[:, :, 1 : 1 + n])


def _functions(system: System, free: tuple[int, ...]) -> tuple[int, ...] | None:
    """Where the kernels are that are needed, 0 for others; None where some of them are not compiled."""
    rows = address_of(system, "linearise", free)
    needed = {"move": bool(system.algebraics), "switch": bool(system.switches)}
    needed["switch_gradient"] = needed["switch"]
    found = [address_of(system, name) if there else 0 for name, there in needed.items()]
    functions = tuple(where for where in (rows, *found) if where is not None)
    return functions if len(functions) == len(_SYSTEM) else None


def _given(
    system: System, guess: Orbit, constraint: ArclengthConstraint, settings: NewtonSettings
) -> tuple[Call, list[Array]]:
    """What goes in but the orbit itself, and the arrays that are to be kept meanwhile."""
    (count, ncol, n), origin = guess.stages.shape, constraint.origin
    call = Call(
        count,
        ncol,
        n,
        guess.algebraic.shape[2],
        len(guess.phases),
        len(guess.parameter),
        len(system.switches),
    )
    mesh, scheme = _of_mesh(guess.mesh), _of_scheme(guess.mesh.scheme)
    call.exact = len(guess.mesh.exact_ends)
    for held in (mesh, scheme):
        for name, where in held.addresses.items():
            setattr(call, name, where)
    arrays = [plain(constraint.weighted), plain(origin.nodes)]
    call.weighted, call.origin_nodes = map(address, arrays)
    if len(guess.phases):
        moving = (
            origin.node_rates,
            origin.knots,
            origin.knot_rates,
            origin.phases,
            origin.grid.left,
            origin.grid.width,
        )
        for name, array in zip(_ORIGIN, map(plain, moving), strict=True):
            setattr(call, f"origin_{name}", address(array))
            arrays.append(array)
    call.period, call.growth = guess.mesh.period, GROWTH
    call.nominal = max(abs(system.nominal[constraint.index]), settings.tiny)
    call.tolerance, call.close, call.max_change = settings.tolerance, settings.close, settings.max_change
    call.narrow, call.negligible = settings.short, settings.negligible
    call.origin_parameter = origin.parameter[constraint.index]
    call.slope = constraint.direction.parameter / constraint.scale**2
    call.distance = constraint.distance
    return call, arrays


def _laid_out(call: Call, guess: Orbit) -> tuple[Orbit, tuple[list[Array], list[Array]], Array]:
    """The orbit, which begins as the guess, parts of increment and kernel, and maps: where C writes them."""
    begun = (guess.nodes, guess.stages, guess.algebraic, guess.phases, guess.parameter)
    width = 2 + call.n + call.k
    shapes = [array.shape for array in begun]
    change = [*shapes[:3], (call.k + 1,)]
    shapes += [(call.count + 1, call.n, width), *change, *change]
    block = np.empty(sum(map(_product, shapes)))
    begin, arrays, first = address(block), [], 0
    for name, shape in zip((*_FOUND, *_CHANGES), shapes, strict=True):
        size = _product(shape)
        setattr(call, name, begin + 8 * first)
        arrays.append(block[first : first + size].reshape(shape))
        first += size
    for array, value in zip(arrays, begun, strict=False):
        array[...] = value
    nodes, stages, algebraic, phases, parameter, maps, *parts = arrays
    moved = replace(
        guess, nodes=nodes, stages=stages, algebraic=algebraic, phases=phases, parameter=parameter
    )
    return moved, (parts[:4], parts[4:]), maps


def _change(orbit: Orbit, parts: list[Array]) -> Increment:
    """Increment of an orbit from its parts."""
    nodes, stages, algebraic, outer = parts
    k = len(orbit.phases)
    return Increment.of(orbit, nodes, stages, algebraic, outer[:k], outer[k:])


_meshes: WeakKeyDictionary[Mesh, _Held] = WeakKeyDictionary()


def _of_mesh(mesh: Mesh) -> _Held:
    """The fields of a mesh."""
    if mesh not in _meshes:
        segment, left, width = mesh.segments
        marks = (segment, mesh.starts, [event.switch for event in mesh.events], mesh.exact_ends)
        numbers = (left, width, *mesh.gradients, np.array([event.level for event in mesh.events]))
        arrays = (*(np.array(mark, dtype=np.intp) for mark in marks), *map(plain, numbers))
        _meshes[mesh] = _held((*_MARKS, *_MESH), arrays)
    return _meshes[mesh]


@cache
def _of_scheme(scheme: Scheme) -> _Held:
    """The fields of a scheme."""
    arrays = (scheme.points, scheme.differentiation, scheme.end, scheme.barycentric)
    return _held(_SCHEME, [plain(array) for array in arrays])


def _held(names: tuple[str, ...], arrays: Sequence[Any]) -> _Held:
    return _Held(dict(zip(names, map(address, arrays), strict=True)), arrays)


def _product(shape: tuple[int, ...]) -> int:
    size = 1
    for length in shape:
        size *= length
    return size


@cache
def _routine(library: ctypes.CDLL) -> Callable[[int], int]:
    function = library.newton
    function.argtypes, function.restype = [ctypes.c_void_p], ctypes.c_int
    run: Callable[[int], int] = function
    return run
