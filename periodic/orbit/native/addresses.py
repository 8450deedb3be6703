"""Arrays and sources as C takes them."""

from __future__ import annotations

import ctypes
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from periodic.orbit.scheme import Array

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
