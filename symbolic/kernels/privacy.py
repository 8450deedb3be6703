"""Whether a place is this user's alone: what is loaded from there runs as this user."""

from __future__ import annotations

import os
import stat
from pathlib import Path

OTHERS = stat.S_IWGRP | stat.S_IWOTH
"""Modes with which somebody else can write."""


def owners_known() -> bool:
    """Return whether the system tells owners and modes."""
    return hasattr(os, "getuid")


def exposed(folder: Path) -> str:
    """Return why others can put something into a folder or in its place; "" where they cannot.

    Parameters
    ----------
    folder : Path
        A directory without links in its path.

    Returns
    -------
    str
        The directory at fault and what is wrong with it.

    Raises
    ------
    OSError
        Where one of them cannot be looked at.

    Notes
    -----
    The folder is this user's and nobody else can write to it. Those above are this user's or the
    superuser's; where others can write, the sticky bit keeps them from what is not theirs.
    """
    own = folder.stat()
    if own.st_uid != os.getuid():
        return f"{str(folder)!r} belongs to another user"
    if own.st_mode & OTHERS:
        return f"others can write to {str(folder)!r} (mode {stat.S_IMODE(own.st_mode):o})"
    for above in folder.parents:
        found = above.stat()
        if found.st_uid not in (0, os.getuid()):
            return f"{str(above)!r} belongs to another user"
        if found.st_mode & OTHERS and not found.st_mode & stat.S_ISVTX:
            return f"others can write to {str(above)!r} (mode {stat.S_IMODE(found.st_mode):o})"
    return ""


def own_bytes(path: Path) -> bytes | None:
    """Return the bytes of a file that this user alone can write; None for any other, and for a link.

    Raises OSError where it cannot be read.
    """
    flags = os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW
    with os.fdopen(os.open(path, flags), "rb") as file:
        found = os.fstat(file.fileno())
        sound = stat.S_ISREG(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & OTHERS
        return file.read(found.st_size) if sound else None
