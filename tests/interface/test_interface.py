"""The public interface is the one written down, and what is built once is not changed afterwards."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from pathlib import Path

import pytest

import symbolic as sym
from interface.refusals import parts, refusals, settings
from interface.scenes import scene
from interface.text import PACKAGES, interface

CHANGED = {
    "symbolic": {
        *("Assembly", "Excitation", "State", "Unknown", "Motion", "Place", "Workbench", "Follower"),
        *("Counted", "ChosenKernel", "Junction", "_Reduced", "Sketch", "_Lines"),
    },
    "periodic": {
        *("_Pieces", "NativeSteps", "Motion", "_Oscillating", "_Border", "_Pair", "_Grazing", "_Peak"),
        *("Work", "_Known", "Execution", "Run", "Continuation", "ReturnMap", "Transient", "Start"),
        *("Foresight", "_Way", "_Ranges", "March", "Draft", "Tiling"),
        *("Count", "Follow", "_Search", "Known", "Settling", "Stages", "Sorted", "OneWay"),
    },
}
"""The dataclasses that change as they are used: those of all others are values."""


def dataclasses_of(package: str) -> Iterator[type]:
    """Every dataclass that a package defines."""
    root = importlib.import_module(package)
    for found in pkgutil.walk_packages(root.__path__, f"{package}."):
        for value in vars(importlib.import_module(found.name)).values():
            own = inspect.isclass(value) and value.__module__ == found.name
            if own and "__dataclass_params__" in vars(value):
                yield value


@pytest.mark.parametrize("package", PACKAGES)
def test_interface_is_the_one_written_down(package: str) -> None:
    """Assert that no name, default or bound has changed (`PYTHONPATH=tests python -m interface`)."""
    written = Path(__file__).with_name(f"{package}.txt").read_text("utf-8")
    assert interface(package).splitlines() == written.splitlines()


@pytest.mark.parametrize("package", PACKAGES)
def test_values_are_frozen(package: str) -> None:
    """Assert that only what has a state can be changed."""
    every = dataclasses_of(package)
    found = {made.__name__ for made in every if not vars(made)["__dataclass_params__"].frozen}
    assert found == CHANGED[package]


def written(kind: str, name: str) -> list[str]:
    """The lines of a file about one object."""
    lines, found = Path(__file__).with_name(f"{kind}.txt").read_text("utf-8").splitlines(), list[str]()
    own = False
    for line in lines:
        own = line.startswith(f"{name}.") or (own and line.startswith(" "))
        found += [line] if own else []
    return found


@pytest.mark.parametrize("name", sorted(settings()))
def test_settings_take_and_refuse_what_is_written_down(name: str) -> None:
    """Assert which values each field takes, and the sentence for each of the others."""
    assert list(refusals(name, settings()[name])) == written("settings", name)


@pytest.mark.parametrize("name", sorted(parts()))
def test_parts_take_and_refuse_what_is_written_down(name: str) -> None:
    """Assert which values each field takes, and the sentence for each of the others."""
    assert list(refusals(name, parts()[name])) == written("parts", name)


@pytest.mark.parametrize("name", sym.scene_names())
def test_scenes_are_what_is_written_down(name: str) -> None:
    """Assert quantities, rest, switches and drawing of each scene of the package, to 6 digits."""
    lines = Path(__file__).with_name("scenes.txt").read_text("utf-8").splitlines()
    begin = lines.index(f"[{name}]") + 1
    end = next((k for k in range(begin, len(lines)) if lines[k].startswith("[")), len(lines))
    assert list(scene(name)) == lines[begin:end]
