"""Whether an import name is this project's, or another's that has taken its place.

This file stands in `periodic`, in `symbolic` and beside the command line, each time the same: a package whose
neighbour has been written over cannot ask that neighbour.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

MARK = b'version("orbitrace")'
"""What stands in the `__init__.py` of both packages and in no other project's."""

REINSTALL = "`pip install --force-reinstall --no-deps orbitrace`"


def foreign(name: str) -> str:
    """Return a sentence about another project's package of this name; empty if ours or none is there.

    Parameters
    ----------
    name : str
        A package of this project. It is looked up as an import would, and not imported.

    Returns
    -------
    str
        Where the other one is, and what to do.
    """
    loaded = sys.modules.get(name)
    found = getattr(loaded, "__spec__", None) if loaded is not None else find_spec(name)
    file = None if found is None else found.origin
    if file is not None and Path(file).is_file() and MARK in Path(file).read_bytes():
        return ""
    if found is None:
        return ""
    where = file or next(iter(found.submodule_search_locations or ()), "?")
    if {"site-packages", "dist-packages"} & set(Path(where).parts):
        return f"{name} is another project's ({where!r}); `pip uninstall {name}`, then {REINSTALL}"
    return f"{name} is not orbitrace's but {where!r}; rename that, or keep it off Python's path"
