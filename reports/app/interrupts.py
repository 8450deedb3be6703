"""What Ctrl-C and SIGTERM may stop and when: the tracing, once, and never the writing of results."""

from __future__ import annotations

import signal
from contextlib import AbstractContextManager
from types import FrameType
from typing import Any

from periodic.results.signals import ENDING, handled


class Ended(BaseException):
    """A request to end that nothing on the way takes for its own: not a KeyboardInterrupt."""


def _once(number: int, frame: FrameType | None) -> None:
    for each in ENDING:
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt


def _at_once(number: int, frame: FrameType | None) -> None:
    raise Ended


def interrupting_once() -> AbstractContextManager[Any]:
    """Inside the block the first Ctrl-C raises KeyboardInterrupt, and no other is heard."""
    return handled(_once)


def interrupting_at_once() -> AbstractContextManager[Any]:
    """Inside the block every Ctrl-C raises Ended: a trace under way does not end as a shorter branch."""
    return handled(_at_once)


def ignoring_interrupts() -> AbstractContextManager[Any]:
    """Inside the block Ctrl-C does nothing."""
    return handled(signal.SIG_IGN)
