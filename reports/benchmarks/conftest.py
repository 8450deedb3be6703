"""One thread for all benchmarks, and what a record tells beside the times."""

from __future__ import annotations

import os
from collections.abc import Iterator
from importlib.metadata import version
from typing import Any

import pytest
from threadpoolctl import threadpool_limits

from reports.benchmarks import others

PACKAGES = ("orbitrace", "numpy", "scipy", "casadi")

SKIPPED = pytest.StashKey[dict[str, str]]()


@pytest.fixture(autouse=True, scope="session")
def one_thread() -> Iterator[None]:
    """Keep BLAS to one thread."""
    with threadpool_limits(limits=1, user_api="blas"):
        yield


def pytest_configure(config: pytest.Config) -> None:
    """Begin the list of what is left out."""
    config.stash[SKIPPED] = {}


@pytest.fixture
def measured(request: pytest.FixtureRequest) -> others.Measured:
    """What runs a peer; one that is missing is skipped, and the record says why."""

    def run(case: others.Case) -> others.Branch:
        try:
            return others.traced(case)
        except others.MissingError as error:
            request.config.stash[SKIPPED][case.name] = str(error)
            pytest.skip(str(error))

    return run


def pytest_benchmark_update_json(config: pytest.Config, output_json: dict[str, Any]) -> None:
    """Record versions, the load (busy machines spoil even processor times) and what was left out."""
    versions = {name: version(name) for name in PACKAGES}
    peers = {name: others.version(name) for name in others.PACKAGES.values()}
    machine = {"versions": versions | peers, "load": os.getloadavg()[0], "skipped": config.stash[SKIPPED]}
    output_json.update(machine)
