"""A change of pattern that the table does not have: the word is read from the motion, and the branch goes on.

A row is taken out of the table, so that its changes are of the kind that nobody foresaw.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from support.drawn.jointcases import DOWN, JointCase, drawn_joints

import periodic as per
from periodic.correction.change import Change
from periodic.events.rewrites import first
from periodic.events.rewrites.ends import Excursion
from periodic.events.rewrites.sites import Site
from periodic.events.violations import Violation
from periodic.orbit.orbit import Orbit
from periodic.system import System
from periodic.tracing import continuation

TOL = 1e-6


@cache
def _case(seed: int) -> JointCase:
    return drawn_joints(DOWN, seed)


def _traced(seed: int) -> per.Branch:
    """The branch through its whole range, with a point midway."""
    case = _case(seed)
    middle = sum(case.bounds) / 2
    return per.trace(case.system, "Omega", case.bounds, start=case.start, at=middle, tol=TOL)


@cache
def _with_all_rows(seed: int) -> per.Branch:
    return _traced(seed)


def _without(monkeypatch: pytest.MonkeyPatch, row: str, met: list[str]) -> None:
    """Take a row out of the table; `met` then lists where it would have been used."""
    begins, ending, reread = first.begins, first._ending, continuation.reread

    def no_onset(system: System, orbit: Orbit, violation: Violation) -> Site | None:
        site = begins(system, orbit, violation)
        if site is None or site.row.name != row:
            return site
        met.append("begins")
        return None

    def no_end(
        system: System, before: Orbit, after: Orbit, shortest: float, excursion: Excursion
    ) -> Change | None:
        if excursion.row.name == row:
            met.append("ends")
            return None
        return ending(system, before, after, shortest, excursion)

    def read_again(*given: object, **more: object) -> object:
        met.append("read")
        return reread(*given, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(first, "begins", no_onset)
    monkeypatch.setattr(first, "_ending", no_end)
    monkeypatch.setattr(continuation, "reread", read_again)


@pytest.mark.parametrize(
    ("seed", "row"),
    [
        (120, "grazing-sliding"),
        (127, "two events change places"),
        (135, "grazing-sliding"),
        (135, "switching-sliding"),
        (155, "grazing-sliding"),
        (155, "adding-sliding"),
        (170, "adding-sliding about another event"),
        (150, "grazing of a limit"),
    ],
)
def test_branch_goes_on_without_the_row(seed: int, row: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it reaches the end of its range, and there and midway has the same orbits.

    Their peaks to peak agree to 1e-6 of the largest, their multipliers to 1e-5: both are of two meshes.
    """
    whole, met = _with_all_rows(seed), list[str]()
    assert whole.stop.reason is per.Reason.BOUND
    _without(monkeypatch, row, met)
    other = _traced(seed)
    assert "begins" in met or "ends" in met
    assert other.stop.reason is per.Reason.BOUND, str(other.stop)
    ends = [per.Label.END, per.Label.USER]
    ours, theirs = ([p for p in branch if p.label in ends] for branch in (whole, other))
    assert [p.label for p in ours] == [p.label for p in theirs] and len(ours) >= 3
    for one, two in zip(ours, theirs, strict=True):
        assert one.parameter == pytest.approx(two.parameter, rel=1e-12)
        peaks = np.array([[p.maximum[name] - p.minimum[name] for name in p.maximum] for p in (one, two)])
        assert np.abs(peaks[0] - peaks[1]).max() <= 1e-6 * peaks.max()
        each = [np.sort(np.abs(p.multipliers)) for p in (one, two)]
        assert np.abs(each[0] - each[1]).max() <= 1e-5
