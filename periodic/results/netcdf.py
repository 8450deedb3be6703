"""Branches on disk: one NetCDF file per branch, orbits as ragged arrays, names and units as attributes.

Dimensions: point, parameter, output, state; and the ragged ones of `periodic.results.ragged`. Loading reads
numbers and strings only.
"""

from __future__ import annotations

import io
import json
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from periodic.results.brancharrays import DAMAGE, FORMAT, attributes, record_of, tables
from periodic.results.files import digest, replacing
from periodic.results.record import Record

if TYPE_CHECKING:
    import xarray as xr  # takes longer to import than all else

SEAL = b"orbitrace sha256"
"""Stands before the digest at the end of a file: what does not agree with it is not read any further."""

SLACK = 100_000
"""Bytes that texts may take more in memory than in a file; numbers are not packed."""


class BranchFileError(ValueError):
    """A file that is not a readable branch; the message says what is wrong with it."""


def save(record: Record, path: Path) -> None:
    """Write a branch; an existing file is replaced only when the new one is complete.

    The file is made in memory first: the HDF5 library does not survive a disk that fills up under it.

    Parameters
    ----------
    record : Record
        The branch.
    path : Path
        The file.

    Raises
    ------
    BranchFileError
        Where there is something that is no ordinary file.
    OSError
        Where it cannot be written.
    """
    if path.exists() and not path.is_file():
        raise BranchFileError(
            f"branch file is {str(path.resolve())!r}, which is no ordinary file; choose another"
        )
    data = dataset(record)
    data.attrs["checksum"] = checksum(data)
    content = packed(data)
    with replacing(path) as part:
        part.write_bytes(content)


def load(path: Path) -> Record:
    """Read a branch.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    Record
        The branch.

    Raises
    ------
    BranchFileError
        If the file is missing, damaged, of another format or no branch.
    """
    if not path.is_file():
        raise BranchFileError(f"branch file is {str(path)!r}; there is no such file")
    try:
        if not sound(path.read_bytes()):
            raise BranchFileError(f"branch file {str(path)!r} is damaged (its seal is wrong)")
        return _read(path)
    except BranchFileError:
        raise
    except (OSError, *DAMAGE) as error:
        raise BranchFileError(f"branch file {str(path)!r} is damaged or not a branch") from error


def _read(path: Path) -> Record:
    import h5py
    import xarray as xr

    with h5py.File(path, "r"):
        pass  # on a file that is none h5netcdf complains from its destructor, where nobody can catch it
    with xr.open_dataset(path, engine="h5netcdf", decode_times=False, phony_dims="access") as data:
        if data.attrs.get("format") != FORMAT:
            raise BranchFileError(
                f"branch file {str(path)!r} has format {data.attrs.get('format')!r}; expected {FORMAT!r}"
            )
        if data.nbytes > path.stat().st_size + SLACK:
            raise BranchFileError(f"branch file {str(path)!r} is damaged (it is too short for its arrays)")
        if data.attrs.pop("checksum", None) != checksum(data.load()):
            raise BranchFileError(f"branch file {str(path)!r} is damaged (its checksum is wrong)")
        return record_of({str(name): data[name].values for name in data.variables}, data.attrs)


def packed(data: xr.Dataset) -> bytes:
    """Return the bytes of a NetCDF file, sealed.

    Of no scheduler's making: where a client of dask.distributed is connected xarray would ask it for a lock,
    even for a file in memory.
    """
    memory = io.BytesIO()
    alone = nullcontext() if "dask" not in sys.modules else sys.modules["dask"].config.set(scheduler="sync")
    with alone:
        data.to_netcdf(memory, engine="h5netcdf")
    return sealed(memory.getvalue())


def sealed(content: bytes) -> bytes:
    """Return the bytes of a file followed by their digest, which readers of HDF5 pass over."""
    return content + SEAL + digest(content).encode()


def sound(content: bytes) -> bool:
    """Whether the bytes of a file are those that were sealed, or never were: other tools leave no seal."""
    length = len(SEAL) + len(digest())
    body, seal = content[:-length], content[-length:]
    return not seal.startswith(SEAL) or seal == SEAL + digest(body).encode()


def checksum(data: xr.Dataset) -> str:
    """Return the digest of all variables and attributes, by name."""
    parts = [json.dumps({k: _text(v) for k, v in sorted(data.attrs.items())}).encode()]
    for name in sorted(map(str, data.variables)):
        values = data[name].values
        numeric = values.dtype.kind in "biuf"
        content = values.astype(float).tobytes() if numeric else repr(values.tolist()).encode()
        parts += [f"{name} {values.shape}".encode(), content]
    return digest(*parts)


def _text(value: object) -> str:
    """A value as text, whatever NumPy's printing is set to."""
    return str(value.item() if isinstance(value, np.generic) else value)


def dataset(record: Record) -> xr.Dataset:
    """Return the arrays and attributes of a branch file as an xarray Dataset."""
    import xarray as xr

    return xr.Dataset(tables(record), attrs=attributes(record))
