"""Ctrl-C, or a timer, inside CasADi, which drops the exception of a signal's handler.

CVODES takes it for a failed step. CasADi's wrapper, which tries to convert its arguments one way after the
other, takes it for a conversion that failed. The handlers stay in force. The exceptions that they raise are
kept, end the call early, and are raised again after it.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

INTERRUPTING = [
    each
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGALRM", "SIGVTALRM", "SIGPROF")
    if (each := getattr(signal, name, None)) is not None
]
"""Signals whose handlers end a computation: of keys, of other processes and of timers, if they exist."""

Handler = Callable[[int, FrameType | None], object]


@contextmanager
def interruptible() -> Iterator[list[BaseException]]:
    """Raise at the end of the block what a handler of an interrupting signal raised inside.

    The block is given the list of these exceptions, to end early where CasADi drops one. Only the main thread
    is interrupted; in other threads nothing is done. As a decorator, `@interruptible()`, it is for functions
    that make expressions or call what is made of them.
    """
    raised: list[BaseException] = []
    if threading.current_thread() is not threading.main_thread():
        yield raised
        return
    before = {each: signal.getsignal(each) for each in INTERRUPTING}
    ours = {each: _kept(old, raised) for each, old in before.items() if callable(old)}
    for each, handler in ours.items():
        signal.signal(each, handler)
    try:
        yield raised
    finally:
        for each, handler in ours.items():
            # A handler may have put another in its place, to be heard once only.
            if signal.getsignal(each) is handler:
                signal.signal(each, before[each])
        if raised:
            raise raised[0] from None


def _kept(handler: Handler, raised: list[BaseException]) -> Handler:
    def handle(number: int, frame: FrameType | None) -> None:
        try:
            handler(number, frame)
        except BaseException as error:
            raised.append(error)
            raise

    return handle
