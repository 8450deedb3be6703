"""Branches by other tools, where they are installed: each in a process of its own."""

from __future__ import annotations

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from reports.benchmarks.others import Case, Measured
from reports.benchmarks.work import AUTO

FEW = 60
"""Points that AUTO is traced through with Python called back, which is slow."""

CASES = (
    *(Case(f"AUTO-07p by bifpy, ntst {n}", "auto", (str(n), "1000", "transpiled")) for n in (20, 50, 100)),
    Case(f"AUTO-07p by bifpy in Python, ntst 50, {FEW} points", "auto", ("50", str(FEW), "called")),
    *(Case(f"AUTO-07p itself, ntst {n}", "executable", ("duffing", "1", str(n))) for n in (20, 50)),
    Case("xpplab, ntst 20", "xpp", ("20",)),
    Case("pyHarm, H 7", "harm", ("7",)),
    Case("bice, 50 steps", "difference", ("50",)),
)


class Told:
    """A clock that goes on by what other processes say they took."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now

    def pass_by(self, seconds: float) -> None:
        """Let time go by."""
        self.now += seconds


CLOCK = Told()


@pytest.mark.benchmark(group="Duffing A", timer=CLOCK)
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_peer(benchmark: BenchmarkFixture, measured: Measured, case: Case) -> None:
    """Duffing A from 0.3 to 3 rad/s."""
    branch = measured(case)
    benchmark.pedantic(CLOCK.pass_by, (branch.seconds,))
    benchmark.extra_info |= branch.numbers


CHAINS = [Case(f"AUTO-07p itself, {n} oscillators", "executable", ("chain", str(n), "20")) for n in AUTO]
CHAINS += [Case("AUTO-07p itself, 20 with clearances", "executable", ("stopped", "20", "20"))]


@pytest.mark.benchmark(group="chain branch", timer=CLOCK)
@pytest.mark.parametrize("case", CHAINS, ids=lambda case: case.name)
def test_chain(benchmark: BenchmarkFixture, measured: Measured, case: Case) -> None:
    """Chains of oscillators from 1.6 down to 0.5 rad/s."""
    branch = measured(case)
    benchmark.pedantic(CLOCK.pass_by, (branch.seconds,))
    benchmark.extra_info |= branch.numbers
