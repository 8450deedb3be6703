"""Time steps of split systems in C (`timestepping.c`), for systems whose kernels are compiled."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.heldjoints import Joint, stopping_sets
from periodic.condensed.timestep import Step
from periodic.orbit.native.addresses import address, library_of, plain, routine
from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.system import ModesLike, System, address_of
from periodic.system.precision import CONVERGED, MOST_ITERATIONS

_SOURCE = "periodic.condensed.native:timestepping.c"

_SIZES = (
    "n",
    "m",
    "s",
    "f",
    "o",
    "modes",
    "columns",
    "switches",
    "parameters",
    "joints",
    "sets",
    "most",
    "pivots",
)
_STATES = ("places", "forces", "own")
_JOINTS = ("slides", "guard", "up", "down", "column", "row", "place", "stopping")
_KERNELS = {
    "rows": "linearise",
    "beside": "linearise_beside",
    "move": "move",
    "switch_values": "switch",
    "switch_slopes": "switch_gradient",
    "guards": "guards",
    "guard_slopes": "guards_gradient",
}
_MOVED = ("state", "unknown", "side", "z", "parts")
_WIDTH = ("grown", "kicked", "local")


_FULL = 4
"""What `period` answers where its steps are more than there is room for."""


class _Motion(ctypes.Structure):
    """`struct motion` of timestepping.c."""

    _fields_ = (
        *((name, ctypes.c_ssize_t) for name in _SIZES),
        *((name, ctypes.c_void_p) for name in (*_STATES, *_JOINTS, *_KERNELS, "parameter", "outputs")),
        *((name, ctypes.c_void_p) for name in (*_MOVED, *_WIDTH, "work")),
        ("width", ctypes.c_double),
        ("converged", ctypes.c_double),
    )


class _Period(ctypes.Structure):
    """`struct period` of timestepping.c."""

    _fields_ = (
        *((name, ctypes.c_ssize_t) for name in ("steps", "levels", "divided", "room")),
        *((name, ctypes.c_void_p) for name in ("widths", *_WIDTH)),
        *((name, ctypes.c_void_p) for name in ("phases", "states", "unknowns", "sides", "kept")),
        *((name, ctypes.c_double) for name in ("begin", "length", "before")),
        ("count", ctypes.c_ssize_t),
    )


@dataclass(frozen=True)
class Path:
    """A period in K steps: phases (K+1,), states, unknowns and the surfaces' modes; the width of the last."""

    phases: Array
    states: Array
    unknowns: Array
    sides: Array
    width: float


class MotionLike(Protocol):
    """What C is given of a motion; see `periodic.condensed.timestepping.Motion`.

    places, forces, own: the linear part's states, forces among the unknowns, own states; sliders: row and
    place of those, by column.
    """

    system: System
    parameter: Array
    state: Array
    unknown: Array
    modes: ModesLike
    side: Array
    places: list[int]
    forces: list[int]
    own: NDArray[np.int_]
    joints: list[Joint]
    sliders: dict[int, tuple[int, int]]


@dataclass
class NativeSteps:
    """Steps in C: where they begin is in `moved`, which they overwrite with where they end.

    moved: states (n,), unknowns (m,), modes of the surfaces (columns,), modal coordinates (J,) and fractions
    of jumps (columns,), NaN where no joint sticks.
    """

    library: ctypes.CDLL
    call: _Motion
    moved: Mapping[str, NDArray[Any]]
    kept: Sequence[Any]

    def period(self, steps: int, divided: int, levels: Sequence[Step], begin: float, before: float) -> Path:
        """Take a period of steps from a phase, each into so many of the next level where a mode changes.

        before: width of the step before. Raises FloatingPointError where no modes are consistent.
        """
        call, room = self.call, 4 * steps
        outcome = _FULL
        begun = {name: value.copy() for name, value in self.moved.items()}
        while outcome == _FULL:
            for name, value in begun.items():
                self.moved[name][...] = value
            sizes = (), (call.n,), (call.m,), (call.columns,)
            found = [np.empty((room + 1, *size)) for size in sizes]
            moving = call.n + call.m + 2 * call.columns + 2 * call.modes
            each: list[NDArray[Any]] = [np.array([level.width for level in levels])]
            each += [np.array([level.grown for level in levels], dtype=np.complex128)]
            each += [np.array([level.kicked for level in levels], dtype=np.complex128)]
            each += [np.array([level.local for level in levels], dtype=float)]
            arrays = *each, *found, np.empty((len(levels), moving))
            own = _Period(steps, len(levels), divided, room, *map(address, arrays), begin, FORCED, before)
            outcome = routine(self.library, "period", 2)(ctypes.addressof(call), ctypes.addressof(own))
            room *= 4
        if outcome:
            raise FloatingPointError("a motion in time is not finite, or no modes are consistent")
        phases, states, unknowns, sides = (each[: own.count + 1] for each in found)
        return Path(phases, states, unknowns, sides, own.before)


def native_steps(motion: MotionLike, pivots: int) -> NativeSteps | None:
    """Return steps of a motion in C; None where NumPy must be used. pivots: most changes of a mode."""
    system, joints, modes = motion.system, motion.joints, motion.modes
    library, functions = library_of(system, _SOURCE), _functions(system)
    stopping = stopping_sets(system, joints)
    if library is None or functions is None or stopping is None:
        return None
    n, m, columns, J = len(motion.state), len(motion.unknown), len(motion.side), len(modes.exponents)
    states, switches, parameters = motion.places, len(system.switches), len(motion.parameter)
    sizes = n, m, len(states), len(motion.forces), len(motion.own), J, columns, switches, parameters
    call = _Motion(*sizes, len(joints), stopping.shape[1], MOST_ITERATIONS, pivots, converged=CONVERGED)
    rows, most = n + m, n + m + columns
    room = rows * (3 + 2 * n + m + columns) + columns + switches * (2 + n + parameters) + 3 * n + 2 * m
    room += len(states) + 2 * most + most * (most + 1)
    moved = {
        "state": np.zeros(n),
        "unknown": np.zeros(m),
        "side": np.zeros(columns),
        "z": np.zeros(J, dtype=np.complex128),
        "parts": np.zeros(columns),
    }
    kept: list[Any] = [np.array(each, dtype=np.intp) for each in (states, motion.forces, motion.own)]
    kept += [
        *_joints(motion),
        stopping,
        plain(motion.parameter),
        np.array(modes.outputs, dtype=np.complex128),
        np.zeros(room),
    ]
    names = (*_STATES, *_JOINTS, "parameter", "outputs", "work")
    for name, array in (*zip(names, kept, strict=True), *moved.items()):
        setattr(call, name, address(array))
    for name, where in functions.items():
        setattr(call, name, where)
    return NativeSteps(library, call, moved, kept)


def _joints(motion: MotionLike) -> list[NDArray[np.intp]]:
    """What C knows of the joints, each column by itself."""
    rows = [
        (j.slides, j.switch, j.up, j.down, j.column, *motion.sliders.get(j.column, (0, 0)))
        for j in motion.joints
    ]
    table = np.array(rows, dtype=np.intp).reshape(len(rows), len(_JOINTS) - 1)
    return [np.ascontiguousarray(column) for column in table.T]


def _functions(system: System) -> dict[str, int] | None:
    """Addresses of the kernels that are needed; None where one is not compiled."""
    depend = getattr(system, "guards_depend", False)
    needed = ["rows", "beside", *(["move"] if system.algebraics else [])]
    needed += ("guards", "guard_slopes") if depend else ("switch_values", "switch_slopes")
    found = {name: address_of(system, _KERNELS[name], ()) for name in needed}
    functions = {name: where for name, where in found.items() if where is not None}
    return functions if len(functions) == len(needed) else None
