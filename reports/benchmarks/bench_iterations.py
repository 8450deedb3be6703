"""Newton iterations: a converged orbit is corrected again and again."""

from __future__ import annotations

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

import periodic as per
import symbolic as sym
from periodic.correction.newton import correct
from reports.benchmarks.work import COUNTS, NTST, OFF_RESONANCE, chain_model, converged, linearisations
from symbolic.scenes.axes import RPM
from symbolic.scenes.building import build
from symbolic.scenes.reading import load


@pytest.mark.benchmark(group="disc iteration")
@pytest.mark.parametrize("ntst", NTST, ids="ntst {}".format)
def test_disc(benchmark: BenchmarkFixture, ntst: int) -> None:
    """The disc at 360 rev/min, ncol 4, by mesh intervals."""
    system = build(load("vitrea79-810N"))
    corrected(benchmark, system, converged(system, {"speed": 360 * RPM}, ntst))


@pytest.mark.benchmark(group="chain iteration")
@pytest.mark.parametrize("count", COUNTS, ids="{} oscillators".format)
def test_chain(benchmark: BenchmarkFixture, count: int) -> None:
    """Chains of oscillators at ntst 20, ncol 4, by their number."""
    system = sym.compile(chain_model(count))
    corrected(benchmark, system, converged(system, OFF_RESONANCE, 20))


def corrected(benchmark: BenchmarkFixture, system: sym.CompiledSystem, orbit: per.Orbit) -> None:
    """Measure the correction of an orbit; a record tells how many linearisations that is."""
    benchmark(correct, per.Collocation().linearise, system, orbit)
    benchmark.extra_info["linearised"] = linearisations(system, orbit)
