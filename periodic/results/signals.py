"""Signals that end a program (Ctrl-C, SIGTERM, SIGHUP): handled otherwise or made to wait in a block."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

Handler = Callable[[int, FrameType | None], Any] | int | None
HANGUP: signal.Signals | None = getattr(signal, "SIGHUP", None)
"""What a terminal sends that is closed; Windows has none."""

ENDING = tuple(each for each in (signal.SIGINT, signal.SIGTERM, HANGUP) if each is not None)


@contextmanager
def handled(handler: Handler) -> Iterator[dict[int, Handler]]:
    """Inside the block the signals that end a program have another handler.

    Parameters
    ----------
    handler : callable or signal.Handlers
        As for `signal.signal`.

    Yields
    ------
    dict
        The handlers from before, by signal, which are set again after the block. None outside the main
        thread: only that one is interrupted, and only it may change handlers.
    """
    if threading.current_thread() is not threading.main_thread():
        yield {}
        return
    # A closed terminal that `nohup` has a program ignore stays ignored.
    nohup = HANGUP is not None and signal.getsignal(HANGUP) == signal.SIG_IGN
    caught = [each for each in ENDING if not (nohup and each == HANGUP)]
    before: dict[int, Handler] = {each: signal.signal(each, handler) for each in caught}
    try:
        yield before
    finally:
        for each, old in before.items():
            signal.signal(each, old or signal.SIG_DFL)


@contextmanager
def deferred() -> Iterator[None]:
    """Inside the block signals that end a program wait; the handler of the first is called after it.

    Yields
    ------
    None
        Nothing.
    """
    received: list[tuple[int, FrameType | None]] = []
    with handled(lambda *at: received.append(at)) as before:
        yield
    for number, frame in received[:1]:
        handler = before[number]
        if callable(handler):
            handler(number, frame)
        elif handler == signal.SIG_DFL:
            signal.raise_signal(number)
