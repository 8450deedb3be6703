"""How far long work is: a bar in a notebook or on a terminal, once it takes longer than a second."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

VARIABLE = "ORBITRACE_PROGRESS"
"""Environment variable, 0 or 1: whether bars are shown, on whatever output."""

DELAY = 1.0
"""Seconds before anything is shown."""

EVERY = 0.1
"""Seconds from one showing to the next."""

_SHOWN = ContextVar("shown", default=False)
"""Whether a bar is shown already: work within it has no bar of its own."""

Advance = Callable[[int, str], None]
"""Called with the number of steps since the last call, and a text about the last of them."""


def watched() -> bool:
    """Return whether bars can be seen: in a notebook, or where standard error is a terminal."""
    setting = os.environ.get(VARIABLE, "").strip()
    return setting != "0" if setting else "ipykernel" in sys.modules or sys.stderr.isatty()


@contextmanager
def meter(what: str, unit: str, total: int | None = None) -> Iterator[Advance]:
    """Show a bar and yield the function that advances it; without a display it does nothing.

    Parameters
    ----------
    what : str
        What is done.
    unit : str
        What is counted.
    total : int, optional
        How many there will be.

    Yields
    ------
    callable
        Takes a number of steps, and a text about the last of them.
    """
    if _SHOWN.get() or not watched():
        yield lambda steps, said: None
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a notebook without widgets gets a bar of text
        from tqdm.auto import tqdm
    shown = _SHOWN.set(True)
    with tqdm(total=total, desc=what, unit=f" {unit}", delay=DELAY, mininterval=EVERY, leave=False) as bar:

        def advance(steps: int, said: str) -> None:
            bar.set_postfix_str(said, refresh=False)
            bar.update(steps)

        try:
            yield advance
        finally:
            _SHOWN.reset(shown)
