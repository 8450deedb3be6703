"""How far long work is: a bar in a notebook or on a terminal, once it takes longer than a second."""

from __future__ import annotations

import os
import sys
import threading
import time
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

_SAY: ContextVar[Callable[[str], None] | None] = ContextVar("say", default=None)
"""Shows a text beside the bar that is shown."""

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
        silent = _SAY.set(None)
        try:
            yield lambda steps, said: None
        finally:
            _SAY.reset(silent)
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a notebook without widgets gets a bar of text
        from tqdm.auto import tqdm
    shown = _SHOWN.set(True)
    with tqdm(total=total, desc=what, unit=f" {unit}", delay=DELAY, mininterval=EVERY, leave=False) as bar:
        later = threading.Timer(DELAY, bar.refresh)  # what is said meanwhile may take minutes
        later.daemon = True
        begun = time.monotonic()

        def advance(steps: int, said: str) -> None:
            bar.set_postfix_str(said, refresh=False)
            bar.update(steps)

        def say(said: str) -> None:
            bar.set_postfix_str(said, refresh=time.monotonic() >= begun + DELAY)

        later.start()
        saying = _SAY.set(say)
        try:
            yield advance
        finally:
            later.cancel()
            later.join()
            _SAY.reset(saying)
            _SHOWN.reset(shown)


def say(text: str) -> None:
    """Say beside the bar that is shown, if there is one, what is being done until it goes on.

    Parameters
    ----------
    text : str
        What, in a few words.
    """
    shown = _SAY.get()
    if shown is not None:
        shown(text)
