"""A C compiler, which serves the engine too."""

from __future__ import annotations

import ctypes
from typing import Protocol, cast

from periodic.system.equations import System


class Compiling(System, Protocol):
    """A system with a C compiler, which then serves the engine too: its small systems are solved in C."""

    def library(self, source: str) -> ctypes.CDLL | None:
        """The loaded library of a C source, the same one each time; None where NumPy must be used."""

    def address(self, kernel: str, free: tuple[int, ...] = ()) -> int | None:
        """The address of a method in C: of linearise or linearise_beside (in the parameters `free`), move,
        switch, switch_gradient, guards, guards_gradient or output.

        The guards are the switches on given sides of the jumps, the last argument as in `linearise_beside`.
        Each is a function of the number of points, then of arguments and results in order, as contiguous
        arrays; of the results structural nonzeros alone are written. None where NumPy must be used. A system
        that has `library` may be without it.
        """


def compiling(system: System) -> Compiling | None:
    """Return the system as one with a compiler, if it has one."""
    return cast(Compiling, system) if hasattr(system, "library") else None


def address_of(system: System, kernel: str, free: tuple[int, ...] = ()) -> int | None:
    """Return where a system's compiled kernel is, see `Compiling`; None where NumPy must be used."""
    return cast(Compiling, system).address(kernel, free) if hasattr(system, "address") else None
