"""Two masses with friction from one of them to the ground and between both, drawn at random and judged.

Where one friction stops, the other may be let go at the same instant, as the force on it jumps.
"""

from __future__ import annotations

import numpy as np
import pytest
from support.drawn.jointcases import JointCase, compiled
from support.drawn.joints import Attached, JointModel
from survey.rows import TOL, verdicts

import periodic as per

pytestmark = pytest.mark.drawn

BOUNDS = 0.35, 2.2


def drawn(seed: int, start: float) -> JointCase:
    """Two masses on springs, coupled, the force on the one that is not on the ground."""
    rng = np.random.default_rng(seed)
    k, between, ground, other = (
        float(rng.uniform(*ends)) for ends in ((0.8, 2.5), (0.2, 0.8), (0.1, 0.5), (0.05, 0.4))
    )
    links = ((0, None, 1.0, 0.06), (1, None, k, 0.06), (0, 1, between, 0.02))
    model = JointModel(
        seed=seed,
        mass=np.eye(2),
        damping=np.array([[0.08, -0.02], [-0.02, 0.08]]),
        stiffness=np.array([[1.0 + between, -between], [-between, k + between]]),
        places=(0, 1),
        links=links,
        forced=1,
        attached=tuple(
            Attached(kind="coulomb", i=0, to=to, limits=(limit,))
            for to, limit in ((None, ground), (1, other))
        ),
        bounds=BOUNDS,
    )
    return JointCase(compiled(model), model.record(), BOUNDS, start, model)


@pytest.mark.parametrize("start", BOUNDS)
@pytest.mark.parametrize("seed", [2, 3])
def test_through_the_range(seed: int, start: float) -> None:
    """Assert that each comes to the other end, and that no point is wrong: orbits and multipliers.

    Before, a stop at which the other friction is let go was judged as if that still held: branches ended.
    """
    case = drawn(seed, start)
    branch = per.trace(case.system, "Omega", BOUNDS, start=start, tol=TOL)
    assert branch.stop.reason is per.Reason.BOUND
    assert branch[-1].parameter == BOUNDS[start == BOUNDS[0]]
    found = verdicts(case, branch, seed, 5)
    assert (found.wrong, found.unjudged) == ([], [])
