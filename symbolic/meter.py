"""A bar of how far long work is, in a notebook or on a terminal, once it takes longer than a second."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterator

VARIABLE = "ORBITRACE_PROGRESS"
"""The environment's choice, 0 or 1, in the place of whether somebody looks on."""

DELAY = 1.0
"""Seconds before anything is shown."""


def watched() -> bool:
    """Return whether somebody looks on."""
    setting = os.environ.get(VARIABLE, "").strip()
    return setting != "0" if setting else "ipykernel" in sys.modules or sys.stderr.isatty()


def counted(total: int, what: str, unit: str) -> Iterator[int]:
    """Yield the numbers below a total, with a bar where somebody looks on."""
    if not watched():
        yield from range(total)
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a notebook without widgets gets a bar of text
        from tqdm.auto import tqdm
    yield from tqdm(range(total), desc=what, unit=f" {unit}", delay=DELAY, leave=False)
