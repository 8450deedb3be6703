"""Two masses with dry friction between them, which stop on each other up to four times in a period."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.kept import kept

import periodic as per
import symbolic as sym

STIFF, DAMPING, FORCE, W = (1.0, 4.0), 0.05, 0.5, 0.6


@kept
def branch() -> per.Branch:
    """Over the friction force, from slip alone, through the onset of stops and their merging."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    parts: list[sym.Part] = [sym.HarmonicForce(x, FORCE, W), sym.CoulombFriction(x, 0.05, to=y)]
    for q, k in zip((x, y), STIFF, strict=True):
        parts += [sym.Mass(q, 1.0), sym.Spring(q, k), sym.Damper(q, DAMPING)]
    return per.trace(sym.compile(sym.combine(parts)), "F_f", (0.05, 0.35), at=(0.1, 0.2, 0.25, 0.3))


def after_a_period(tau: float, begin: Any, friction: float) -> tuple[Any, int]:
    """(x, vx, y, vy) 2 pi after tau, where it slips, mode by mode (slip or stick); the number of stops."""

    def free(t: float, z: Any) -> tuple[float, float]:
        return FORCE * np.cos(t) - DAMPING * z[1] - STIFF[0] * z[0], -DAMPING * z[3] - STIFF[1] * z[2]

    def needed(t: float, z: Any) -> float:
        a, b = free(t, z)
        return (a - b) / 2  # friction on x that keeps vx = vy

    def rates(t: float, z: Any, mode: float, start: float) -> list[float]:
        a, b = free(t, z)
        drag = needed(t, z) if mode == 0 else friction * mode
        return [z[1] / W, (a - drag) / W, z[3] / W, (b + drag) / W]

    def slips(t: float, z: Any, mode: float, start: float) -> float:
        return (z[1] - z[3]) if t > start + 1e-7 else mode

    def holds(t: float, z: Any, mode: float, start: float) -> float:
        return friction - abs(needed(t, z))

    tight = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "max_step": 0.05}
    t, z, stops, last = tau, np.array(begin), 0, tau + 2 * np.pi
    mode = float(np.sign(z[1] - z[3]))
    while t < last:
        event = holds if mode == 0 else slips
        event.terminal, event.direction = True, -1.0 if mode == 0 else -mode  # type: ignore[attr-defined]
        found = solve_ivp(rates, (t, last), z, events=event, args=(mode, t), **tight)
        t, z = float(found.t[-1]), found.y[:, -1]
        if found.status == 0:
            break
        if mode == 0:
            mode = float(np.sign(needed(t, z)))
        else:
            z[1] = z[3] = (z[1] + z[3]) / 2
            mode = 0.0 if abs(needed(t, z)) < friction else float(np.sign(needed(t, z)))
            stops += mode == 0
    return z, stops


@pytest.mark.parametrize(("friction", "stops"), [(0.1, 0), (0.2, 2), (0.25, 4), (0.3, 2)])
def test_stops_of_two_masses(friction: float, stops: int) -> None:
    """Assert that orbits come back to 1e-7 by event-exact integration, their stops, and multipliers to 1e-5.

    The latter from differences of the map over a period.
    """
    assert "bound reached" in str(branch().stop)
    (point,) = [p for p in branch().labelled(per.Label.USER) if p.parameter == friction]
    phases = np.linspace(0.0, 6.0, 61)
    states = point.orbit.state(phases) * np.array([1.0, W, 1.0, W])
    fastest = int(np.abs(states[:, 1] - states[:, 3]).argmax())
    tau, begin = float(phases[fastest]), states[fastest]
    end, counted = after_a_period(tau, begin, friction)
    assert counted == stops
    np.testing.assert_allclose(end, begin, atol=1e-7)
    step = 1e-5
    columns = [
        (after_a_period(tau, begin + e, friction)[0] - after_a_period(tau, begin - e, friction)[0])
        / (2 * step)
        for e in step * np.eye(4)
    ]
    expected, found = np.linalg.eigvals(np.transpose(columns)), point.multipliers
    for power in (1, 2, 3):
        np.testing.assert_allclose((found**power).sum(), (expected**power).sum(), atol=1e-5)
