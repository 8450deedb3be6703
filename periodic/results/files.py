"""Files that are complete or not there, and the digest by which their content is verified."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a place to write to that becomes `path` in one move when the block ends without an error.

    Parameters
    ----------
    path : Path
        The file to make or to replace; a link stays a link. Folders are made.

    Yields
    ------
    Path
        Where to write.

    Raises
    ------
    OSError
        Where it cannot be written; what was there stays.
    """
    path = path.resolve()
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def digest(*parts: bytes) -> str:
    """Return the SHA-256 of some bytes, lengths and order of the parts included.

    Parameters
    ----------
    *parts : bytes
        The bytes.

    Returns
    -------
    str
        In hexadecimal.
    """
    found = hashlib.sha256()
    for part in parts:
        found.update(len(part).to_bytes(8, "big") + part)
    return found.hexdigest()
