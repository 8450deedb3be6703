"""Newton's iteration in one call of C against the same in NumPy."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from support import joints, traces
from support.kept import kept
from support.numpy_systems import LinearOscillator

import periodic as per
import symbolic as sym
from periodic.collocation.fastmotions.unresolved import lost
from periodic.collocation.native import call, iteration
from periodic.collocation.native.estimate import estimated
from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.error import Halving, deferred
from periodic.correction.newton import NewtonSettings, correct
from periodic.linear.unknowns import parameter_only, size_of
from periodic.orbit.orbit import Orbit
from periodic.results.point import Point
from symbolic.kernels import native
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

Array = NDArray[np.float64]
NEWTON = NewtonSettings()
METHOD = per.Collocation()

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)


@cache
def compiled(name: str, kernels: str = "c") -> sym.CompiledSystem:
    """A scene of the package with its kernels in C."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ORBITRACE_KERNELS", kernels)
        models = {"chain": lambda: sym.compile(chain(20)), "joints": joints.friction_and_slider}
        return models[name]() if name in models else build(load(name))


def chain(count: int) -> sym.Model:
    """A chain of oscillators, whose matrices are mostly zeros."""
    x = [sym.coordinate(f"x{i}") for i in range(count)]
    parts: list[sym.Part] = [sym.HarmonicForce(x[0], 0.3)]
    for q in x:
        parts += [sym.Mass(q, 1.0), sym.Damper(q, 0.05), sym.Spring(q, 1.0), sym.CubicSpring(q, 0.1)]
    return sym.combine([*parts, *(sym.Coupling(q, r, 0.05) for q, r in pairwise(x))])


def begun(name: str) -> Orbit:
    """The first orbit of a system's branch."""
    one = per.ArclengthControl(max_points=1)
    return per.trace(compiled(name), "Omega", (1.5, 1.6), control=one)[0].orbit


@kept
def duffing() -> per.Branch:
    """The resonance of Duffing's oscillator."""
    return per.trace(compiled("duffing"), "Omega", (0.3, 3.0))


def beside(system: sym.CompiledSystem, orbit: Orbit, name: str) -> tuple[ArclengthConstraint, Orbit]:
    """A constraint across the parameter and the motion, about an orbit, and a guess a little away."""
    index = [p.name for p in system.parameters].index(name)
    rng = np.random.default_rng(3)
    profile, phases = rng.normal(size=orbit.nodes.shape), rng.normal(size=orbit.phases.shape)
    direction = replace(parameter_only(orbit, 0.1), profile=profile, phases=1e-2 * phases)
    constraint = ArclengthConstraint(orbit, direction, 1e-4, 1.0, index, size_of(orbit))
    guess = replace(
        orbit, nodes=orbit.nodes * (1 + 1e-4), phases=orbit.phases + 1e-4, stages=orbit.stages * (1 + 1e-4)
    )
    return constraint, guess


def close(found: Array, expected: Array, tolerance: float) -> None:
    """Assert equality to a tolerance relative to the largest entry."""
    assert found.shape == expected.shape
    assert np.abs(found - expected).max(initial=0.0) <= tolerance * np.abs(expected).max(initial=1.0)


def lost_contact() -> Orbit:
    """An orbit of the disc with event nodes."""
    return max((p.orbit for p in traces.disc().points), key=lambda orbit: len(orbit.phases))


def brief_contact() -> Orbit:
    """An orbit just beyond grazing, of whose excursion, a milliradian, the constraint takes the length."""
    orbits = [p.orbit for p in per.trace(compiled("stop"), "Omega", (0.7, 1.8)) if len(p.orbit.phases)]
    brief = [orbit for orbit in orbits if orbit.mesh.segment_lengths(orbit.phases).min() > 5e-4]
    return min(brief, key=lambda orbit: orbit.mesh.segment_lengths(orbit.phases).min())


def sticking() -> Orbit:
    """An orbit of joints that stick and slip."""
    one = per.ArclengthControl(max_points=1)
    return per.trace(compiled("joints"), "Omega", (0.8, 1.2), control=one)[0].orbit


CASES = {
    "duffing": ("Omega", lambda: duffing().points[20].orbit),
    "vitrea79-810N": ("speed", lost_contact),
    "chain": ("Omega", lambda: begun("chain")),
    "stop": ("Omega", brief_contact),
    "joints": ("Omega", sticking),
}


@pytest.mark.backends
@pytest.mark.parametrize("close_to", [0.0, 1.0])
@pytest.mark.parametrize("name", CASES)
def test_corrections_are_the_same(name: str, close_to: float) -> None:
    """Assert orbit, kernel, multipliers, sizes and iterations of both, with and without event nodes."""
    system, (parameter, orbit_of) = compiled(name), CASES[name]
    constraint, guess = beside(system, orbit_of(), parameter)
    given = (system, guess, (constraint.index,), [constraint], replace(NEWTON, close=close_to))
    found, expected = iteration.corrected(*given), correct(METHOD.linearise, *given)
    assert found is not None and found.ok and expected.ok and expected.kernel is not None
    few = 1 if name in ("stop", "joints") else 2  # these are linear between their events
    assert found.iterations == expected.iterations > few
    for part in ("nodes", "stages", "phases", "parameter"):
        close(getattr(found.orbit, part), getattr(expected.orbit, part), 1e-9)
    close(found.orbit.algebraic, expected.orbit.algebraic, 1e-8)
    for part in ("nodes", "stages", "algebraic", "phases", "parameters", "profile"):
        close(getattr(found.kernel, part), getattr(expected.kernel, part), 1e-6)
    close(found.fundamental, expected.fundamental, 1e-7)
    assert found.residual < 10 * expected.residual + 1e-9 and found.increment < NEWTON.tolerance


@pytest.mark.backends
@pytest.mark.parametrize("along", [0.1, 1e-6])
@pytest.mark.parametrize("name", CASES)
def test_error_estimates_are_the_same(name: str, along: float) -> None:
    """Assert errors of orbit, multipliers and parameter of both, on branches that turn and that do not."""
    system, (parameter, orbit_of) = compiled(name), CASES[name]
    constraint, guess = beside(system, orbit_of(), parameter)
    solution = correct(METHOD.linearise, system, guess, (constraint.index,), [constraint], NEWTON)
    problem = per.Problem(system, parameter, (0.3, 100.0))
    direction = replace(constraint.direction, parameters=np.array([along]))
    given = (problem, solution.orbit, direction, METHOD.spectrum(solution, 0))
    found = estimated(*given)
    expected = deferred(METHOD.linearise, *given, Halving(solved=METHOD._beside))
    assert found is not None and min(expected.orbit, expected.multiplier, expected.parameter) > 0
    assert found.error.orbit == pytest.approx(expected.orbit, rel=1e-4)
    assert found.error.parameter == pytest.approx(expected.parameter, rel=1e-4)
    assert found.error.multiplier == pytest.approx(expected.multiplier, rel=1e-3, abs=1e-11)


@pytest.mark.parametrize(("stiffness", "fast"), [(1.0, False), (1e6, True)])
def test_vibrations_too_fast_for_the_mesh_are_noticed(stiffness: float, fast: bool) -> None:
    """Assert that C tells of them where NumPy finds that multipliers lose something."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    springs = [sym.Spring(x, 1.0), sym.Spring(y, sym.parameter("k", stiffness))]
    parts = [sym.Mass(x, 1.0), sym.Mass(y, 1.0), *springs, sym.Damper(x, 0.1), sym.Damper(y, 0.1)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ORBITRACE_KERNELS", "c")
        system = sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 1.0)]))
    point = per.trace(system, "Omega", (0.7, 0.8), control=per.ArclengthControl(max_points=1))[0]
    constraint, guess = beside(system, point.orbit, "Omega")
    solution = correct(METHOD.linearise, system, guess, (constraint.index,), [constraint], NEWTON)
    problem = per.Problem(system, "Omega", (0.7, 0.8))
    found = estimated(problem, point.orbit, constraint.direction, METHOD.spectrum(solution, 0))
    assert found is not None and found.unresolved is fast
    assert (lost(system, point.orbit) > 0) is fast


def test_who_is_left_to_numpy() -> None:
    """Assert that C leaves alone other conditions, large systems, and those without its kernels."""
    orbit = duffing().points[20].orbit
    constraint, guess = beside(compiled("duffing"), orbit, "Omega")

    def chosen(
        system: per.extend.System, free: tuple[int, ...] = (constraint.index,), count: int = 1
    ) -> bool:
        return iteration.corrected(system, guess, free, [constraint] * count, NEWTON) is not None

    assert chosen(compiled("duffing"))
    assert not chosen(compiled("duffing", "numpy"))
    assert not chosen(compiled("duffing"), free=()) and not chosen(compiled("duffing"), count=2)
    assert not chosen(LinearOscillator())
    many = replace(guess, nodes=np.zeros((len(guess.nodes), call.MOST_STATES + 1)))
    assert iteration.corrected(compiled("duffing"), many, (constraint.index,), [constraint], NEWTON) is None


def test_iterations_that_are_damped() -> None:
    """Assert the same iterations, cut alike, and the same orbit from guesses that are far off."""
    orbit = duffing().points[20].orbit
    constraint, guess = beside(compiled("duffing"), orbit, "Omega")
    for factor, most in ((1.7, 12), (3.0, 30), (3.0, 2)):
        far = replace(guess, nodes=guess.nodes * factor, stages=guess.stages * factor)
        given = (
            *(compiled("duffing"), far, (constraint.index,), [constraint]),
            replace(NEWTON, max_iterations=most, max_change=0.1 * factor),
        )
        found, expected = iteration.corrected(*given), correct(METHOD.linearise, *given)
        assert found is not None
        assert (found.outcome, found.iterations) == (expected.outcome, expected.iterations)
        close(found.orbit.nodes, expected.orbit.nodes, 1e-8)


def test_what_fails_is_told_by_numpy() -> None:
    """Assert that equations that are not finite are left to NumPy, whose outcome stands."""
    orbit = duffing().points[20].orbit
    constraint, guess = beside(compiled("duffing"), orbit, "Omega")
    broken = replace(guess, stages=guess.stages * np.nan)
    given = (compiled("duffing"), broken, (constraint.index,), [constraint], NEWTON)
    assert iteration.corrected(*given) is None
    assert METHOD.corrected(*given).outcome is correct(METHOD.linearise, *given).outcome


def summary(point: Point) -> list[float]:
    """Some numbers of a point."""
    return [point.parameter, *point.maximum.values(), *np.abs(point.multipliers)]


@pytest.mark.backends
def test_branches_are_the_same() -> None:
    """Assert the branch of Duffing's resonance point by point, in C and in NumPy, to 1e-8."""
    other = per.trace(compiled("duffing", "numpy"), "Omega", (0.3, 3.0))
    assert [p.label for p in other] == [p.label for p in duffing()]
    for a, b in zip(other, duffing(), strict=True):
        assert summary(a) == pytest.approx(summary(b), rel=1e-8)
