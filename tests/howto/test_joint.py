"""How to add a kind of contact that sticks: one part whose force jumps with the sign of a speed.

A belt runs under a mass at the speed w: the force on it is -F sign(x' - w). The part lays down the force and
the switch x' - w at which it jumps, and nothing else is touched. That motion sticks to the belt, when it is
torn off, the event nodes with their modes, grazings and multipliers follow from the equations: the compiled
surface is one along which motions slide.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import scipy.integrate

import periodic as per
import symbolic as sym


@dataclass(frozen=True)
class Belt(sym.Part):
    """Dry friction on a belt: -F sign(x' - w)."""

    q: sym.Coordinate
    force: float
    speed: float

    def contribute(self, assembly: sym.Assembly) -> None:
        """Add the force, and the switch at which it jumps."""
        force = assembly.parameter(self.force, "F_belt", "N")
        speed = assembly.parameter(self.speed, "w_belt", "m/s")
        slip = assembly.speed_of(self.q) - speed
        assembly.motion(self.q).force -= force * sym.functions.sign(slip)
        assembly.switch(
            "slips on the belt", slip / (assembly.omega * assembly.motion(self.q).position.scale), 0
        )


F, W, C = 0.3, 0.2, 0.1


@pytest.fixture(scope="module")
def branch() -> per.Branch:
    """The branch of a mass on a belt."""
    x = sym.coordinate("x", unit="m")
    model = (
        sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, C) + Belt(x, F, W) + sym.HarmonicForce(x, 0.5)
    )
    return per.trace(sym.compile(model), "Omega", (0.5, 0.9))


def test_it_gets_through(branch: per.Branch) -> None:
    """Assert that it sticks to the belt and slips, over the whole range."""
    assert branch.stop.reason is per.Reason.BOUND
    assert all(len(point.orbit.mesh.events) >= 2 for point in branch)


def test_orbits_close(branch: per.Branch) -> None:
    """Assert the orbit against integration from where the belt lets go, to 1e-7."""
    sticking = [p for p in branch if any(event.switch != 0 for event in p.orbit.mesh.events)]
    for point in sticking[:: max(len(sticking) // 3, 1)]:
        release = next(
            (phase, event)
            for phase, event in zip(point.orbit.phases, point.orbit.mesh.events, strict=True)
            if event.switch != 0
        )
        t = float(release[0]) / point.parameter
        late = slid(t, float(point.orbit["x"](t)), point.parameter, release[1].direction)
        assert point.orbit["x"](late[0]) == pytest.approx(late[1], abs=1e-7)
        assert point.orbit["x'"](late[0]) == pytest.approx(W, abs=1e-6)


def slid(t: float, x: float, omega: float, side: int) -> tuple[float, float]:
    """Time and place at which a slip ends that begins on the belt."""

    def rates(s: float, y: np.ndarray) -> list[float]:
        return [y[1], 0.5 * np.cos(omega * s) - y[0] - C * y[1] - F * side]

    def stops(s: float, y: np.ndarray) -> float:
        return side * (y[1] - W)

    stops.terminal, stops.direction = True, -1.0  # type: ignore[attr-defined]
    last = t + 2 * np.pi / omega
    piece = scipy.integrate.solve_ivp(
        rates, (t, last), [x, W + side * 1e-12], "DOP853", events=[stops], rtol=1e-12, atol=1e-13
    )
    return float(piece.t[-1]), float(piece.y[0, -1])
