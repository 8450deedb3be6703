"""What Ctrl-C and SIGTERM may stop and when: the tracing, once, and never the writing of results."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType

ENDING = (signal.SIGINT, signal.SIGTERM)


def _once(number: int, frame: FrameType | None) -> None:
    for each in ENDING:
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt


@contextmanager
def _handled(handler: Callable[[int, FrameType | None], object] | signal.Handlers) -> Iterator[None]:
    # Only the main thread may change handlers, and only it is interrupted.
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {each: signal.signal(each, handler) for each in ENDING}
    try:
        yield
    finally:
        for each, old in before.items():
            signal.signal(each, old)


class Ended(BaseException):
    """A request to end that nothing on the way takes for its own: not a KeyboardInterrupt."""


def _at_once(number: int, frame: FrameType | None) -> None:
    raise Ended


def heard_at_once() -> AbstractContextManager[None]:
    """Inside the block every Ctrl-C raises Ended: a trace under way does not end as a shorter branch."""
    return _handled(_at_once)


def heard_once() -> AbstractContextManager[None]:
    """Inside the block the first Ctrl-C raises KeyboardInterrupt, and no other is heard."""
    return _handled(_once)


def unheard() -> AbstractContextManager[None]:
    """Inside the block no Ctrl-C is heard."""
    return _handled(signal.SIG_IGN)
