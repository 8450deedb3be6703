"""What this machine has of what the numbers depend on."""

from __future__ import annotations

import os
import platform
import re
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, metadata, requires, version
from pathlib import Path

Facts = dict[str, dict[str, str]]
"""Groups of names and what there is to say of them."""

VARIABLES = ("ORBITRACE_KERNELS", "CC", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Environment variables that change how fast something runs, never what it finds to the tolerance."""


def facts() -> Facts:
    """Return what there is: versions, packages and extras, compiler, threads, environment."""
    return {
        "system": _system(),
        "packages": {name: _version(name) for name in ("orbitrace", *_needed(""))},
        "extras": {extra: _extra(extra) for extra in _extras()},
        "C": _compiling(),
        "threads": _threads(),
        "environment": {name: os.environ[name] for name in VARIABLES if name in os.environ},
    }


def _system() -> dict[str, str]:
    import periodic

    return {
        "python": f"{platform.python_version()} ({sys.executable})",
        "platform": platform.platform(),
        "orbitrace in": str(Path(periodic.__file__).parents[1]),
    }


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "missing"


def _needed(extra: str) -> Iterator[str]:
    """The packages that orbitrace needs, or an extra of it adds, each extra that it names taken apart."""
    for line in requires("orbitrace") or ():
        wanted, _, marker = line.partition(";")
        of = re.search(r"extra\s*==\s*['\"]([\w-]+)['\"]", marker)
        name = re.split(r"[\s\[<>=!~;]", wanted.strip())[0]
        if (of[1] if of else "") == extra and name != "orbitrace":
            yield name


def _extras() -> list[str]:
    """The extras for users: what is for development has more than half a dozen packages or others' names."""
    known = metadata("orbitrace").get_all("Provides-Extra") or []
    return [extra for extra in known if extra not in ("dev", "docs", "peers")]


def _extra(extra: str) -> str:
    return ", ".join(f"{name} {_version(name)}" for name in _needed(extra))


def _compiling() -> dict[str, str]:
    """The compiler, where its libraries are kept, and whether what it makes runs."""
    from symbolic.kernels import native
    from symbolic.kernels.built import FOLDER
    from symbolic.kernels.choice import PROBE

    known, where = native.compiler(), native.directory()
    brought = {"came with the package": ", ".join(p.name for p in FOLDER.glob("*")) or "no library"}
    if known is None:
        return {"compiler": f"none: equations run in NumPy ({native.NONE})", **brought}
    try:
        native.library(PROBE)
        works = "yes"
    except native.CompilerError as error:
        works = f"no: {error}"
    command, said = known
    return {
        "compiler": f"{' '.join(command)}: {said.strip().splitlines()[0]}",
        "makes libraries": works,
        **brought,
        "kept in": str(where) if where else f"nowhere: {native.refused() or 'no directory can be made'}",
    }


def _threads() -> dict[str, str]:
    """The cores that this process may use, and what BLAS makes of them."""
    import numpy  # noqa: F401 - their BLAS is looked at
    import scipy.linalg  # noqa: F401
    from threadpoolctl import threadpool_info

    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    found = {"cores": f"{usable} of {os.cpu_count()}"}
    for pool in threadpool_info():
        of = Path(pool["filepath"]).parent.name.removesuffix(".libs")
        kind = pool.get("architecture", "")
        found[f"{pool['user_api']} of {of}"] = (
            f"{pool['internal_api']} {pool['version'] or ''} {kind}, {pool['num_threads']} threads".strip()
        )
    return found
