"""Holds what is computed anew against what a page was made from, each number as far as it is known."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

from reports.studies.pages.page import Page

NUMBER = re.compile(r"-?\d+\.?\d*(?:e[-+]?\d+)?")

TIME = math.inf
"""Accuracy of what depends on the machine and on what else it does: it need only be there."""


def assert_fresh(page: Page, name: str, accuracy: Mapping[str, float], close: float = 1e-6) -> None:
    """Assert that a section computed whole has the numbers, the rows and the figures of the page."""
    found, kept = page.sections[name].compute(lambda _: None), page.kept(page.folder)[name]
    again = found.kept()
    assert not list(differences(again.numbers, kept.numbers, accuracy, close))
    assert not list(differences(again.rows, kept.rows, accuracy, close))
    text = page.told(name, kept)
    assert found.figures and all(f"(figures/{figure}.png)" in text for figure in found.figures)


def differences(
    found: Any, kept: Any, accuracy: Mapping[str, float], close: float, at: str = ""
) -> Iterator[str]:
    """Yield, in words, where kept data are not what was found.

    accuracy: the largest relative difference of the numbers whose place (names and indices along the data,
    as "rows/0/swing") a pattern is found in, the first that is; `close` for all others. Numbers in a text
    count as numbers, and its words must be the same.
    """
    if isinstance(found, Mapping) and isinstance(kept, Mapping):
        if list(found) != list(kept):
            yield f"{at}: has {list(found)}, kept are {list(kept)}"
            return
        for name, value in found.items():
            yield from differences(value, kept[name], accuracy, close, f"{at}/{name}")
    elif isinstance(found, list | tuple) and isinstance(kept, list | tuple):
        if len(found) != len(kept):
            yield f"{at}: has {len(found)} entries, kept are {len(kept)}"
            return
        for index, (value, other) in enumerate(zip(found, kept, strict=True)):
            yield from differences(value, other, accuracy, close, f"{at}/{index}")
    else:
        allowed = next((most for pattern, most in accuracy.items() if re.search(pattern, at)), close)
        if not alike(found, kept, allowed):
            yield f"{at}: is {found!r}, kept is {kept!r}, allowed {allowed:g}"


def alike(found: Any, kept: Any, allowed: float) -> bool:
    """Return whether two values are one, numbers within a relative difference."""
    if isinstance(found, str) and isinstance(kept, str):
        numbers = zip(NUMBER.findall(found), NUMBER.findall(kept), strict=False)
        same = NUMBER.sub("#", found) == NUMBER.sub("#", kept)
        return same and all(alike(float(one), float(other), allowed) for one, other in numbers)
    if isinstance(found, bool) or isinstance(kept, bool) or found is None or kept is None:
        return found is kept
    if not (isinstance(found, int | float) and isinstance(kept, int | float)):
        return False
    return found == kept or abs(found - kept) <= allowed * max(abs(found), abs(kept))
