"""One algorithm, two kernels: the same points and the same Newton iterations in C and in NumPy."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import pytest
from support.cantilevers import cantilever, cubic
from support.joints import dry_friction, friction_and_slider

import periodic as per
import symbolic as sym
from symbolic.kernels import native

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


def traced(name: str, kernels: str) -> per.Branch:
    """A branch of a case."""
    system_of, parameter, ends = CASES[name]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ORBITRACE_KERNELS", kernels)
        system = system_of()
    return per.trace(system, parameter, ends)


@pytest.mark.parametrize("name", CASES)
def test_same_iterations(name: str) -> None:
    """Assert as many points, and point by point the same iterations and orbits."""
    one, other = traced(name, "numpy"), traced(name, "c")
    assert [p.iterations for p in one] == [p.iterations for p in other]
    assert one.newton_iterations == other.newton_iterations
    assert [p.label for p in one] == [p.label for p in other]
    for a, b in zip(one, other, strict=True):
        assert a.parameter == pytest.approx(b.parameter, rel=1e-6)
