"""Whole branches at each accuracy."""

from __future__ import annotations

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

import periodic as per
from reports.benchmarks.work import fold_error
from symbolic.scenes.axes import RPM
from symbolic.scenes.building import build
from symbolic.scenes.files import load


def at_each_accuracy(what: str) -> pytest.MarkDecorator:
    """Return the mark of a benchmark for each accuracy, named after it."""
    ids = [f"{what}, {accuracy.name.lower()}" for accuracy in per.Accuracy]
    return pytest.mark.parametrize("accuracy", per.Accuracy, ids=ids)


def told(branch: per.Branch) -> dict[str, float]:
    """Return what a record tells of a branch."""
    return {"points": float(len(branch)), "iterations": float(branch.newton_iterations)}


@pytest.mark.benchmark(group="disc")
@at_each_accuracy("disc branch")
def test_disc(benchmark: BenchmarkFixture, accuracy: per.Accuracy) -> None:
    """The disc from 500 to 100 rev/min."""
    system, ends = build(load("vitrea79-810N")), (500 * RPM, 100 * RPM)
    benchmark.extra_info |= told(benchmark(per.trace, system, "speed", ends, accuracy=accuracy))


@pytest.mark.benchmark(group="Duffing A")
@at_each_accuracy("Duffing A branch")
def test_duffing(benchmark: BenchmarkFixture, accuracy: per.Accuracy) -> None:
    """Duffing A from 0.3 to 3 rad/s."""
    branch = benchmark(per.trace, build(load("duffing")), "Omega", (0.3, 3.0), accuracy=accuracy)
    folds = [point.parameter for point in branch.labelled(per.Label.FOLD)]
    benchmark.extra_info |= told(branch) | {"fold error": fold_error(folds)}
