"""Many motions of a system at some parameters, followed in C; by `Flow` one by one without a compiler."""

from __future__ import annotations

import ctypes
import math
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symbolic.arrays import Array
from symbolic.equations.surfaces import Kind
from symbolic.integration.cvodes import IntegrationError
from symbolic.integration.ensembles.source import source
from symbolic.integration.modes import Guard, Modes, Switched, Switching
from symbolic.interrupts import interruptible

LONGEST = math.pi / 16
"""Longest step (rad) between two looks at guards."""

STEPS, EVENTS = 20_000, 2_000
"""Most steps and most events in a stretch."""

ONE = threading.Lock()
"""CasADi may be called by one thread at a time."""

OTHER = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_double, *[ctypes.c_void_p] * 2, ctypes.c_int, *[ctypes.c_void_p] * 3
)
"""C's call of what it leaves to Python: see `Other` in follow.c."""


@dataclass(frozen=True, eq=False)
class Followed:
    """What became of S motions.

    Attributes
    ----------
    ends : ndarray, shape (S, w)
        The variables y = (x, z) at the end.
    modes : ndarray of int, shape (S, surfaces)
        The modes of the surfaces there.
    outcome : ndarray of int, shape (S,)
        0 followed, 1 work used up, 2 diverged, 3 events piled up, 4 lost.
    label : ndarray of int, shape (S,)
        At which target each arrived, -1 at none.
    sections : ndarray, shape (S, count + 1, w), or None
        y at the beginning and after each stretch; NaN where it was not reached.
    growth : ndarray, shape (S, count, tangents)
        Logarithm of how much the tangents, orthonormal before, grew in each stretch.
    tangents : ndarray, shape (S, tangents, w)
        The tangents at the end.
    changes : ndarray of int, shape (S, surfaces)
        How often the mode of each surface changed in the last stretch.
    """

    ends: Array
    modes: NDArray[np.intc]
    outcome: NDArray[np.intc]
    label: NDArray[np.intc]
    sections: Array | None
    growth: Array
    tangents: Array
    changes: NDArray[np.intc]


Targets = tuple[Array, Sequence[int], Array, float]
"""Places (A, n) at which motions end, whose each is (A,), units of the states (n,), and a radius in these."""


@dataclass(frozen=True, eq=False)
class Ensemble:
    """Motions of a system at some parameters.

    Parameters
    ----------
    system : Switched
        The system.
    parameter : ndarray, shape (p,)
        SI.
    tolerance : float
        Of the integration, relative and absolute, in scaled variables.
    largest : float
        States beyond it have diverged.
    library : ctypes.CDLL
        The loaded C of `source`.
    """

    system: Switched
    parameter: Array
    tolerance: float
    largest: float
    library: ctypes.CDLL

    @cached_property
    def width(self) -> int:
        """How many variables y = (x, z) has."""
        return int(self.system.field.y.numel())

    def begin(self, state: Array) -> Array:
        """Return y (S, w) of states (S, n) at phase 0: unknowns fulfil the constraints, NaN where none do."""
        unknowns = self.system.rest(self.parameter)[1]
        found = np.hstack([state, np.tile(unknowns, (len(state), 1))])
        for k, y in enumerate(found if len(unknowns) else ()):
            try:
                found[k] = self.system.field.begun(y, 0.0, self.parameter)
            except IntegrationError:
                found[k] = math.nan
        return found

    def tangents_at(self, y: Array) -> Array:
        """Return tangents (S, n, w) at y (S, w): one state changes by 1, unknowns as the constraints ask."""
        n = self.system.expressions.state.numel()
        found = np.tile(np.eye(n, self.width), (len(y), 1, 1))
        for k, row in enumerate(y if n < self.width else ()):
            slope = self.system.field.constraint_slope(row, 0.0, self.parameter)
            found[k, :, n:] = -np.linalg.lstsq(slope[:, n:], slope[:, :n], rcond=None)[0].T
        return found

    def run(
        self,
        start: Array,
        count: int,
        stretch: float,
        *,
        modes: NDArray[np.intc] | None = None,
        keep: bool = False,
        tangents: Array | None = None,
        raw: bool = False,
        targets: Targets | None = None,
    ) -> Followed:
        """Follow motions from y (S, w) at phase 0 over `count` stretches (rad).

        modes: those to begin with, (S, surfaces); by default as the states have them. keep: whether sections
        are. tangents: (S, k, w), made orthonormal after each stretch unless they are wanted `raw`. targets:
        places near which motions end, after two stretches one after the other.
        """
        y = np.ascontiguousarray(start, dtype=float).copy()
        many, width = y.shape
        surfaces = len(self.system.surfaces)
        own = np.zeros((many, max(surfaces, 1)), dtype=np.intc)
        if modes is not None:
            own[:, :surfaces] = modes
        w = np.zeros((many, 0, width)) if tangents is None else np.ascontiguousarray(tangents).copy()
        sections = np.empty((many, count + 1, width)) if keep else None
        growth = np.zeros((many, count, w.shape[1]))
        label, outcome = np.empty(many, dtype=np.intc), np.empty(many, dtype=np.intc)
        changes = np.zeros_like(own)
        places, whose, units, radius = targets or (np.zeros((0, 1)), (), np.ones(1), 0.0)
        places, of = np.ascontiguousarray(places, dtype=float), np.array(whose, dtype=np.intp)
        unit = np.ascontiguousarray(units, dtype=float)
        given = np.ascontiguousarray(self.parameter, dtype=float)
        raised: list[BaseException] = []
        callback = OTHER(partial(self._other, raised))
        with interruptible():
            failed = self._follow(
                many,
                count,
                stretch,
                _at(given),
                self.tolerance,
                self.largest,
                LONGEST,
                STEPS,
                EVENTS,
                w.shape[1],
                raw,
                not self._needs_python,
                not self._mixed,
                modes is not None,
                callback,
                _at(y),
                _at(own),
                _at(sections),
                _at(growth),
                _at(w),
                len(places),
                _at(places),
                _at(of),
                _at(unit),
                radius,
                _at(label),
                _at(outcome),
                _at(changes),
            )
        if failed:
            raise MemoryError(f"{many} motions with {w.shape[1]} tangents")
        if raised:
            raise raised[0]
        return Followed(y, own[:, :surfaces], outcome, label, sections, growth, w, changes[:, :surfaces])

    @cached_property
    def _needs_python(self) -> bool:
        """Whether modes and states at the beginning are more than the signs of guards."""
        plain = (Kind.KINK, Kind.JUMP, Kind.MARKER)
        walls = any(s.kind == Kind.IMPACT and s.leaves is not None for s in self.system.surfaces)
        return walls or any(s.kind not in (*plain, Kind.IMPACT) for s in self.system.surfaces)

    @cached_property
    def _mixed(self) -> bool:
        """Whether events need more than C has: sliders beside friction, impacts beside unknowns."""
        kinds = {s.kind for s in self.system.surfaces}
        unknowns = self.system.expressions.algebraic.numel() > 0
        return {Kind.SLIDING, Kind.SLIDER} <= kinds or Kind.IMPACT in kinds and unknowns

    @cached_property
    def _switching(self) -> Switching:
        return Switching(self.system, self.parameter, self.tolerance)

    def _other(self, raised: list[BaseException], *given: Any) -> int:
        """Begin a motion, or take it through an event; 0 where that fails, by what is `raised` if any."""
        try:
            with ONE:
                self._changed(*given)
        except IntegrationError:
            return 0
        except BaseException as error:  # C cannot carry it: it is raised after the call
            raised.append(error)
            return 0
        return 1

    def _changed(self, tau: float, y: int, mode: int, count: int, surface: int, at: int, sign: int) -> None:
        """Begin a motion, or take it through an event, as `Follower` does. Raises IntegrationError."""
        n, surfaces = self.system.expressions.state.numel(), len(self.system.surfaces)
        values, modes = _view(y, self.width, float), _view(mode, surfaces, np.intc)
        if count < 0:
            state, after = self._switching.begin(tau, values[:n])
        else:
            each = zip(*(_view(a, count, np.intc) for a in (surface, at, sign)), strict=True)
            fallen = [Guard(*map(int, one)) for one in each]
            before: Modes = tuple(int(k) for k in modes)
            state, after = self._switching.passed(fallen, before, tau, values[:n].copy())
        if not np.array_equal(state, values[:n]):
            whole = np.concatenate([state, values[n:]])
            values[:] = self.system.field.on_constraints(whole, tau, self.parameter)
        modes[:] = after

    @cached_property
    def _follow(self) -> Callable[..., int]:
        whole, real, array = ctypes.c_ssize_t, ctypes.c_double, ctypes.c_void_p
        call = self.library.follow
        call.argtypes = [whole, whole, real, array, real, real, real, *[whole] * 7, OTHER]
        call.argtypes += [*[array] * 5, whole, array, array, array, real, array, array, array]
        call.restype = ctypes.c_int
        found: Callable[..., int] = call
        return found


def _at(array: Any) -> int | None:
    return None if array is None or array.size == 0 else int(array.ctypes.data)


def _view(address: int, count: int, kind: Any) -> Any:
    """An array on memory of C's."""
    if not count:
        return np.zeros(0, dtype=kind)
    made = ctypes.c_double if kind is float else ctypes.c_int
    return np.ctypeslib.as_array((made * count).from_address(address))


def code(system: Switched) -> str:
    """Return the C of a system's motions. Raises ValueError where it cannot be integrated in time."""
    return source(system.field, system.surfaces)
