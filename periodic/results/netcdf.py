"""Branches on disk: one NetCDF file per branch, orbits as ragged arrays, names and units as attributes.

Dimensions: point, parameter, output, state; and the ragged ones of `periodic.results.ragged`. Loading reads
numbers and strings only.
"""

from __future__ import annotations

import io
import json
import re
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from periodic.results.brancharrays import DAMAGE, FORMAT, attributes, record_of, tables
from periodic.results.files import digest, replacing
from periodic.results.guarded import DamagedError, content
from periodic.results.hdf import opened
from periodic.results.record import Record

if TYPE_CHECKING:
    import xarray as xr  # takes longer to import than all else

SEAL = b"orbitrace sha256"
"""Precedes the digest at the end of a file; a file that does not match its digest is not read."""

OURS = re.compile(r"orbitrace [a-z]{1,10} \d{1,5}")
"""Formats of this package, of any version."""

LARGEST = 2**32
"""Most bytes of a branch or map that is read: 4 GiB. Its arrays take no more than it has."""


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
    try:
        held = content(path, LARGEST)
    except FileNotFoundError:
        raise BranchFileError(f"branch file is {str(path)!r}; there is no such file") from None
    except OSError as error:
        raise BranchFileError(f"branch file is {str(path)!r}; it cannot be read ({error.strerror})") from None
    if not sound(held):
        raise BranchFileError(f"branch file {str(path)!r} is damaged (its seal is wrong)")
    try:
        with np.errstate(all="ignore"), opened(held) as data:
            _check_format(data.attrs.get("format"), path)
            return _read(data)
    except BranchFileError:
        raise
    except DamagedError as error:
        raise BranchFileError(f"branch file {str(path)!r} is damaged ({error})") from None
    except (OSError, *DAMAGE) as error:
        raise BranchFileError(f"branch file {str(path)!r} is damaged or not a branch") from error


def _check_format(found: object, path: Path) -> None:
    """Refuse another format than this version's, and name it only where it is one of this package."""
    if not (isinstance(found, str) and found == FORMAT):
        known = found if isinstance(found, str) and OURS.fullmatch(found) else None
        raise BranchFileError(f"branch file {str(path)!r} has format {known!r}; expected {FORMAT!r}")


def _read(data: xr.Dataset) -> Record:
    """The branch of a data set. Raises DamagedError, or one of DAMAGE."""
    if data.attrs.pop("checksum", None) != checksum(data.load()):
        raise DamagedError("its checksum is wrong")
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
    """Whether a file matches its seal, or has none, as files of other tools."""
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
