"""Curves of grazing orbits in two parameters, at which a stop is just reached: known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from support.stops import DAMPING, stopped
from support.traces import duffing_system

import periodic as per


@pytest.mark.parametrize("stiffness", [5.0, 1e3])
def test_force_at_which_a_stop_is_grazed(stiffness: float) -> None:
    """Assert F = gap |1 - W^2 + i c W| along the curve of GR over the frequency, to 7 digits."""
    system = stopped(stiffness)
    branch = per.trace(system, "Omega", (0.3, 0.8), watch=per.Watch(stop={"GR": 1}), tol=1e-8)
    (point,) = branch.labelled("GR")
    condition = per.GrazingCondition(system.switches[0].name)
    curve = per.trace(system, "Omega", (0.2, 0.9), guess=point.orbit, determined={"F": condition}, tol=1e-8)
    assert {curve[0].parameter, curve[-1].parameter} == {0.2, 0.9}
    W = curve.values
    assert curve.column("F") == pytest.approx(np.abs(1 - W**2 + 1j * DAMPING * W), rel=1e-7)
    assert all(p.maximum["q"] == pytest.approx(1.0, rel=1e-7) for p in curve)
    decay = np.exp(-np.pi * DAMPING / W)
    assert [abs(p.multipliers[0]) for p in curve] == pytest.approx(decay, rel=1e-6)


def test_switch_that_there_is_not() -> None:
    """Assert that a switch is refused by name which the system does not have."""
    condition = {"F": per.GrazingCondition("wall")}
    with pytest.raises(ValueError, match="^switch is 'wall'; it must be one of none, as the system has no"):
        per.trace(duffing_system(0.1, 1.0, 0.5), "Omega", (0.5, 1.0), determined=condition)
    known = stopped(5.0).switches[0].name
    with pytest.raises(ValueError, match=f"^switch is 'wall'; it must be one of {known}$"):
        per.trace(stopped(5.0), "Omega", (0.5, 1.0), determined=condition)


def test_doubling_that_sits_on_grazing() -> None:
    """Assert that a stop 1e4 times as stiff, whose grazing makes the orbit unstable, has a PD at the GR."""
    branch = per.trace(stopped(1e4), "Omega", (0.3, 0.8), watch=per.Watch(stop={"PD": 1}))
    graze, double = (p for p in branch.special_points if p.label is not per.Label.END)
    assert (graze.label, double.label) == ("GR", "PD") and graze.parameter == double.parameter
    assert str(branch.stop) == "stopped as asked: PD met 1 time"
    assert branch.unaccounted == ()
