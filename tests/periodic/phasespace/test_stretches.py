"""Stable stretches of branches, open and closed, and where motions are that do not come back."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.kept import kept

import periodic as per
import symbolic as sym
from periodic.phasespace.atlases.aperiodicranges import aperiodic_ranges
from periodic.phasespace.atlases.stretches import End, ends, stretches
from periodic.phasespace.motion import Sort
from periodic.results.stop import Reason

pytestmark = pytest.mark.usefixtures("users_kernels")


def branch(told: list[tuple[float, bool, str]], reason: Reason = Reason.BOUND) -> Any:
    """A branch of points that are given: parameter, whether stable, label."""
    points = [SimpleNamespace(parameter=p, stable=s, label=label) for p, s, label in told]
    return Listed(points, reason)


class Listed(list[Any]):
    """Points, and why they end."""

    def __init__(self, points: list[Any], reason: Reason) -> None:
        super().__init__(points)
        self.stop = SimpleNamespace(reason=reason)


def test_stretches_of_an_open_branch() -> None:
    """Assert numbers and ends of two stretches: an end of the range, folds, and a point without a label."""
    given = branch(
        [
            (0.0, True, "EP"),
            (1.0, True, "GR"),
            (2.0, False, "LP"),
            (1.5, False, ""),
            (1.0, False, "LP"),
            (1.2, True, ""),
            (1.3, True, ""),
            (1.4, False, ""),
        ]
    )
    assert stretches(given) == [0, 0, -1, -1, -1, 1, 1, -1]
    assert ends(given) == [(End(0.0, "EP"), End(2.0, "LP")), (End(1.0, "LP"), End(1.3, ""))]
    assert [str(end) for pair in ends(given) for end in pair] == ["0", "LP fold at 2", "LP fold at 1", "1.3"]


def test_stretch_through_the_start_of_a_closed_branch() -> None:
    """Assert that the first and the last points of an isola are one stretch, with both folds as its ends."""
    told = [
        (1.0, True, "EP"),
        (2.0, True, ""),
        (2.5, False, "LP"),
        (1.5, False, ""),
        (0.5, False, "LP"),
        (0.8, True, ""),
    ]
    given = branch([*told, (1.0, True, "EP")], Reason.CLOSED)
    assert stretches(given) == [0, 0, -1, -1, -1, 0, 0]
    assert ends(given) == [(End(0.5, "LP"), End(2.5, "LP"))]
    always = branch([(1.0, True, "EP"), (2.0, True, ""), (1.0, True, "EP")], Reason.CLOSED)
    assert stretches(always) == [0, 0, 0] and ends(always) == [(End(1.0, "EP"), End(1.0, "EP"))]
    assert ends(branch([(1.0, False, "EP")])) == []


@kept
def subharmonic() -> per.phasespace.Atlas:
    """The gear pair where motions of two periods lie beside those of one."""
    box = {"x": (-4, 4), "x'": (-4, 4)}
    given = {"count": 3, "diagram": 2, "starts": 24, "places": 0, "periods": 2}
    return per.atlas(sym.scene("gear-pair"), "Omega", (1.3, 2.1), box=box, **given)


def test_isola_of_an_atlas() -> None:
    """Assert the gear pair's isola of two periods: one stretch from fold to fold, where starts lead to it."""
    found = subharmonic()
    one, two = found.sheets
    assert (one.periods, two.periods) == (1, 2) and two.branch.stop.reason == Reason.CLOSED
    ((low, high),) = ends(two.branch)
    assert (low.label, high.label) == ("LP", "LP")
    assert (low.value, high.value) == (
        pytest.approx(1.36863495, abs=1e-6),
        pytest.approx(2.01142033, abs=1e-6),
    )
    assert two.shares.shape == (1, 3) and (two.shares[0] > 0).tolist() == [False, True, False]
    assert one.shares[0] + two.shares[0] == pytest.approx(1.0)
    assert "2a is stable from LP fold at 1.36863" in str(found)


def motions(*stable: Any, diverged: int = 0, undecided: int = 0) -> Any:
    """What was found at a value, of ten starts."""
    return SimpleNamespace(stable=stable, starts=10, diverged=diverged, undecided=undecided)


def motion(sort: Sort, rotation: float = np.nan, exponent: float = np.nan) -> Any:
    """A motion that does not come back."""
    return SimpleNamespace(sort=sort, point=None, rotation=rotation, exponent=exponent)


def test_ranges_of_what_does_not_come_back() -> None:
    """Assert neighbouring values in one line each: tori with their birth, chaos, escape, undecided."""
    values = np.array([1.0, 2.0, 3.0, 4.0])
    torus = [motion(Sort.TORUS, rotation=r) for r in (0.25, 0.3)]
    chaos = motion(Sort.CHAOTIC, exponent=0.5)
    found = [
        motions(diverged=2),
        motions(torus[0], diverged=10),
        motions(torus[1], chaos),
        motions(chaos, undecided=1),
    ]
    births = SimpleNamespace(labelled=lambda label: [SimpleNamespace(parameter=p) for p in (1.5, 7.0)])
    assert list(aperiodic_ranges(values, found, [births])) == [  # type: ignore[arg-type, list-item]
        "torus from 2 to 3, rotation number 0.25 to 0.3; NS at 1.5",
        "chaotic from 3 to 4, Lyapunov exponent 0.5 1/s",
        "grows beyond all bounds from 1 to 2: 20.0 to 100.0 % of the box",
        "undecided at 4: 10.0 % of the box",
    ]
