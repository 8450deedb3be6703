"""Numbers that are defined once keep to the words beside them: parts are less than the whole."""

from __future__ import annotations

import ast
import importlib
import pkgutil
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np

from interface.text import PACKAGES
from periodic.correction import tolerance
from periodic.events import thresholds

LESS_THAN_ONE = re.compile(
    r"\b(parts? of (?!intervals)|in parts|part that|as a part|relative(ly)?|residual|cosine|coupling of|"
    r"ratios?\b|reciprocal|peaks? to peak|peak-to-peak|differences?\b|errors? (of|to which)|local increment|"
    r"times the (length|norm)|singular values?|excursions? (below|up)|least (width|"
    r"size|slope|distance|arclength)|width \(rad\)|distance (of|\(rad\)|from|in)|"
    r"multipliers? (so near|nearer|as near)|added to the derivative|counts as|so near|"
    r"is rounding|are rounding|finest tolerance)",
    re.IGNORECASE,
)
"""Words for a number that is compared with 1."""

COUNTED = re.compile(
    r"\b(how many|many times|most|factor on|roundings|magnitude|modulus|condition of|lengths of|"
    r"variations|estimate)\b",
    re.IGNORECASE,
)
"""Words for a number of something, which may be any."""

NEGATIVE = {"OUT", "LOWEST_LOG", "EMPTY"}
"""What stands below all samples, and two logarithms."""


def modules(package: str) -> Iterator[ModuleType]:
    """Every module of a package."""
    for found in pkgutil.walk_packages(importlib.import_module(package).__path__, f"{package}."):
        yield importlib.import_module(found.name)


def documented(module: ModuleType) -> Iterator[tuple[str, float, str]]:
    """The numbers that a module names and describes: name, value, words."""
    statements = ast.parse(Path(str(module.__file__)).read_text("utf-8")).body
    for statement, words in zip(statements, statements[1:], strict=False):
        match statement, words:
            case ast.Assign(targets=[target]), ast.Expr(ast.Constant(str() as text)):
                for name in (node.id for node in ast.walk(target) if isinstance(node, ast.Name)):
                    value = getattr(module, name)
                    if isinstance(value, int | float) and not isinstance(value, bool):
                        yield name, value, text


@cache
def constants() -> list[tuple[str, float, str]]:
    """The described numbers of both packages."""
    return [
        (f"{module.__name__}.{name}", value, words)
        for package in PACKAGES
        for module in modules(package)
        for name, value, words in documented(module)
    ]


def test_numbers_are_positive() -> None:
    """Assert it of bounds, counts, sizes and parts, but for what stands for less than any."""
    low = {name.rpartition(".")[2] for name, value, _ in constants() if value < 0}
    assert len(constants()) > 300 and low == NEGATIVE


def test_parts_are_less_than_the_whole() -> None:
    """Assert that what is said to be a part, a step of differences or a relative error is below 1."""
    parts = [each for each in constants() if LESS_THAN_ONE.search(each[2]) and not COUNTED.search(each[2])]
    assert len(parts) > 100
    assert not [each for each in parts if not each[1] < 1]


def test_thresholds_of_events_are_in_order() -> None:
    """Assert rounding, what is at its level and what coincides, one above the other; so of lengths."""
    levels = (thresholds.NOISE, thresholds.RELEASED, thresholds.AT_LEVEL, thresholds.TOGETHER)
    lengths = (
        *(thresholds.SAME_PHASE, thresholds.LEAST_CROSSING, thresholds.AT_EXTREMUM, thresholds.LEAST_GRAZING),
        *(thresholds.BESIDE_EXTREMUM, thresholds.SLOW_CROSSING, thresholds.SHALLOW, thresholds.VANISHING),
    )
    for each in (levels, lengths):
        assert sorted(each) == list(each) and each[0] > 0 and each[-1] < 1


def test_bounds_of_tolerances() -> None:
    """Assert that they leave many digits between them, all above rounding."""
    assert 1e3 * np.finfo(float).eps < tolerance.FINEST < 1e-6 * tolerance.COARSEST < 1e-7
