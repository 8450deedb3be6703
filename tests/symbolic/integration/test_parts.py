"""Small functions of the integration: values by hand."""

from __future__ import annotations

import signal
from typing import Any

import pytest

from symbolic.integration.interrupts import heard


def test_handlers_are_put_back() -> None:
    """Assert that the user's handler of Ctrl-C is heard, raised at the end, and in its place again.

    One that another has put in the place of ours meanwhile is left.
    """
    before, told = signal.getsignal(signal.SIGINT), list[int]()

    def own(number: int, frame: Any) -> None:
        told.append(number)
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, own)
    try:
        with pytest.raises(KeyboardInterrupt), heard() as raised:
            assert signal.getsignal(signal.SIGINT) is not own
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)
            assert len(raised) == 1
        assert told == [signal.SIGINT] and signal.getsignal(signal.SIGINT) is own
        with heard():
            signal.signal(signal.SIGINT, signal.SIG_IGN)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
