"""The number of unstable multipliers by the winding of a determinant, against all multipliers."""

from __future__ import annotations

import numpy as np
import pytest
from support.cantilevers import cantilever, cubic

import periodic as per
from periodic.condensed.circle import Circle
from periodic.condensed.floquet import ModalFloquet
from periodic.condensed.variations import CondensedVariations


@pytest.mark.parametrize(("elements", "states"), [(2, 8), (100, 400)])
def test_winding_counts_the_unstable(elements: int, states: int) -> None:
    """Assert how many of 8 and of 400 multipliers lie outside the unit circle, and outside smaller ones."""
    system = cantilever(elements, cubic)
    branch = per.trace(system, "Omega", (3.0, 7.0), tol=1e-4, watch=per.Watch(stop={"LP": 2}))
    counts = []
    for point in (branch.points[0], next(p for p in branch.points if not p.stable and not p.label.critical)):
        found = CondensedVariations.about(system, point.orbit, ())
        moduli = np.abs(np.linalg.eigvals(ModalFloquet(found.given).monodromy))
        assert len(moduli) == states
        for radius in (1.0, 0.8, 0.3):
            assert Circle(found, radius).outside() == (moduli > radius).sum()
        counts.append(per.unstable(system, point.orbit))
    assert counts == [0, 1]
