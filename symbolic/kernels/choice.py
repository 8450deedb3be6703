"""Which back end evaluates a kernel: generated NumPy code, which needs no compiler, or C.

AUTO takes C where the compiled library is in the cache. Else it takes NumPy until C would have saved the
time that compiling takes. It counts calls and looks at no clock, so that the change comes at the same call
in every run. One evaluation by either back end agrees with the other's to rounding, so that branches agree
within the tolerance: steps may end elsewhere. Results are the same bit for bit from run to run with NUMPY or
C, with AUTO where the cache holds the same kernels.
"""

from __future__ import annotations

import ctypes
import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np

from symbolic.arrays import Array
from symbolic.kernels import native

Run = Callable[..., None]

SAVED = 0.25e-6
"""Seconds that C saves for each instruction of a call; per point both take the same time."""

ITERATION = 1.5e-4
"""... and for each call where with this kernel the whole Newton iteration runs in C."""

COMPILER, STATEMENT = 0.08, 0.5e-3
"""Seconds that compiling costs: for each library, and for each instruction."""

VARIABLE = "ORBITRACE_KERNELS"
"""The environment's choice, where the program makes none."""

_Address = ctypes.c_char * 0
_FLOAT = np.dtype(float)


PROBE = "int probe;\n"
"""A source that every working compiler takes."""


class Kernels(Enum):
    """The back end of a system's kernels."""

    AUTO = "auto"
    NUMPY = "numpy"
    C = "c"


def chosen(kernels: Kernels | str | None) -> Kernels:
    """Return the back end asked for; without one, that of the environment's ORBITRACE_KERNELS, else AUTO.

    Raises ValueError for another word, symbolic.CompilerError for C without a
    working compiler.
    """
    given = (os.environ.get(VARIABLE) or "auto").strip()
    where, value = ("kernels", kernels) if kernels is not None else (VARIABLE, given)
    try:
        found = Kernels(value)
    except ValueError:
        raise ValueError(f"{where} is {value!r}; it must be auto, numpy or c") from None
    if found is Kernels.C:
        native.library(PROBE)
    return found


def shared(source: str, kernels: Kernels) -> ctypes.CDLL | None:
    """Return the library of a C source that every run needs, or None where NumPy must be used.

    AUTO compiles it at once if it can be kept: later runs have it for nothing. Where a cache is not used
    because others can write to it, this run alone has it.
    """
    if kernels is Kernels.NUMPY:
        return None
    if kernels is Kernels.C:
        return native.library(source)
    if native.directory() is None and not native.refused():
        return native.kept(source)
    return native.attempted(source)


@dataclass(frozen=True)
class Layout:
    """Shape of an array that C takes: (points, *tail), or `tail` where it is the same at every point."""

    tail: tuple[int, ...]
    shared: bool = False


@dataclass(eq=False)
class ChosenKernel:
    """A kernel of either back end. Arrays that C does not take as they are go to NumPy's.

    `numpy` makes the NumPy kernel; layouts are those of arguments and results, the last `results` of them.
    iterated: whether where it is compiled whole iterations run in C.
    """

    source: str
    instructions: int
    layouts: Sequence[Layout]
    results: int
    kernels: Kernels
    numpy: Callable[[], Run]
    iterated: bool = False
    _calls: int = field(default=0, init=False)
    _compiled: Run | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        found = native.library(self.source) if self.kernels is Kernels.C else native.kept(self.source)
        self._compiled = self._function(found)

    def __call__(self, *arrays: Array) -> None:
        if self._compiled is None:
            self._count()
        given = None if self._compiled is None else self._addresses(arrays)
        if given is None or self._compiled is None:
            self._numpy(*arrays)
        else:
            self._compiled(len(arrays[-1]), *given)

    @property
    def compiled(self) -> bool:
        """Whether C runs."""
        return self._compiled is not None

    def address(self, wanted: bool = False) -> int | None:
        """Where C's function is, compiled now if it is `wanted`; None where NumPy runs."""
        if self._compiled is None and wanted:
            self._compiled = self._function(native.attempted(self.source))
        function: Any = self._compiled
        return None if function is None else ctypes.cast(function, ctypes.c_void_p).value

    @cached_property
    def _numpy(self) -> Run:
        return self.numpy()

    @property
    def pays(self) -> int:
        """Number of calls after which compiling has paid."""
        saved = SAVED * self.instructions + (ITERATION if self.iterated else 0.0)
        return math.ceil((COMPILER + STATEMENT * self.instructions) / saved)

    def _count(self) -> None:
        """Count a call, and compile once compiling has paid; it is tried a single time."""
        self._calls += 1
        if self._calls == self.pays:
            self._compiled = self._function(native.attempted(self.source))

    def _function(self, found: ctypes.CDLL | None) -> Run | None:
        if found is None:
            return None
        function = found.kernel
        function.restype = None
        function.argtypes = [ctypes.c_ssize_t, *[ctypes.c_void_p] * len(self.layouts)]
        run: Run = function
        return run

    def _addresses(self, arrays: Sequence[Array]) -> list[ctypes.Array[ctypes.c_char]] | None:
        """The arrays as C takes them, or None where it cannot."""
        points, last = len(arrays[-1]), len(arrays) - self.results
        addresses = []
        for k, (array, layout) in enumerate(zip(arrays, self.layouts, strict=True)):
            ready = array.dtype == _FLOAT and array.flags.carray
            if not ready and k < last:
                array, ready = np.array(array, dtype=float, order="C"), True
            if not ready or array.shape != (layout.tail if layout.shared else (points, *layout.tail)):
                return None
            addresses.append(_Address.from_buffer(array.data))
        return addresses
