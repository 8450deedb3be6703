"""NetCDF files that anybody may have made, read within bounds.

What a file of HDF5 declares is looked at before any of it is read: arrays that it has no bytes for, links and
arrays that lead into other files, and filters that would load a library are refused.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from periodic.results.guarded import DamagedError

if TYPE_CHECKING:
    import xarray as xr

SLACK = 100_000
"""Bytes that texts may take more in memory than in a file; numbers are not packed."""

NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable"
"""How the name of a dimension's scale begins that is no variable."""

FILTERS = {1, 2, 3}
"""Deflate, shuffle and Fletcher's checksum: those that the HDF5 library has in itself."""


@contextmanager
def opened(held: bytes) -> Iterator[xr.Dataset]:
    """Give the data set of a file's bytes, not loaded yet.

    Parameters
    ----------
    held : bytes
        The file.

    Yields
    ------
    Dataset
        Its variables, as they are written.

    Raises
    ------
    DamagedError
        For a file that declares more than it holds or leads out of itself.
    Exception
        What h5py and xarray raise for what is no such file.
    """
    import h5py
    import xarray as xr

    # On a file that is none h5netcdf complains from its destructor, where nobody can catch it.
    with h5py.File(io.BytesIO(held), "r") as file:
        _check(file, len(held) + SLACK)
    asked: dict[str, Any] = {"decode_times": False, "phony_dims": "access"}
    with xr.open_dataset(io.BytesIO(held), engine="h5netcdf", **asked) as data:
        yield data


def _check(file: Any, most: int) -> None:
    """Refuse a file that is not of plain arrays, or of arrays and attributes of more than so many bytes."""
    import h5py

    size = _said(file.attrs)
    for name in file:
        if not isinstance(file.get(name, getlink=True), h5py.HardLink):
            raise DamagedError("it leads into other files")
        array = file[name]
        if not isinstance(array, h5py.Dataset):
            raise DamagedError("it has what is no array")
        made = array.id.get_create_plist()
        if array.is_virtual or made.get_external_count():
            raise DamagedError("it leads into other files")
        if not {made.get_filter(k)[0] for k in range(made.get_nfilters())} <= FILTERS:
            raise DamagedError("it is compressed in a way that needs another library")
        size += _said(array.attrs) + (0 if _length_only(array) else _bytes(array))
        if size > most:
            raise DamagedError("it is too short for its arrays")


def _bytes(array: Any) -> int:
    """How many bytes an array takes in memory."""
    return int(math.prod(array.shape or ()) * array.dtype.itemsize)


def _length_only(array: Any) -> bool:
    """Whether an array is netCDF's mark of a dimension's length: it has no data, and is not read."""
    name = array.attrs.get("NAME", b"")
    return isinstance(name, bytes) and name.startswith(NO_VARIABLE) and not array.id.get_storage_size()


def _said(attributes: Any) -> int:
    """How many bytes attributes declare."""
    found = [attributes.get_id(name) for name in attributes]
    return sum(math.prod(each.shape) * each.dtype.itemsize for each in found)
