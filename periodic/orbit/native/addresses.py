"""Arrays and sources as C takes them, and functions of C as Python calls them."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from periodic.orbit.scheme import Array
from periodic.system import System, compiling

_Address = ctypes.c_char * 0
_FLOAT = np.dtype(float)


def address(array: Any) -> int:
    """Return where a writeable, contiguous array begins."""
    return ctypes.addressof(_Address.from_buffer(array))


def plain(array: Array) -> Array:
    """Return an array of doubles that C takes: itself where it is one."""
    flags = array.flags
    if flags.carray and array.dtype == _FLOAT:
        return array
    found = np.ascontiguousarray(array, dtype=float)
    return found if found.flags.writeable else found.copy()


@cache
def source(*files: str) -> str:
    """Return C sources as one, each given as folder:name, after what all begin with."""
    both = (name.split(":") for name in ("periodic.orbit.native:linear.c", *files))
    return "".join(resources.files(folder).joinpath(name).read_text() for folder, name in both)


def library_of(system: System, *files: str) -> ctypes.CDLL | None:
    """Return the loaded library of some C sources, see `source`; None where NumPy must be used."""
    with_compiler = compiling(system)
    return None if with_compiler is None else with_compiler.library(source(*files))


@cache
def routine(library: ctypes.CDLL, name: str, arguments: int = 1) -> Callable[..., int]:
    """Return a function of a library, of the addresses of what it takes."""
    function = getattr(library, name)
    function.argtypes, function.restype = [ctypes.c_void_p] * arguments, ctypes.c_int
    run: Callable[..., int] = function
    return run
