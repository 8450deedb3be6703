"""The same equations in NumPy and in C, each compiled with a cache of its own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

import periodic as per
import symbolic as sym
from periodic.correction.newton import Equations, correct
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import uniform
from periodic.orbit.orbit import Orbit
from reports.benchmarks.work import chain_model
from symbolic.kernels import native
from symbolic.kernels.choice import Kernels
from symbolic.scenes.axes import RPM
from symbolic.scenes.building import disc_model, oscillator_model
from symbolic.scenes.reading import load
from symbolic.scenes.schema import DiscScene, OscillatorScene

CASES = [(name, ntst) for name in ("duffing", "disc", "chain") for ntst in (20, 50, 100, 200)][:-2]
"""Models and mesh intervals; the chain's fifty oscillators are for coarse meshes."""

kinds = pytest.mark.parametrize("kernels", (Kernels.NUMPY, Kernels.C), ids=lambda kind: kind.value)
cases = pytest.mark.parametrize(("name", "ntst"), CASES)


@pytest.fixture(autouse=True)
def empty_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let kernels be kept in a directory of the test's own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    native.forget()
    yield
    native.forget()


def model(name: str) -> sym.Model:
    """Return a model by name."""
    if name == "chain":
        return chain_model(50)
    scene = load("duffing" if name == "duffing" else "vitrea79-810N")
    if isinstance(scene, OscillatorScene):
        return oscillator_model(scene)
    assert isinstance(scene, DiscScene)
    return disc_model(scene)


def orbit(system: sym.CompiledSystem, ntst: int) -> Orbit:
    """Return the orbit that Newton finds from rest, or where it got to."""
    rest = at_rest(system, uniform(per.Scheme(), ntst), system.nominal)
    return correct(per.Collocation().linearise, system, rest).orbit


@kinds
@cases
def test_evaluation(benchmark: BenchmarkFixture, name: str, ntst: int, kernels: Kernels) -> None:
    """The residual and its derivatives at all collocation points."""
    system = sym.compile(model(name), kernels)
    at = orbit(system, ntst)
    n, m = at.stages.shape[2], at.algebraic.shape[2]
    rate, state = (np.ascontiguousarray(a).reshape(-1, n) for a in (at.knot_rates[:, 1:], at.stages))
    unknown, phase = at.algebraic.reshape(len(state), m), at.stage_phases.ravel()
    benchmark(system.linearise, rate, state, unknown, phase, at.parameter, (0,))


@kinds
@cases
def test_newton_iteration(benchmark: BenchmarkFixture, name: str, ntst: int, kernels: Kernels) -> None:
    """One Newton iteration at fixed parameters."""
    system = sym.compile(model(name), kernels)
    linearise, at = per.Collocation().linearise, orbit(system, ntst)
    benchmark(Equations(linearise, system).step, at)


@pytest.mark.parametrize("kept", (False, True), ids=("compiled", "kept"))
@pytest.mark.parametrize("name", ("duffing", "disc", "chain"))
def test_set_up(benchmark: BenchmarkFixture, name: str, kept: bool) -> None:
    """From a model's parts to the first derivatives in C, its library compiled or from the cache."""

    def set_up() -> None:
        native.forget()
        system = sym.compile(model(name), Kernels.C)
        state, unknown = system.rest(system.nominal)
        system.linearise(0 * state[None], state[None], unknown[None], np.zeros(1), system.nominal, (0,))

    if kept:
        set_up()
    benchmark.pedantic(set_up, rounds=5 if kept else 1)


@kinds
def test_branch(benchmark: BenchmarkFixture, kernels: Kernels) -> None:
    """The disc from 500 to 100 rev/min, compiled anew."""
    disc, ends = model("disc"), (500 * RPM, 100 * RPM)
    benchmark(lambda: per.trace(sym.compile(disc, kernels), "speed", ends))
