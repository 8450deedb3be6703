"""The four discs of the paper, their systems and traced branches, made once."""

from __future__ import annotations

from functools import cache

import periodic
import symbolic as sym
from reports.build import build
from reports.scene import load
from reports.view import RPM

LUBRICATED = ("vitrea79-810N", "vitrea79-2100N", "turbo33-810N", "turbo33-2100N")
"""The paper's lubricants and preloads."""


DENSE = periodic.Accuracy.STANDARD.settings(periodic.StepSettings(ds_max=0.1))
"""Points of branches lie close enough for splines through them."""


@cache
def system(name: str, *overrides: tuple[str, str]) -> sym.CompiledSystem:
    """Return the system of a built-in scene with some of its keys changed."""
    return build(load(name, overrides))


@cache
def branch(
    name: str,
    begin: float = 500.0,
    end: float = 100.0,
    at: tuple[float, ...] = (),
    overrides: tuple[tuple[str, str], ...] = (),
) -> periodic.Branch:
    """Return the branch of a built-in scene between two speeds in rev/min, with points `at` some."""
    low, high = sorted((begin, end))
    return periodic.trace(
        system(name, *overrides),
        "speed",
        (low * RPM, high * RPM),
        start=begin * RPM,
        at=[value * RPM for value in at],
        settings=DENSE,
    )
