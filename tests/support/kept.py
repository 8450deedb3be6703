"""What several tests look at is computed once: within a process, and with `--keep` for later runs too.

The store is a folder of pickles in pytest's cache. A file's name is a hash of all that its content follows
from: every source of the packages and of the tests' helpers, the test's own module, versions of Python and of
the libraries, the compiler, the back end, the call. A changed engine thus never finds what another one made.
The target `test` asks for the store; mutants, whose sources change in memory, do without.
"""

from __future__ import annotations

import functools
import hashlib
import inspect
import os
import pickle
import platform
import shutil
import sys
import tempfile
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeVar

import cloudpickle

from symbolic.kernels import native

Computed = TypeVar("Computed", bound=Callable[..., Any])

ROOT = Path(__file__).resolve().parent.parent.parent
FOLDERS = ("symbolic", "periodic", "reports", "tests/support", "tests/reference")
LIBRARIES = ("casadi", "numpy", "scipy", "cloudpickle")

ENGINES = 3
"""Of how many engines results are kept; the ones longest unused go first."""

UNACCOUNTED: list[str] = []
"""What no labelled point accounts for on the branches that the test under way has traced or been given."""


class Store:
    """Where results are kept; nothing is read or written while it is shut, as it is at first."""

    folder: Path | None = None
    shut = False

    def open(self, folder: Path) -> None:
        """Keep results in a folder, in one of its own for this engine."""
        self.folder = folder / engine()
        self.folder.mkdir(parents=True, exist_ok=True)
        os.utime(self.folder)

    @staticmethod
    def tidy(folder: Path) -> None:
        """Drop the results of engines longest unused."""
        by_use = sorted(folder.iterdir(), key=lambda path: path.stat().st_mtime)
        for old in by_use[:-ENGINES]:
            shutil.rmtree(old)

    def path(self, *parts: str) -> Path | None:
        """Return the file of a call; None while the store is shut."""
        if self.folder is None or self.shut:
            return None
        return self.folder / hashlib.sha256("\0".join(parts).encode()).hexdigest()


STORE = Store()


def once(compute: Computed) -> Computed:
    """Let a function of hashable arguments compute each result once for a back end in this process."""
    known: dict[tuple[Any, ...], Any] = {}

    @functools.wraps(compute)
    def found(*args: Any, **kwargs: Any) -> Any:
        key = call(compute, args, kwargs)
        if key not in known:
            known[key] = compute(*args, **kwargs)
        return known[key]

    return found  # type: ignore[return-value]


def kept(compute: Computed) -> Computed:
    """Let such a function compute each result once, with the store for all processes.

    The arguments say in their `repr` what they are. A result that comes from the store brings along what the
    ledger of its branches left open, so that the test that first looks at it fails as if it had traced them.
    """

    @functools.wraps(compute)
    def found(*args: Any, **kwargs: Any) -> Any:
        said = repr(call(compute, args, kwargs))
        path = STORE.path(source(Path(inspect.getfile(compute))), compute.__qualname__, said)
        return compute(*args, **kwargs) if path is None else stored(path, compute, args, kwargs)

    return once(found)  # type: ignore[type-var]


def call(compute: Callable[..., Any], args: tuple[Any, ...], kwargs: dict[str, Any]) -> tuple[Any, ...]:
    """Return what tells one call from another: the back end and all arguments, defaults included."""
    bound = inspect.signature(compute).bind(*args, **kwargs)
    bound.apply_defaults()
    return os.environ.get("ORBITRACE_KERNELS"), *bound.arguments.values()


def stored(path: Path, compute: Callable[..., Any], args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
    """Return what a file holds; if there is none, compute it and write it in one move."""
    if path.is_file():
        value, gaps = pickle.loads(path.read_bytes())
        UNACCOUNTED.extend(gaps)
        return value
    before = len(UNACCOUNTED)
    value = compute(*args, **kwargs)
    content = cloudpickle.dumps((value, UNACCOUNTED[before:]))
    with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
        file.write(content)
    os.replace(file.name, path)
    return value


@functools.cache
def engine() -> str:
    """Return a hash of all sources that tests share, of versions and of the compiler."""
    digest = hashlib.sha256(f"{sys.version} {platform.machine()} {native.compiler()}".encode())
    digest.update("".join(f" {name} {version(name)}" for name in LIBRARIES).encode())
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                digest.update(f"{path.relative_to(ROOT)} {source(path)}".encode())
    return digest.hexdigest()[:32]


@functools.cache
def source(path: Path) -> str:
    """Return a hash of a file, as it was when first asked for."""
    return hashlib.sha256(path.read_bytes()).hexdigest()
