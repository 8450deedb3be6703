"""Libraries that a wheel brings along, so that what every system shares needs no compiler.

Their files are named after their sources: a library of another source is not found. Only the standard
library is imported here: the build reads this file too.
"""

from __future__ import annotations

import ctypes
import hashlib
import logging
import os
from pathlib import Path

FLAGS = ("-O2", "-fPIC", "-shared", "-ffp-contract=off", "-fno-math-errno")
"""No option among them changes a result: no fast mathematics, no fused multiply-add."""

FOLDER = Path(__file__).parent / "libraries"
"""Where a wheel has them; there is none in a checkout."""

_log = logging.getLogger(__name__)


def file_name(source: str) -> str:
    """Return the name of the file of a source's library."""
    digest = hashlib.sha256(source.encode()).hexdigest()[:32]
    return f"{digest}.{'dll' if os.name == 'nt' else 'so'}"


def built(source: str) -> ctypes.CDLL | None:
    """Return the library of a C source that came with the package; None without one that loads."""
    path = FOLDER / file_name(source)
    if not path.is_file():
        return None
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:  # built for another machine
        _log.debug("%s is not used: %s", path, error)
        return None
