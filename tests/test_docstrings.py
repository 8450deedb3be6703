"""Public docstrings are in numpydoc form: those of all that `symbolic` and `periodic` name in `__all__`.

A member that a protocol prescribes is documented in full there; a class that has it says what its own does.
"""

from __future__ import annotations

import enum
import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from types import ModuleType
from typing import Any

import pytest
from numpydoc.validate import validate

PACKAGES = ("symbolic", "periodic")
CHECKS = {
    "GL06",  # unknown section
    "GL07",  # sections in another order than numpydoc's
    "GL08",  # no docstring
    "PR01",  # parameters not documented
    "PR02",  # parameters that there are not
    "PR03",  # parameters in another order
    "PR10",  # no space before the colon of a parameter
    "RT01",  # no Returns
    "YD01",  # no Yields
}
PRESENT = {"GL06", "GL07", "GL08"}
"""What remains of the checks where the signature is somebody else's: a base class's or a protocol's."""


def modules(package: str) -> Iterator[ModuleType]:
    """A package and all modules in it."""
    root = importlib.import_module(package)
    yield root
    for found in pkgutil.walk_packages(root.__path__, f"{package}."):
        yield importlib.import_module(found.name)


def is_protocol(value: Any) -> bool:
    """Whether a class is a protocol itself, not one that follows it."""
    return inspect.isclass(value) and bool(getattr(value, "_is_protocol", False))


def members(value: Any) -> list[str]:
    """Public methods and properties that a class defines; none of anything else."""
    kinds, fields = (property, staticmethod, classmethod), getattr(value, "__dataclass_fields__", {})
    defined = vars(value) if inspect.isclass(value) else {}
    named = {name: member for name, member in defined.items() if name[0] != "_" and name not in fields}
    return [name for name, member in named.items() if inspect.isfunction(member) or isinstance(member, kinds)]


def public(module: str) -> list[str]:
    """Dotted names of what a module exports, of its own making, with the members."""
    exported = importlib.import_module(module)
    found = []
    for name in exported.__all__:
        value, path = getattr(exported, name), f"{module}.{name}"
        if isinstance(value, ModuleType):
            found += public(value.__name__)
        elif str(getattr(value, "__module__", "")).startswith(PACKAGES):
            found += [path, *(f"{path}.{member}" for member in members(value))]
    return found


def protocols(package: str) -> set[Any]:
    """All protocols that a package defines."""
    every = {value for module in modules(package) for value in vars(module).values() if is_protocol(value)}
    return {value for value in every if value.__module__.startswith(PACKAGES)}


PROTOCOLS = [value for package in PACKAGES for value in protocols(package)]
NAMES = [path for package in PACKAGES for path in public(package)]


def prescribed(owner: Any, member: str) -> bool:
    """Whether a protocol that a class follows has the member."""
    if is_protocol(owner) or not inspect.isclass(owner):
        return False
    there = {*dir(owner), *getattr(owner, "__dataclass_fields__", ())}
    return any(member in members(value) and there.issuperset(members(value)) for value in PROTOCOLS)


def checks(path: str) -> set[str]:
    """The checks that a name has to pass."""
    value, (above, _, name) = pkgutil.resolve_name(path), path.rpartition(".")
    if inspect.isclass(value):
        foreign = is_protocol(value) or issubclass(value, (enum.Enum, BaseException))
    else:
        foreign = prescribed(pkgutil.resolve_name(above), name)
    return PRESENT if foreign else CHECKS


def faults(path: str) -> list[tuple[str, str]]:
    """What the checks find in the docstring of a name."""
    chosen = checks(path)
    return [(code, said) for code, said in validate(path)["errors"] if code in chosen]


@pytest.mark.parametrize("path", sorted(set(NAMES)))
def test_docstring(path: str) -> None:
    """Assert that a public name has a docstring with all its parameters and what it returns."""
    assert faults(path) == []
