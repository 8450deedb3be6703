"""What plain time integration settles to, and whether it has."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.traces import RPM, disc_system, duffing, duffing_system

import periodic as per
from reports.app.cli import main
from reports.app.sweep import SweepSettings, sweep
from reports.app.trace import picture, run


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


def test_sweep_of_a_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that --sweep draws what settles each way: on the upper sheet rising, on the lower falling."""
    seen: list[picture.Settlements] = []
    draw = run.draw
    monkeypatch.setattr(run, "SPEEDS", 5)
    monkeypatch.setattr(run, "draw", lambda *arguments: (seen.append(arguments[-1]), draw(*arguments)))
    values = ["--from", "1.2", "--to", "2.4", "--at", "1.5,1.8"]
    assert main(["trace", "duffing", *values, "--sweep", "--out", str(tmp_path)]) == 0
    ((rising, falling),) = seen
    assert [value for value, _ in rising] == pytest.approx([1.2, 1.5, 1.8, 2.1, 2.4])
    assert [value for value, _ in falling] == pytest.approx([2.4, 2.1, 1.8, 1.5, 1.2])
    branch = per.Branch.load(tmp_path / "branch.nc")
    for value, up, down in ((1.5, rising[1], falling[3]), (1.8, rising[2], falling[2])):
        sheets = sorted(p.maximum["x"] for p in branch.labelled(per.Label.USER) if p.parameter == value)
        assert len(sheets) == 3
        assert (down[1], up[1]) == pytest.approx((sheets[0], sheets[-1]), rel=1e-3)
