"""What Ctrl-C may stop and when: the tracing, once, and never the writing of results."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType


def _once(number: int, frame: FrameType | None) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    raise KeyboardInterrupt


@contextmanager
def _handled(handler: Callable[[int, FrameType | None], object] | signal.Handlers) -> Iterator[None]:
    # Only the main thread may change handlers, and only it is interrupted.
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def heard_once() -> AbstractContextManager[None]:
    """Inside the block the first Ctrl-C raises KeyboardInterrupt, and no other is heard."""
    return _handled(_once)


def unheard() -> AbstractContextManager[None]:
    """Inside the block no Ctrl-C is heard."""
    return _handled(signal.SIG_IGN)
