"""Dry friction and a rigid wall on one mass: an impact reverses what slides; judged by its own integration.

x'' + .1 x' + x + .2 sign(x') = cos(w t), x <= .6, x' becomes -.7 x' there.
"""

from __future__ import annotations

import numpy as np
import pytest
import scipy.integrate

import periodic as per
import symbolic as sym

FRICTION, GAP, REBOUND, DAMPING = 0.2, 0.6, 0.7, 0.1

STEP = 5e-3
"""Longest step of the judge (s): a slow impact must not begin and end within one."""


@pytest.fixture(scope="module", params=[0.6, 2.5])
def branch(request: pytest.FixtureRequest) -> per.Branch:
    """The branch over its whole range, from either end."""
    x = sym.coordinate("x", unit="m")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, DAMPING) + sym.CoulombFriction(x, FRICTION)
    model = model + sym.RigidStop(x, GAP, REBOUND) + sym.HarmonicForce(x, 1.0)
    return per.trace(sym.compile(model), "Omega", (0.6, 2.5), start=request.param)


def test_whole_range(branch: per.Branch) -> None:
    """Assert that it gets through, and where it folds and grazes, alike from both ends to 1e-8."""
    assert branch.stop.reason is per.Reason.BOUND
    assert sorted(p.parameter for p in branch.labelled(per.Label.FOLD)) == pytest.approx(
        [0.736520968, 0.740141755, 1.594574433, 1.770295407], abs=1e-8
    )
    grazings = sorted({round(p.parameter, 9) for p in branch.labelled(per.Label.GRAZING)})
    assert grazings == pytest.approx([0.736520968, 0.988952011, 1.594574433], abs=1e-8)


def test_orbits_close(branch: per.Branch) -> None:
    """Assert that an integration from event to event comes back: to 1e-8, or ten times what is claimed."""
    judged = 0
    for point in branch[::8]:
        times = point.orbit.grid.left / point.parameter
        begin = float(times[np.abs(point.orbit["x'"](times)).argmax()])  # far from where it turns or sticks
        state = np.array([point.orbit[name](begin) for name in ("x", "x'")]).ravel()
        end = followed(state, begin, point.parameter)
        growth = max(1.0, float(np.abs(point.multipliers).max()))
        claimed = max(1e-8, 10 * point.error.orbit)
        assert end == pytest.approx(state, abs=claimed * growth)
        judged += 1
    assert judged > 6


def followed(state: np.ndarray, begin: float, w: float) -> np.ndarray:
    """The state a period later."""
    t, y, end = begin, state.copy(), begin + 2 * np.pi / w
    side = np.sign(y[1])
    while t < end:

        def rates(s: float, z: np.ndarray, side: float = side) -> list[float]:
            if side == 0:
                return [0.0, 0.0]
            return [z[1], np.cos(w * s) - z[0] - DAMPING * z[1] - FRICTION * side]

        def wall(s: float, z: np.ndarray) -> float:
            return GAP - z[0]

        def turn(s: float, z: np.ndarray, side: float = side) -> float:
            pulled = np.cos(w * s) - z[0]
            return side * z[1] if side else FRICTION - abs(pulled)

        for event in (wall, turn):
            event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
        events = [turn] if side == 0 else [wall, turn]
        piece = scipy.integrate.solve_ivp(
            rates, (t, end), y, "DOP853", events=events, max_step=STEP, rtol=1e-12, atol=1e-13
        )
        t, y = float(piece.t[-1]), piece.y[:, -1].copy()
        if piece.status == 0:
            return y
        pulled = float(np.cos(w * t) - y[0])
        if side and len(piece.t_events[0]):
            y[1] *= -REBOUND
            side = np.sign(y[1])
        elif side:
            y[1] = 0.0
            side = 0.0 if abs(pulled) < FRICTION else np.sign(pulled)
        else:
            side = np.sign(pulled)
    return y
