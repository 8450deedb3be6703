"""Key numbers of the report's section on what the paper could not see."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from reference import squeeze
from support.kept import kept
from support.traces import RPM

import periodic as per
from reports.studies.paper import unseen
from reports.studies.paper.common.scenes import system
from reports.studies.paper.common.tracing import branch

pytestmark = pytest.mark.studies

FOLDS = {
    "vitrea79-810N": (237.486586, 252.035057),
    "vitrea79-2100N": (294.691534, 307.692770),
    "turbo33-810N": (198.557444, 253.316928, 134.600069, 141.078358),
    "turbo33-2100N": (262.362900, 308.491855, 164.201025, 165.596776),
}
DOUBLINGS = {
    "vitrea79-810N": (545.397607, 569.961132),
    "vitrea79-2100N": (651.170989, 665.878674),
    "turbo33-810N": (550.323755, 576.063621),
    "turbo33-2100N": (654.023249, 669.871355),
}
LOST = {
    "vitrea79-810N": 287.896,
    "vitrea79-2100N": 327.091,
    "turbo33-810N": 291.261,
    "turbo33-2100N": 328.932,
}


@kept
def numbers() -> dict[str, float]:
    """The section's key numbers, made once."""
    return unseen.numbers()


@pytest.mark.parametrize("name", FOLDS)
def test_folds(name: str) -> None:
    """Assert the folds of each disc; `test_upper_folds_by_shooting` checks three of them independently."""
    found = [numbers()[f"{name} fold {k} rpm"] for k in range(1, len(FOLDS[name]) + 1)]
    assert found == pytest.approx(list(FOLDS[name]), abs=2e-6)
    assert f"{name} fold {len(found) + 1} rpm" not in numbers()


REFERENCE = {
    "vitrea79-810N": squeeze.VITREA79,
    "vitrea79-2100N": replace(squeeze.VITREA79, preload=2100.0),
    "turbo33-810N": squeeze.TURBO33,
}


def determinants(name: str, near: tuple[float, ...]) -> np.ndarray:
    """det(I - M) of shot orbits at speeds (rev/min) beside the upper fold: a row for each, sheet by sheet.

    Shooting starts from the traced orbits, found on a short branch round the fold.
    """
    points = list(branch(name))
    turn = next(k for k, point in enumerate(points) if point.label is per.Label.FOLD)
    fold = points[turn].parameter
    begin = [point for point in points[:turn] if point.parameter > 1.005 * fold][-1]
    bounds, at = (0.99 * fold, begin.parameter), [rpm * RPM for rpm in near]
    traced = per.trace(system(name), "speed", bounds, at=at, guess=begin.orbit)
    found = np.full((len(near), 2), np.nan)
    for row, rpm in enumerate(near):
        both = [p for p in traced.labelled(per.Label.USER) if p.parameter == rpm * RPM]
        for column, point in enumerate(both):
            scene = REFERENCE[name].at(rpm)
            start = squeeze.state_from_xvh(scene, point.orbit.state(np.zeros(1))[0])
            shot = squeeze.periodic_orbit(scene, start)
            found[row, column] = np.linalg.det(np.eye(3) - shot.monodromy)
    return found


@pytest.mark.parametrize(
    "name", [n if n == "vitrea79-810N" else pytest.param(n, marks=pytest.mark.long) for n in REFERENCE]
)
def test_upper_folds_by_shooting(name: str) -> None:
    """Assert that det(I - M) of shot orbits vanishes, with another sign on each sheet, at the upper fold.

    Its square (half the difference of the sheets) grows linearly with the distance from the fold.
    """
    near = (FOLDS[name][0] * (1 + 1e-5), FOLDS[name][0] * (1 + 2e-5))
    found = determinants(name, near)
    assert (found[:, 0] > 1e-3).all() and (found[:, 1] < -1e-3).all()
    squares = (found[:, 0] - found[:, 1]) ** 2
    zero = near[0] - squares[0] * (near[1] - near[0]) / (squares[1] - squares[0])
    assert zero * RPM == pytest.approx(branch(name).labelled(per.Label.FOLD)[0].parameter, rel=1e-8)


@pytest.mark.parametrize("name", DOUBLINGS)
def test_doublings(name: str) -> None:
    """Assert the band in which the small motion of each disc is unstable."""
    found = [numbers()[f"{name} doubling {k} rpm"] for k in (1, 2)]
    assert found == pytest.approx(list(DOUBLINGS[name]), abs=2e-5)


@pytest.mark.parametrize("name", LOST)
def test_loss_of_contact(name: str) -> None:
    """Assert where each disc first loses contact: there the least load is a thousandth of the preload."""
    assert numbers()[f"{name} contact lost below rpm"] == pytest.approx(LOST[name], abs=2e-3)


def test_doubled_orbits() -> None:
    """Assert that the traced orbit of two periods is the simulated motion, and where its branch ends."""
    found = numbers()
    traced, simulated = found["doubled orbit at 500 rpm x um"], found["simulated motion at 500 rpm x um"]
    assert traced == pytest.approx(simulated, rel=1e-6)
    assert traced == pytest.approx(24.975666, abs=1e-5)
    assert found["doubled orbits fold rpm"] == pytest.approx(449.410772, abs=1e-5)


def test_labelled_orbits() -> None:
    """Assert that the six orbits are what their captions say."""
    orbits = unseen.labelled()
    assert list(orbits) == list("ABCDEF")
    assert [point.stable for point in orbits.values()] == [True, True, True, False, False, True]
    lost = [point.minimum["load"] < 1e-3 * 810 for point in orbits.values()]
    assert lost == [False, False, True, True, True, False]


def test_load_comes_back() -> None:
    """Assert how fast the load rises to the preload after a loss of contact, on a finer sampling by hand."""
    point = unseen.labelled()["D"]
    tau, values = unseen.along(point.orbit, 100001)
    load = values["load"] / 810
    (risen,) = np.flatnonzero((load[1:] >= 1) & (load[:-1] < 1))
    left = np.flatnonzero(load[:risen] < 1e-3)[-1]
    assert unseen.return_phase(point) == pytest.approx(tau[risen] - tau[left], abs=6e-4)
    assert numbers()["load back within rad"] == pytest.approx(1.559, abs=1e-3)


def test_damping_grows_with_loss_of_contact() -> None:
    """Assert that damping from the multipliers is the Jacobian's size at first and grows twentyfold."""
    curve = unseen.damping("vitrea79-810N")
    assert curve[0][1] == pytest.approx(0.00832, rel=1e-2)
    assert curve[-1][1] > 0.19
