"""How long the equations take in NumPy and in C: `python -m reports.bench.kernels` prints the table.

Times are the shortest of many, on one thread; each model is compiled with a cache of its own.
"""

from __future__ import annotations

import math
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import threadpoolctl

import periodic as per
import symbolic as sym
from periodic.closure import Closure
from periodic.mesh import uniform
from periodic.newton import correct, linear_step
from periodic.orbit import Orbit, at_rest
from periodic.scheme import Scheme
from periodic.settings import Accuracy
from reports.build import disc_model, oscillator_model
from reports.scene import load
from reports.schema import DiscScene, OscillatorScene
from symbolic import native
from symbolic.choice import Kernels

NTST = (20, 50, 100, 200)
OSCILLATORS = 50
"""Length of the chain."""

LONG = 0.4
"""Seconds that a call is repeated for."""


def chain(count: int) -> sym.Model:
    """Return oscillators in a row, each with a cubic spring to ground, the first one driven."""
    x = [sym.coordinate(f"x{i}") for i in range(count)]
    parts: list[sym.Part] = [sym.HarmonicForce(x[0], 0.5, 0.8)]
    for q in x:
        parts += [sym.Mass(q, 1.0), sym.Damper(q, 0.1), sym.Spring(q, 1.0), sym.CubicSpring(q, 0.1)]
    parts += [sym.Coupling(q, r, 0.5) for q, r in zip(x, x[1:], strict=False)]
    return sym.combine(parts)


def models() -> dict[str, sym.Model]:
    """Return what is measured, by name."""
    disc, duffing = load("vitrea79-810N"), load("duffing")
    assert isinstance(disc, DiscScene) and isinstance(duffing, OscillatorScene)
    return {
        "duffing": oscillator_model(duffing),
        "disc": disc_model(disc),
        f"chain of {OSCILLATORS}": chain(OSCILLATORS),
    }


@contextmanager
def empty_cache() -> Iterator[None]:
    """Let kernels be kept in a directory of their own, which is removed."""
    before = os.environ.get("XDG_CACHE_HOME")
    with tempfile.TemporaryDirectory() as directory:
        os.environ["XDG_CACHE_HOME"] = directory
        native.forget()
        try:
            yield
        finally:
            native.forget()
            if before is None:
                del os.environ["XDG_CACHE_HOME"]
            else:
                os.environ["XDG_CACHE_HOME"] = before


def shortest(call: Callable[[], object]) -> float:
    """Return the shortest time of a call in s."""
    times: list[float] = []
    end = time.perf_counter() + LONG
    while len(times) < 3 or time.perf_counter() < end:
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return min(times)


def orbit(system: sym.CompiledSystem, ntst: int) -> Orbit:
    """Return the orbit that Newton finds from rest, or where it got to."""
    guess = at_rest(system, uniform(Scheme(), ntst), system.nominal)
    return correct(system, guess).orbit


def evaluation(system: sym.CompiledSystem, at: Orbit) -> Callable[[], object]:
    """Return what evaluates the residual and its derivatives at the collocation points."""
    n, m = at.stages.shape[2], at.algebraic.shape[2]
    rate, state = (np.ascontiguousarray(a).reshape(-1, n) for a in (at.knot_rates[:, 1:], at.stages))
    unknown, phase = at.algebraic.reshape(len(state), m), at.stage_phases.ravel()
    return lambda: system.linearise(rate, state, unknown, phase, at.parameter, (0,))


def newton(system: sym.CompiledSystem, at: Orbit) -> Callable[[], object]:
    """Return what takes one Newton iteration at fixed parameters."""
    closures: tuple[Closure, ...] = ()
    return lambda: linear_step(system, at, (), closures)


def table(name: str, model: sym.Model) -> Iterator[str]:
    """Yield the lines of one model."""
    for kernels in (Kernels.NUMPY, Kernels.C):
        system = sym.compile(model, kernels)
        orbits = [orbit(system, ntst) for ntst in NTST if len(system.states) < 20 or ntst <= 50]
        for what, made in (("evaluation", evaluation), ("Newton iteration", newton)):
            times = [1e6 * shortest(made(system, at)) for at in orbits]
            yield f"{name:12} {what:17} {kernels.value:6}" + "".join(f"{t:9.0f}" for t in times)


def set_up(model: sym.Model) -> Iterator[str]:
    """Yield how long a model takes from its parts to the first derivatives: NumPy, C, C from the cache."""
    for kernels, kept in ((Kernels.NUMPY, ""), (Kernels.C, ""), (Kernels.C, ", kept")):
        native.forget()
        begin = time.perf_counter()
        system = sym.compile(model, kernels)
        state, unknown = system.rest(system.nominal)
        system.linearise(0 * state[None], state[None], unknown[None], np.zeros(1), system.nominal, (0,))
        yield f"{kernels.value}{kept} {time.perf_counter() - begin:.3f}"


def branch(kernels: Kernels) -> float:
    """Return how long the disc's branch from 500 to 100 rpm takes at standard accuracy, in s."""
    scene = load("vitrea79-810N")
    assert isinstance(scene, DiscScene)
    rpm = math.pi / 30
    begin = time.perf_counter()
    system = sym.compile(disc_model(scene), kernels)
    per.trace(system, "speed", (500 * rpm, 100 * rpm), accuracy=Accuracy.STANDARD)
    return time.perf_counter() - begin


def lines() -> Iterator[str]:
    """Yield the report."""
    yield f"{'microseconds at ntst':37}" + "".join(f"{ntst:9}" for ntst in NTST)
    for name, model in models().items():
        with empty_cache():
            yield from table(name, model)
    for name, model in models().items():
        with empty_cache():
            yield f"{name:12} set-up in s: " + "; ".join(set_up(model))
    with empty_cache():
        cold = branch(Kernels.AUTO)
        times = {kernels: min(branch(kernels) for _ in range(3)) for kernels in Kernels}
    yield f"disc 500 to 100 rpm in s: auto, nothing kept {cold:.2f}; " + "; ".join(
        f"{kernels.value} {seconds:.2f}" for kernels, seconds in times.items()
    )


if __name__ == "__main__":
    with threadpoolctl.threadpool_limits(1):
        for line in lines():
            print(line, flush=True)
