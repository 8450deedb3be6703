"""What plain time integration settles to, and whether it has."""

from __future__ import annotations

import numpy as np
import pytest
from support.traces import RPM, disc_system, duffing, duffing_system

from reports.app.sweep import SweepSettings, sweep


def test_settled_motion_is_the_orbit() -> None:
    """Assert that a settled sweep lies on the branch."""
    motion = sweep(duffing_system(0.1, 1.0, 0.5), "Omega", [0.5, 0.6])
    assert [m.steady for m in motion] == [True, True]
    points = duffing(at=(0.5, 0.6)).special_points
    swings = {p.parameter: p.maximum["x"] for p in points}
    assert [m.maximum for m in motion] == pytest.approx([swings[0.5], swings[0.6]], rel=1e-3)


def test_slow_decay_is_not_taken_for_settled() -> None:
    """Assert that a motion which hardly changes from block to block, yet has far to go, is not settled."""
    settings = SweepSettings(most_blocks=6)
    (motion,) = sweep(disc_system("turbo33-2100N"), "speed", [480 * RPM], settings)
    assert not motion.steady
    assert motion.maximum - motion.minimum > 0
    assert np.isfinite([motion.minimum, motion.maximum]).all()
