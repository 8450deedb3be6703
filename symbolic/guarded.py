"""Files that anybody may have made, read within bounds. The same text stands in both packages.

Only regular files are read, and none beyond a limit: pipes and devices may have no end. What a header
declares is held against what the file holds before anything is made of it. Nothing is unpickled. No message
quotes what a file holds.
"""

from __future__ import annotations

import errno
import io
import math
import os
import stat
import struct
import tokenize
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

LARGEST = 2**28
"""Most bytes that are read of a file, and that its arrays may take: 256 MiB."""

COMPRESSION = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
"""What NumPy writes. Other methods may ask for gigabytes before they give a byte."""

HEADERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}
"""Readers of the headers of NumPy's arrays, by version."""


DAMAGED = (
    *(zipfile.BadZipFile, zlib.error, struct.error, tokenize.TokenError),
    *(EOFError, LookupError, RuntimeError, SyntaxError, TypeError),
)
"""What is raised on what is no archive, besides ValueError: headers of arrays are written as Python."""


class DamagedError(ValueError):
    """A file that is not what it should be; the message says why, and nothing of what it holds."""


def content(path: Path, most: int = LARGEST) -> bytes:
    """Return the bytes of a regular file.

    Parameters
    ----------
    path : Path
        The file.
    most : int
        How many bytes it may have.

    Returns
    -------
    bytes
        Those that it has when it is opened.

    Raises
    ------
    OSError
        Where it cannot be read, is no regular file or larger; `strerror` says which.
    """
    try:
        regular(path.stat())
        # What lies there may be another file by now: opening must not wait for the other end of a pipe.
        flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
        with os.fdopen(os.open(path, flags), "rb") as file:
            size = regular(os.fstat(file.fileno()))
            if size > most:
                raise OSError(errno.EFBIG, f"it is larger than {most} bytes")
            return file.read(size)
    except ValueError as error:  # a name that no file can have
        raise OSError(errno.EINVAL, str(error)) from None


def regular(found: os.stat_result) -> int:
    """Return the size of a regular file. Raises OSError for a folder, a pipe, a device or a socket."""
    if stat.S_ISDIR(found.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not stat.S_ISREG(found.st_mode):
        raise OSError(errno.EINVAL, "it is no regular file")
    return found.st_size


def archive(held: bytes, most: int = LARGEST) -> dict[str, np.ndarray[Any, Any]]:
    """Return the arrays of what numpy.savez has written.

    Parameters
    ----------
    held : bytes
        The file.
    most : int
        How many bytes the arrays may take.

    Returns
    -------
    dict
        Arrays by name.

    Raises
    ------
    DamagedError
        For arrays that are larger than `most` or than the archive has bytes for, for arrays of objects, and
        for what is no archive.
    """
    try:
        return _members(held, most)
    except DAMAGED as error:
        raise DamagedError("it is no archive of arrays, or damaged") from error


def _members(held: bytes, most: int) -> dict[str, np.ndarray[Any, Any]]:
    """The arrays of an archive; what zipfile and NumPy raise is not caught."""
    found = {}
    with zipfile.ZipFile(io.BytesIO(held)) as members:
        if sum(member.file_size for member in members.infolist()) > most:
            raise DamagedError(f"its arrays take more than {most} bytes")
        for member in members.infolist():
            if member.compress_type not in COMPRESSION:
                raise DamagedError("it is compressed in a way that NumPy does not use")
            found[member.filename.removesuffix(".npy")] = _array(members.read(member))
    return found


def _array(held: bytes) -> np.ndarray[Any, Any]:
    """The array of one member of an archive, its header checked first."""
    file = io.BytesIO(held)
    reader = HEADERS.get(np.lib.format.read_magic(file))
    if reader is None:
        raise DamagedError("it has an array of an unknown version")
    shape, _, dtype = reader(file)
    if dtype.hasobject:
        raise DamagedError("it has an array of objects")
    if min(shape, default=0) < 0 or math.prod(shape) * dtype.itemsize > len(held):
        raise DamagedError("it declares an array that is larger than what it holds")
    file.seek(0)
    return np.lib.format.read_array(file, allow_pickle=False)
