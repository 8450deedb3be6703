"""The back end that the tests run with: NumPy, C in some folders, unless the environment says otherwise.

The automatic choice depends on what the user's cache holds. And the store of orbits, and the ledger: on every
branch that a test traces each change of stability and direction must be accounted for by a labelled point.
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

from support.kept import STORE, UNACCOUNTED  # noqa: E402
from support.rooms import IN_C, ROOMS_IN_C  # noqa: E402

import periodic as per  # noqa: E402
from periodic.tracing import trace as tracing  # noqa: E402
from symbolic.kernels import native  # noqa: E402

# A shell has Ctrl-C ignored in what it runs in the background, and nohup a terminal that closes; tests that
# send these need them heard.
for number, heard in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, heard)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Let a run keep what tests compute, and have the tests of orbits run in C."""
    parser.addoption("--in-c", action="store_true", help="tests of orbits in C where there is a compiler")
    parser.addoption("--keep", action="store_true", help="keep orbits in pytest's cache for later runs")


def pytest_configure(config: pytest.Config) -> None:
    """Open the store of orbits where it is asked for."""
    if config.getoption("--keep"):
        folder = config.cache.mkdir("orbits")
        STORE.open(folder)
        if not hasattr(config, "workerinput"):
            STORE.tidy(folder)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests that drive a browser."""
    for item in items:
        if isinstance(item, pytest.Function) and "browser" in item.fixturenames:
            item.add_marker(pytest.mark.browser)


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


@pytest.fixture(autouse=True, scope="module")
def back_end_of_users(request: pytest.FixtureRequest) -> None:
    """Use the kernels that a user gets, in the folders where that is so."""
    folders = (*IN_C, *ROOMS_IN_C) if request.config.getoption("--in-c") else IN_C
    if any(folder in request.path.parents for folder in folders):
        request.getfixturevalue("users_kernels")


@pytest.fixture(autouse=True)
def unpatched(request: pytest.FixtureRequest) -> None:
    """Shut the store to tests that may change the engine under way."""
    STORE.shut = "monkeypatch" in request.fixturenames


@pytest.fixture(autouse=True)
def balanced(request: pytest.FixtureRequest) -> Iterator[None]:
    """Assert that the ledger of each branch traced balances, where a test does not expect otherwise."""
    UNACCOUNTED.clear()
    yield
    assert not UNACCOUNTED or request.node.get_closest_marker("unaccounted"), UNACCOUNTED
