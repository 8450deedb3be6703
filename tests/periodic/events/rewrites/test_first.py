"""The first rewrite on the way between two motions that are given: sines of one amplitude and another."""

from __future__ import annotations

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

from periodic.events.rewrites.first import first_change
from periodic.events.rewrites.rewrite import Begins
from periodic.events.rewrites.table import FIRST_SLIPS
from periodic.events.thresholds import AT_LEVEL
from periodic.orbit.orbit import Orbit
from periodic.system import HELD, Kind


@pytest.mark.parametrize("kind", [Kind.SLIDER, Kind.SLIDING])
@pytest.mark.parametrize("short", [0.5 * AT_LEVEL, 2 * AT_LEVEL, 0.1])
def test_first_slips_from_the_limit_itself(kind: Kind, short: float) -> None:
    """Assert that what is held all along begins to slip, however little short of its limits it is."""
    own = joint(kind=kind, place=(0, (1.0,)))
    system = Surfaces([own], [[1.0], [1.0], [1.0]], [0.0, -1.0, 1.0])

    def held(amplitude: float) -> Orbit:
        return along(lambda tau: amplitude * np.sin(tau)[:, None], modes=[(0, HELD)])

    change = first_change(system, held(1.0 - short), held(1.1), 1e-6)
    assert isinstance(change, Begins) and change.site.row is FIRST_SLIPS
    clear, past = short / (2 - short), 0.1 / 2.1  # as parts of the largest value of a limit
    assert change.part == pytest.approx(clear / (clear + past), rel=1e-6)
    assert first_change(system, held(0.8), held(0.9), 1e-6) is None
