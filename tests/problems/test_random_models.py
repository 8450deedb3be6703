"""Scenes and models drawn at random: each trace ends for a true named reason, each orbit stands in time.

No warning is allowed (pytest makes errors of them), no number that is not finite, no stability that the
monodromy matrix of a time integration does not have.
"""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from reference.confirmation import Integrator
from support.drawn.models import Case, drawn
from support.grids import spread

import periodic as per
from periodic import Reason
from periodic.results import netcdf as storage
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

STEP = per.ArclengthControl(max_points=30, max_newton=600)

CONFIRMED = 3
"""Orbits of each branch that are confirmed."""

CLOSENESS = 1e-3
"""Multipliers nearer to the unit circle are not counted, on either side."""

MAY_BE_NAN = {"trivial"}
"""Variables of a branch that not every orbit has."""


def accuracy_of(seed: int) -> per.Accuracy:
    """Draft for even seeds, standard for odd ones."""
    return per.Accuracy.STANDARD if seed % 2 else per.Accuracy.DRAFT


def check(kind: str, seed: int) -> Reason:
    """Trace a case and check all that can be; return why it ended."""
    case, accuracy = drawn(kind, seed), accuracy_of(seed)
    branch = per.trace(
        case.system, case.parameter, case.bounds, start=case.start, tol=accuracy, control=STEP, **case.options
    )
    check_stop(case, branch)
    check_finite(branch)
    random = np.random.default_rng(seed)
    integrator = Integrator(case.system)
    for k in random.choice(len(branch), size=min(CONFIRMED, len(branch)), replace=False):
        check_point(integrator, branch[int(k)], accuracy.value, random)
    return branch.stop.reason


def check_stop(case: Case, branch: per.Branch) -> None:
    """Assert that the reason is true."""
    reason, points = branch.stop.reason, branch.points
    assert branch.stop.detail
    assert all(case.bounds[0] <= p.parameter <= case.bounds[1] for p in points)
    if reason is Reason.BOUND:
        assert points[-1].label is per.Label.END and points[-1].parameter in case.bounds
    elif reason is Reason.MAX_POINTS:
        assert len(points) - len(branch.special_points) >= STEP.max_points - 2
    elif reason is Reason.MAX_NEWTON:
        assert STEP.max_newton < branch.newton_iterations <= STEP.max_newton + 16
    elif reason is Reason.EQUILIBRIUM:
        assert case.options and points[-1].label is per.Label.HOPF
    elif reason is Reason.NO_START:
        assert not points
    else:
        assert reason in (Reason.SMALL_STEP, Reason.INACCURATE)
        assert not points or points[-1].label is per.Label.FAILED


def check_finite(branch: per.Branch) -> None:
    """Assert that every number of a branch is finite, as it would be written to a file."""
    for name, (_, values) in storage.tables(branch).items():
        if values.dtype.kind == "f" and name not in MAY_BE_NAN:
            assert np.isfinite(values).all(), name


def check_point(
    integrator: Integrator, point: per.Point, tolerance: float, random: np.random.Generator
) -> None:
    """Assert that an orbit comes back in time to its tolerance, with the same multipliers."""
    orbit = point.orbit
    tau = integrator.well_posed(orbit, orbit.grid.left[0] + random.uniform(0, orbit.mesh.period, size=12))
    found = integrator.once_round(orbit, tau)
    assert np.abs(found.gap).max() <= 2 * tolerance * orbit.span() * max(1.0, found.growth)
    own, theirs = np.abs(point.multipliers), np.abs(found.multipliers)
    apart = 20 * point.error.multiplier + 10 * tolerance + integrator.uncertainty * found.growth
    assert theirs[0] == pytest.approx(own[0], rel=apart, abs=apart)
    if not (np.abs(np.concatenate([own, theirs]) - 1) < max(CLOSENESS, 2 * apart)).any():
        assert (own > 1).sum() == (theirs > 1).sum()
        assert point.stable == (theirs < 1).all()


FAST = [
    *(("disc", seed) for seed in (0, 2, 4, 5, 7)),
    *(("chain", seed) for seed in range(4)),
    *(("cycle", seed) for seed in range(3)),
]


@pytest.mark.parametrize(("kind", "seed"), spread(FAST, 4))
def test_a_dozen(kind: str, seed: int) -> None:
    """Assert it of twelve cases."""
    check(kind, seed)


@pytest.mark.long
@pytest.mark.parametrize("block", range(20))
@pytest.mark.parametrize(("kind", "share"), [("disc", 12), ("chain", 8), ("cycle", 5)])
def test_five_hundred(kind: str, share: int, block: int) -> None:
    """Assert it of 500, and that with hardly any of them the method fails before its work is spent."""
    failed: list[str] = []
    reasons: Counter[Reason] = Counter()
    for seed in range(100 + block * share, 100 + (block + 1) * share):
        try:
            reasons[check(kind, seed)] += 1
        except Exception as error:
            failed.append(f"{kind} {seed}: {type(error).__name__} {str(error)[:300]}")
    assert not failed, "\n".join(failed)
    assert sum(reasons[r] for r in (Reason.NO_START, Reason.SMALL_STEP, Reason.INACCURATE)) <= 1, reasons


@pytest.mark.parametrize("values", [{"preload": 0.0}, {"preload": -5.0}, {"mass": 0.0}])
def test_outside_the_domain(values: dict[str, float]) -> None:
    """Assert that equations without meaning end in a named reason, without a point or a warning."""
    options = {"values": values, "tol": per.Accuracy.DRAFT, "control": STEP}
    branch = per.trace(build(load("dry-810N")), "speed", (20.0, 50.0), start=50.0, **options)
    assert len(branch) == 0 and branch.stop.reason in (Reason.NO_START, Reason.MAX_NEWTON)


def test_out_of_the_domain() -> None:
    """Assert that a branch that is followed to where its equations end is cut there, with finite numbers.

    There, without preload, the orbits have no size any more.
    """
    options = {"tol": per.Accuracy.DRAFT, "control": per.ArclengthControl(ds=0.1, max_points=80)}
    system = build(load("dry-810N"))
    values = {"speed": 40.0}
    branch = per.trace(system, "preload", (-100.0, 810.0), start=810.0, values=values, **options)
    check_finite(branch)
    assert branch.stop.reason is Reason.VANISHED and not branch.unaccounted
    assert 0 < branch.values.min() < 1e-12 and branch.values.min() == branch[-1].parameter
    assert branch[-1].orbit.span() < 1e-13
