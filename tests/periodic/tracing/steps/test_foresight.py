"""What is foreseen of a branch: where brief excursions vanish, however short the steps."""

from __future__ import annotations

import pytest
from support.drawn.machines.drawn import machine

import periodic as per
import symbolic as sym


@pytest.mark.parametrize("ds", [0.02, 0.01])
def test_short_steps_lead_to_a_grazing(ds: float) -> None:
    """Assert that steps of less than an e-fold of an excursion's length end at its grazing.

    They led towards it for ever, each by the same factor, to the end of the branch at "two event nodes of the
    mesh met".
    """
    drawn = machine("gear pairs", 1)
    system, control = sym.compile(drawn.model), per.ArclengthControl(ds=ds, ds_max=ds)
    branch = per.trace(system, drawn.parameter, (5000.0, 6000.0), control=control)
    assert branch.stop.reason is per.Reason.BOUND
    usual = per.trace(system, drawn.parameter, (5000.0, 6000.0))
    grazings = [[p.parameter for p in found.labelled("GR")] for found in (branch, usual)]
    assert len(grazings[0]) >= 1
    assert grazings[0] == pytest.approx(grazings[1], rel=1e-7)
