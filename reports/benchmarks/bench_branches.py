"""Whole branches at each accuracy."""

from __future__ import annotations

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

import periodic as per
import symbolic as sym
from reports.benchmarks.work import AUTO, calibration, chain_model, fold_error, stopped_model
from symbolic.scenes.axes import RPM
from symbolic.scenes.building import build
from symbolic.scenes.reading import load


def at_each_accuracy(what: str) -> pytest.MarkDecorator:
    """Return the mark of a benchmark for each accuracy, named after it."""
    ids = [f"{what}, {accuracy.name.lower()}" for accuracy in per.Accuracy]
    return pytest.mark.parametrize("accuracy", per.Accuracy, ids=ids)


def figures(branch: per.Branch) -> dict[str, float]:
    """Return what a record tells of a branch."""
    return {"points": float(len(branch)), "iterations": float(branch.newton_iterations)}


@pytest.mark.benchmark(group="disc")
@at_each_accuracy("disc branch")
def test_disc(benchmark: BenchmarkFixture, accuracy: per.Accuracy) -> None:
    """The disc from 500 to 100 rev/min."""
    system, ends = build(load("vitrea79-810N")), (500 * RPM, 100 * RPM)
    benchmark.extra_info |= figures(benchmark(per.trace, system, "speed", ends, tol=accuracy))


@pytest.mark.benchmark(group="Duffing A")
@at_each_accuracy("Duffing A branch")
def test_duffing(benchmark: BenchmarkFixture, accuracy: per.Accuracy) -> None:
    """Duffing A from 0.3 to 3 rad/s."""
    branch = benchmark(per.trace, build(load("duffing")), "Omega", (0.3, 3.0), tol=accuracy)
    folds = [point.parameter for point in branch.labelled(per.Label.FOLD)]
    benchmark.extra_info |= figures(branch) | {"fold error": fold_error(folds)}


@pytest.mark.benchmark(group="chain branch")
@pytest.mark.parametrize("count", AUTO, ids="{} oscillators".format)
def test_chain(benchmark: BenchmarkFixture, count: int) -> None:
    """Chains of oscillators from 1.6 down to 0.5 rad/s through their folds; AUTO's time as once recorded."""
    branch = benchmark.pedantic(per.trace, (sym.compile(chain_model(count)), "Omega", (1.6, 0.5)), rounds=3)
    points, loops = AUTO[count]
    benchmark.extra_info |= figures(branch) | {"AUTO points": points, "AUTO s": loops * calibration()}


@pytest.mark.benchmark(group="chain branch")
@pytest.mark.parametrize("count", [2, 20], ids="{} with clearances".format)
def test_clearances(benchmark: BenchmarkFixture, count: int) -> None:
    """Chains of oscillators with clearances, from 1.6 rad/s through the resonance, in 60 steps at most."""
    given, few = (sym.compile(stopped_model(count)), "Omega", (1.6, 0.5)), per.ArclengthControl(max_points=60)
    benchmark.extra_info |= figures(benchmark.pedantic(per.trace, given, {"control": few}, rounds=1))


@pytest.mark.benchmark(group="large motion")
def test_amplitude(benchmark: BenchmarkFixture) -> None:
    """Duffing's oscillator from a force of 0.01 to 50, at its natural frequency."""
    system, ends = build(load("duffing")), (0.01, 50.0)
    benchmark.extra_info |= figures(benchmark(per.trace, system, "F", ends, values={"Omega": 1.0}))


@pytest.mark.benchmark(group="gear pair")
def test_gear_pair(benchmark: BenchmarkFixture) -> None:
    """The gear pair with backlash from 1.2 down to 0.4."""
    system = sym.scene("gear-pair")
    benchmark.extra_info |= figures(benchmark(per.trace, system, "Omega", (1.2, 0.4)))
