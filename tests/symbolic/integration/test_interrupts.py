"""Ctrl-C and SIGTERM arrive out of CVODES, where CasADi takes an exception for a failed step."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.faults

SCRIPT = """
import os, signal, sys, threading, time
from contextlib import nullcontext
import numpy as np
import symbolic as sym
from reports.app.interrupts import interrupting_at_once, interrupting_once, ignoring_interrupts
from symbolic.integration.flow import Flow

block, number, how, length = sys.argv[1:]
system = sym.compile(
    sym.Equations(
        lambda x, p: {"x": x.v, "v": p.mu * (1 - x.x**2) * x.v - x.x},
        states={"x": 0.0, "v": 0.0},
        parameters={"mu": 1.0},
    )
)
state, none, values, phase = np.ones(2), np.zeros(0), system.nominal, np.arange(0, float(length), 50)
run = {
    "flow": lambda: Flow(system, 1e-12).run(state, none, values, phase),
    "sensitivities": lambda: system.flow(state, none, values, phase, (0,), 1e-12),
}[how]
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have had it ignored
before = signal.getsignal(signal.SIGINT)

def timed():
    signal.signal(signal.SIGPROF, signal.default_int_handler)
    return nullcontext()

threading.Timer(0.3, os.kill, (os.getpid(), signal.Signals[number])).start()
begin = time.monotonic()
try:
    blocks = {"plain": nullcontext, "timed": timed, "once": interrupting_once}
    blocks["at once"] = interrupting_at_once
    with (blocks | {"ignored": ignoring_interrupts})[block]():
        run()
        print("returned")
except BaseException as error:
    print(type(error).__name__)
print(time.monotonic() - begin < 5, signal.getsignal(signal.SIGINT) is before)
"""


@pytest.mark.parametrize("how", ["flow", "sensitivities"])
@pytest.mark.parametrize(
    ("block", "number", "raised"),
    [
        ("plain", "SIGINT", "KeyboardInterrupt"),
        ("once", "SIGINT", "KeyboardInterrupt"),
        ("once", "SIGTERM", "KeyboardInterrupt"),
        ("at once", "SIGTERM", "Ended"),
        ("timed", "SIGPROF", "KeyboardInterrupt"),
    ],
)
def test_signal_ends_a_long_integration(block: str, number: str, raised: str, how: str) -> None:
    """Assert that what the handler in force raises leaves CVODES at once, and the handler stays in force."""
    assert said(block, number, how, "2e5") == [raised, "True", "True"]


def test_signal_that_is_not_heard() -> None:
    """Assert that an integration runs through where signals are ignored."""
    ended, _, kept = said("ignored", "SIGINT", "flow", "2e3")
    assert (ended, kept) == ("returned", "True")


def said(*arguments: str) -> list[str]:
    """What the script prints."""
    command = [sys.executable, "-W", "error", "-c", SCRIPT, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=30)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()
