"""The back end that the tests run with: NumPy, C for problems, unless the environment says otherwise.

The automatic choice depends on what the user's cache holds. And the ledger: on every branch that a test
traces each change of stability and direction must be accounted for by a labelled point.
"""

import functools
import os
import signal
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from support.pages import chromium

if "ORBITRACE_KERNELS" not in os.environ:
    os.environ |= {"ORBITRACE_KERNELS": "numpy", "ORBITRACE_KERNELS_UNASKED": "1"}

import periodic as per  # noqa: E402
from periodic.tracing import trace as tracing  # noqa: E402
from symbolic.kernels import native  # noqa: E402

# A shell has Ctrl-C ignored in what it runs in the background; tests that send it need it heard.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


UNACCOUNTED: list[str] = []
"""What no labelled point accounts for on the branches that the test under way has traced."""


def _noted(join: Callable[..., "per.Branch"]) -> Callable[..., "per.Branch"]:
    """Let every trace, which ends with joining its halves, note what its ledger leaves open."""

    @functools.wraps(join)
    def joined(*arguments: object) -> "per.Branch":
        branch = join(*arguments)
        UNACCOUNTED.extend(f"{branch!r} {gap}" for gap in branch.unaccounted)
        return branch

    return joined


tracing._joined = _noted(tracing._joined)


@pytest.fixture(scope="module")
def users_kernels() -> Iterator[None]:
    """Systems of a module are compiled with the kernels that a user gets, unless some are asked for."""
    with pytest.MonkeyPatch.context() as patch:
        if "ORBITRACE_KERNELS_UNASKED" in os.environ and native.compiler() is not None:
            patch.setenv("ORBITRACE_KERNELS", "c")
        yield


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Headless Chromium, where there is one."""
    with chromium() as started:
        yield started


@pytest.fixture(autouse=True)
def balanced(request: pytest.FixtureRequest) -> Iterator[None]:
    """Assert that the ledger of each branch traced balances, where a test does not expect otherwise."""
    UNACCOUNTED.clear()
    yield
    assert not UNACCOUNTED or request.node.get_closest_marker("unaccounted"), UNACCOUNTED
