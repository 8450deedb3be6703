"""How to bring a special point of one's own: where a pair of Floquet multipliers is exp(+-2 pi i/3).

There M^3 has the multiplier 1, and orbits of three periods branch off (a resonance 1:3, of orbits without
damping). The point takes a label, a `TestFunction` that changes sign there, a condition that holds it while a
second parameter varies, and a function that leads to the branch that begins there; continuation takes all of
them as it takes its own (LP, PD, NS, BP).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym
from periodic.collocation.elimination import eliminated
from periodic.extend import (
    Chain,
    Condition,
    Increment,
    Row,
    SideCondition,
    Solution,
    System,
    repeated,
    switched,
)
from periodic.orbit.scheme import Array

THIRD = 2 * np.pi / 3
TRIPLING = per.Label.register("PT", critical=True)


def real_part(solution: Solution) -> float:
    """Re mu + 1/2 of the pair nearest to exp(+-2 pi i/3), 0 where there is none: the test function."""
    pairs = [mu for mu in solution.spectrum.nontrivial if mu.imag > 0]
    return min((float(mu.real) + 0.5 for mu in pairs), key=abs, default=0.0)


def on_the_circle(solution: Solution) -> bool:
    """Whether the pair is on the unit circle, within its error."""
    return bool(np.abs(np.abs(solution.spectrum.nontrivial) - 1).max() < 1e-6)


TEST = per.extend.TestFunction(label=TRIPLING, value=real_part, genuine=on_the_circle)


@dataclass(frozen=True)
class TriplingCondition(Condition):
    """The pair of largest modulus has the real part -1/2: on a curve of such points in two parameters."""

    def at(self, origin: per.Orbit, given: per.Given) -> SideCondition:
        """Return the condition near an orbit."""
        return _Held()


class _Held:
    def linearise(self, system: System, orbit: per.Orbit, free: tuple[int, ...]) -> Row:
        """Return Re mu + 1/2 and its gradient, which the functional `Multiplier` knows."""
        row = per.Multiplier(0, "real").linearise(system, orbit, free)
        return Row(row.value + 0.5, row.nodes, row.outer, row.stages)


def tripled(
    system: System,
    orbit: per.Orbit,
    parameter: str,
    determined: Mapping[str, Condition] | None = None,
) -> per.Orbit:
    """Return an orbit of three periods that branches off: a guess for `trace`.

    It leaves along x(tau) + s Re(exp(i phi) Phi(tau) v), M v = exp(2 pi i/3) v; of the phases phi those are
    tried that differ.
    """
    chain, thrice = Chain(eliminated(system, orbit, ())), repeated(orbit, 3)
    values, vectors = np.linalg.eig(chain.fundamental[-1])
    vector = chain.fundamental @ vectors[:, values.imag.argmax()]
    for phi in np.linspace(0, THIRD, 8, endpoint=False):
        periods = [(np.exp(1j * (phi + THIRD * k)) * vector).real for k in range(3)]
        direction = _thrice(chain, periods)
        try:
            found = switched(system, thrice, direction, parameter, determined or {}, None)
        except per.SwitchError:
            continue
        return found
    raise per.SwitchError("no orbit of three periods was found")


def _thrice(chain: Chain, periods: list[Array]) -> Increment:
    """The perturbation of three periods from that of each at the mesh points."""
    still = np.zeros(len(chain.orbit.phases))
    inner = [chain.eliminated.recover(nodes, still, 0.0) for nodes in periods]
    nodes = np.concatenate([*(part[:-1] for part in periods[:-1]), periods[-1]])
    stages, algebraic = (np.concatenate(parts) for parts in zip(*inner, strict=True))
    return Increment(nodes, stages, algebraic, np.tile(still, 3), np.zeros(1), nodes)


def helmholtz() -> sym.CompiledSystem:
    """x'' + x - 0.4 x^2 = F cos(Omega t): without damping."""
    return sym.compile(
        sym.Equations(
            lambda x, p, wave: {"x": x.v, "v": -x.x + 0.4 * x.x**2 + p.F * wave.cos},
            states={"x": 0.0, "v": 0.0},
            parameters={"Omega": 2.9, "F": 0.5},
            frequency="Omega",
        )
    )


def test_orbits_triple() -> None:
    """Assert the point, the curve of such points, and the branch of three periods, by integration."""
    system, watch = helmholtz(), per.Watch(special=(TEST,))
    branch = per.trace(system, "Omega", (2.7, 3.2), tol=1e-9, watch=watch)
    (point,) = branch.labelled("PT")
    assert np.abs(point.multipliers**3 - 1).max() < 1e-7 and not point.stable

    curve = per.trace(
        system,
        "F",
        (0.5, 0.8),
        tol=1e-8,
        guess=point.orbit,
        determined={"Omega": TriplingCondition()},
    )
    assert curve.stop.reason is per.Reason.BOUND
    for one in curve:
        assert np.abs(one.multipliers**3 - 1).max() < 1e-6
    again = per.trace(system, "Omega", (2.7, 3.2), tol=1e-9, values={"F": 0.8}, watch=watch)
    assert again.labelled("PT")[0].parameter == pytest.approx(curve.column("Omega")[-1], rel=1e-8)

    bounds = (0.98 * point.parameter, 1.02 * point.parameter)
    threes = per.trace(system, "Omega", bounds, guess=tripled(system, point.orbit, "Omega"), tol=1e-8)
    orbit = threes[len(threes) // 2].orbit
    assert orbit.periods == 3
    Omega, F = threes[len(threes) // 2].parameter, 0.5

    def field(t: float, x: Array) -> Array:
        return np.array([x[1], -x[0] + 0.4 * x[0] ** 2 + F * np.cos(Omega * t)])

    start = np.array([orbit["x"](0.0), orbit["v"](0.0)]).ravel()
    path = solve_ivp(field, (0, 6 * np.pi / Omega), start, method="DOP853", rtol=1e-12, atol=1e-13)
    ends = path.y[:, -1]
    assert ends == pytest.approx(start, abs=1e-7)
