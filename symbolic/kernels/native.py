"""C source becomes a loaded library, kept in a cache of the user's for later runs.

A library's file name holds a hash of all it is made from (source, compiler, flags, machine) and one of its
own bytes: what is truncated, changed or foreign is not loaded but made again. Nothing is loaded that another
user can write or put something in the place of: a cache where that is so is told once and not used.
"""

from __future__ import annotations

import contextlib
import ctypes
import hashlib
import logging
import os
import platform
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import platformdirs

from symbolic.kernels.built import FLAGS, built
from symbolic.kernels.privacy import exposed, own_bytes, owners_known

KEPT = 500
"""How many libraries are kept, of some 20 kB each; the ones longest unused go first."""

LONGEST_WAIT = 120.0
"""Seconds after which the compiler is stopped."""

NONE = "no C compiler was found; install one (pip install 'orbitrace[cc]'), or set CC to its command"
"""What is said without a compiler."""

_log = logging.getLogger(__name__)
_loaded: dict[str, ctypes.CDLL] = {}
_failed: set[str] = set()
_told: set[str] = set()


class CompilerError(RuntimeError):
    """There is no C compiler, or it did not make a library that loads; the message says which."""


def kept(source: str) -> ctypes.CDLL | None:
    """Return the library of a source if it was made before: with the package, in this run or another."""
    if source not in _loaded:
        found = built(source)
        if found is None and compiler() is not None:
            found = _from_cache(_key(source))
        if found is not None:
            _loaded[source] = found
    return _loaded.get(source)


def library(source: str) -> ctypes.CDLL:
    """Return the library of a C source, compiled if it is not kept. Raises CompilerError."""
    if (found := kept(source)) is None:
        found = _loaded[source] = _made(source)
    return found


def attempted(source: str) -> ctypes.CDLL | None:
    """Return the library of a C source, or None without a compiler or, with one warning, where it fails."""
    if source in _failed or (compiler() is None and kept(source) is None):
        return None
    try:
        return library(source)
    except CompilerError as error:
        _failed.add(source)
        _log.warning("NumPy does what C would do: %s", error)
        return None


def forget() -> None:
    """Forget all libraries of this run, as a new one begins without."""
    _loaded.clear()
    _failed.clear()
    _told.clear()


@cache
def compiler() -> tuple[tuple[str, ...], str] | None:
    """Return the C compiler's command and version, or None without a compiler.

    The environment's CC if it names one, else cc, gcc, clang, the one that Python was built with, or the one
    of the package ziglang.
    """
    asked_for = os.environ.get("CC")
    names = (asked_for,) if asked_for else ("cc", "gcc", "clang", sysconfig.get_config_var("CC"), packaged())
    for name in filter(None, names):
        try:
            command = shlex.split(name)
        except ValueError:  # a quotation that does not end
            continue
        if not command or shutil.which(command[0]) is None:
            continue
        asked = [*command, "--version"]
        try:
            said = subprocess.run(asked, capture_output=True, text=True, errors="replace", timeout=10)
        except (OSError, subprocess.TimeoutExpired):  # not one that runs here: the next may be
            continue
        if said.returncode == 0:
            return tuple(command), said.stdout
    return None


def packaged() -> str | None:
    """Return the command of the compiler that the package ziglang brings, if it is installed."""
    return f"{shlex.quote(sys.executable)} -m ziglang cc" if find_spec("ziglang") else None


def directory() -> Path | None:
    """Return the directory of kept libraries, made if need be; None where there is no safe one.

    One that others can write to is told once.
    """
    path, why = _place()
    if why and why not in _told:
        _told.add(why)
        _log.warning("kernels are compiled for this run alone, not kept in %r: %s", str(path), why)
    return None if why else path


def refused() -> str:
    """Return why the directory of kept libraries is not used, where others can write to it; else ""."""
    return _place()[1]


def _place() -> tuple[Path | None, str]:
    """The directory of kept libraries if there can be one, and why it is not used."""
    if not owners_known():
        return None, ""
    try:
        path = platformdirs.user_cache_path("orbitrace", appauthor=False) / "kernels"
        path.parent.parent.mkdir(parents=True, exist_ok=True)
        for each in (path.parent, path):  # of folders above `parents=True` takes no mode
            each.mkdir(mode=0o700, exist_ok=True)
        return path.resolve(), exposed(path.resolve())
    except (OSError, RuntimeError) as error:  # read-only, or a user without a home
        _log.debug("no cache of kernels: %s", error)
        return None, ""


def _key(source: str) -> str:
    known = compiler()
    assert known is not None
    command, version = known
    parts = (source, *command, version, *FLAGS, platform.machine(), platform.system(), *platform.libc_ver())
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:32]


def _from_cache(key: str) -> ctypes.CDLL | None:
    for path in _files(key):
        try:
            content = own_bytes(path)
            if content is not None and path.stem == f"{key}-{_digest(content)}":
                found = ctypes.CDLL(str(path))
                _touch(path)
                return found
        except OSError as error:  # unreadable, gone meanwhile, or of a machine that only looks like this one
            _log.debug("%s is not used: %s", path, error)
    return None


def _files(key: str) -> Iterator[Path]:
    where = directory()
    return iter(()) if where is None else where.glob(f"{key}-*.so")


def _touch(path: Path) -> None:
    """Say that a library is in use, where the cache can be written."""
    with contextlib.suppress(OSError):
        os.utime(path)


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:32]


def _made(source: str) -> ctypes.CDLL:
    """Compile in a directory of our own, load from there, and keep the file for later runs."""
    known, where = compiler(), directory()
    if known is None:
        raise CompilerError(NONE)
    if where is not None and not os.access(where, os.W_OK):
        where = None
    command, *options = known[0]
    try:
        with tempfile.TemporaryDirectory(dir=where, ignore_cleanup_errors=True) as made:
            _check_temporary(Path(made).resolve())
            here, there = Path(made, "kernel.c"), Path(made, "kernel.so")
            here.write_text(source)
            asked = [command, *options, *FLAGS, "-o", str(there), str(here), "-lm"]
            done = subprocess.run(
                asked, capture_output=True, text=True, errors="replace", timeout=LONGEST_WAIT
            )
            if done.returncode != 0:
                raise CompilerError(f"{command} failed: {done.stderr.strip()[:500]}")
            found = ctypes.CDLL(str(there))
            if where is not None:
                _keep(_key(source), there, where)
            return found
    except (OSError, subprocess.TimeoutExpired) as error:
        raise CompilerError(f"{command} did not make a library that loads: {error}") from error


def _check_temporary(folder: Path) -> None:
    """Refuse to load from a temporary directory that others can change. Raises CompilerError."""
    if owners_known() and (why := exposed(folder)):
        raise CompilerError(f"there is no safe place to compile in: {why}; set TMPDIR to one of your own")


def _keep(key: str, library: Path, where: Path) -> None:
    """Move a library into the cache, in one piece, and drop the oldest beyond KEPT."""
    try:
        for stale in where.glob(f"{key}-*.so"):
            stale.unlink(missing_ok=True)
        library.chmod(0o600)
        os.replace(library, where / f"{key}-{_digest(library.read_bytes())}.so")
        by_age = sorted(where.glob("*.so"), key=lambda path: path.stat().st_mtime)
        for old in by_age[:-KEPT]:
            old.unlink(missing_ok=True)
    except OSError as error:  # full, or another process is tidying up
        _log.debug("the kernel is not kept: %s", error)
