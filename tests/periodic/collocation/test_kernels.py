"""One algorithm, two kernels: the same points and the same Newton iterations in C and in NumPy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from support.cantilevers import cantilever, cubic
from support.joints import dry_friction, friction_and_slider

import periodic as per
import symbolic as sym
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from symbolic.kernels import native

pytestmark = pytest.mark.backends

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)


def chain(count: int) -> sym.CompiledSystem:
    """Oscillators with cubic springs, coupled to their neighbours."""
    x = [sym.coordinate(f"x{i}") for i in range(count)]
    parts: list[sym.Part] = [sym.HarmonicForce(x[0], 0.3)]
    for q in x:
        parts += [sym.Mass(q, 1.0), sym.Damper(q, 0.05), sym.Spring(q, 1.0), sym.CubicSpring(q, 0.1)]
    return sym.compile(sym.combine([*parts, *(sym.Coupling(q, r, 0.05) for q, r in pairwise(x))]))


def beam() -> sym.CompiledSystem:
    """A cantilever with a cubic spring at its tip."""
    return cantilever(2, cubic)


CASES: dict[str, tuple[Callable[[], sym.CompiledSystem], str, tuple[float, float]]] = {
    "disc from 15 up": (lambda: sym.scene("vitrea79-810N"), "speed", (15.0, 50.0)),
    "disc from 50 down": (lambda: sym.scene("vitrea79-810N"), "speed", (50.0, 15.0)),
    "disc from 105 down": (lambda: sym.scene("vitrea79-810N"), "speed", (52.36, 10.472)),
    "gear pair": (lambda: sym.scene("gear-pair"), "Omega", (1.2, 0.4)),
    "gear pair from below": (lambda: sym.scene("gear-pair"), "Omega", (0.4, 1.2)),
    "Duffing": (lambda: sym.scene("duffing"), "Omega", (0.3, 3.0)),
    "stop": (lambda: sym.scene("stop"), "Omega", (0.7, 1.8)),
    "chain": (lambda: chain(6), "Omega", (0.8, 1.6)),
    "beam, condensed": (beam, "Omega", (3.2, 4.2)),
    "friction that sticks": (dry_friction, "Omega", (0.3, 1.5)),
    "friction beside a slider": (friction_and_slider, "Omega", (0.8, 1.2)),
    "beam with all states": (lambda: cantilever(1, cubic, condense=False), "Omega", (3.2, 4.2)),
}


ROUNDED = "disc from 15 up"
"""Where contact opens it has 257 intervals; an estimate near rounding says whether next 151 or 152."""


def compiled(name: str, kernels: str) -> sym.CompiledSystem:
    """The system of a case."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ORBITRACE_KERNELS", kernels)
        return CASES[name][0]()


def traced(name: str, kernels: str) -> per.Branch:
    """A branch of a case."""
    _, parameter, ends = CASES[name]
    return per.trace(compiled(name, kernels), parameter, ends)


@pytest.mark.parametrize("name", [name for name in CASES if name != ROUNDED])
def test_same_iterations(name: str) -> None:
    """Assert as many points, and point by point the same iterations and orbits."""
    one, other = traced(name, "numpy"), traced(name, "c")
    assert [p.iterations for p in one] == [p.iterations for p in other]
    assert one.newton_iterations == other.newton_iterations
    assert [p.label for p in one] == [p.label for p in other]
    for a, b in zip(one, other, strict=True):
        assert a.parameter == pytest.approx(b.parameter, rel=1e-6)


@pytest.mark.parametrize("name", ["disc from 15 up", "gear pair", "stop", "chain", "friction that sticks"])
def test_every_correction(name: str) -> None:
    """Assert for all that a branch solves, failures too, the same iterations, outcome and orbit."""
    solve, asked = Solver.on, list[tuple[Solver, tuple[Any, ...], Solution]]()

    def recorded(self: Solver, *given: Any) -> Solution:
        asked.append((self, given, found := solve(self, *given)))
        return found

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Solver, "on", recorded)
        branch = traced(name, "numpy")
    other = compiled(name, "c")
    for solver, given, expected in asked:
        found = solve(replace(solver, problem=replace(solver.problem, system=other)), *given)
        assert (found.outcome, found.correction.iterations) == (
            expected.outcome,
            expected.correction.iterations,
        )
        if expected.ok:
            assert found.value == pytest.approx(expected.value, rel=1e-9)
            scale = np.abs(expected.orbit.nodes).max()
            assert found.orbit.nodes == pytest.approx(expected.orbit.nodes, rel=0, abs=1e-8 * scale)
    assert len(asked) > len(branch)
