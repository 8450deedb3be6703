"""Models with contact drawn at random: what their branches claim, judged in closed form.

Every branch's ledger balances (tests/conftest.py sees to that too), and orbits and multipliers of points
drawn from it are those of an event-exact integration that shares nothing with the packages.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from reference.judging import judged
from support.drawn.contact import Case, drawn
from support.grids import spread
from survey.rows import FEW, TOL, row, traced, verdicts

import periodic as per
from periodic import Reason
from periodic.bifurcations.location import special_points
from periodic.bifurcations.turningpoint import Found
from periodic.collocation.rounding import of_events
from periodic.correction.change import Beyond
from periodic.events.eventrows import event_rows
from periodic.events.rewrites.rewrite import Ends
from periodic.events.rewrites.table import REVERSAL
from periodic.orbit.orbit import Orbit
from periodic.stability.multipliers import Spectrum
from periodic.system import System
from periodic.tracing.steps import taken


def wrong(case: Case, branch: per.Branch, seed: int) -> list[str]:
    """What the branch leaves unsaid or claims that is not so."""
    found = verdicts(case, branch, seed)
    told = [*(f"unaccounted: {gap}" for gap in branch.unaccounted), *found.wrong, *found.unjudged]
    return [f"{case.told}: {said}" for said in told]


SAMPLE = [
    ("clearances", 2),
    ("gears", 0),
    ("gears", 2),
    ("impacts", 0),
    ("friction", 3),
    ("chains", 4),
    ("friction", 119),
    ("friction", 100),
    ("jumps", 105),
    ("jumps", 111),
]


@pytest.mark.parametrize(("kind", "seed"), spread(SAMPLE, 4))
def test_some(kind: str, seed: int) -> None:
    """Assert it of one of each kind, and that they are traced to their ends."""
    case = drawn(kind, seed)
    branch = traced(case)
    assert branch.stop.reason is Reason.BOUND
    assert wrong(case, branch, seed) == []


SHORT_STOPS = [(4, 0.7730, 0.7690, 1), (4, 0.77166, 0.7700, 0), (106, 0.6830, 0.6815, 1), (133, 0.7, 0.6, 0)]
"""Seeds, stretches of the branch in which a stop begins or ends, and how often one grazes there (GR)."""


@pytest.mark.drawn
@pytest.mark.parametrize(("seed", "begin", "end", "grazings"), SHORT_STOPS)
def test_stops_however_short(seed: int, begin: float, end: float, grazings: int) -> None:
    """Assert multipliers where sliding just stops: they jump there, and no stop is too short to be seen.

    At grazing itself they have two values.
    """
    case = drawn("friction", seed)
    bounds = (min(begin, end), max(begin, end))
    branch = per.trace(case.system, "Omega", bounds, start=begin, tol=TOL, control=FEW.control)
    assert branch.stop.reason is Reason.BOUND
    assert len(branch.labelled(per.Label.GRAZING)) == grazings
    for point in branch:
        if point.label is not per.Label.GRAZING:
            assert judged(case.exact, point, case.names).wrong(point, TOL) == ""


@pytest.mark.long
def test_goes_on_without_a_contact() -> None:
    """Assert that a branch goes on where a contact has ended, not back with it: it grazes there yet."""
    branch = traced(drawn("chains", 123))
    values = [point.parameter for point in branch]
    end = next(k for k, value in enumerate(values) if abs(value - 1.0820931653) < 1e-9)
    assert branch[end].label is per.Label.GRAZING
    assert all(np.diff(values[end - 5 : end + 5]) > 0)


@pytest.mark.long
def test_folds_beside_grazing() -> None:
    """Assert both folds where the branch turns back at a first impact and on again 5e-5 beyond it."""
    case = drawn("impacts", 132)
    branch = per.trace(case.system, "Omega", (0.75, 0.7556), start=0.75, tol=TOL, control=FEW.control)
    found = [(point.label.value, round(point.parameter, 4)) for point in branch.special_points]
    assert found == [("EP", 0.75), ("GR", 0.7547), ("LP", 0.7547), ("LP", 0.7546), ("EP", 0.7556)]
    assert wrong(case, branch, 132) == []


@pytest.mark.drawn
def test_impact_and_end_of_a_contact_swap() -> None:
    """Assert that a branch goes on where an impact comes to lie before the end of a contact, not after it.

    Before that another contact is grazed a short way after one that is deeper (impacts 104, Omega 0.536).
    """
    case = drawn("impacts", 104)
    control = per.ArclengthControl(max_points=90)
    branch = per.trace(case.system, "Omega", (0.5, case.start), start=case.start, tol=TOL, control=control)
    struck = [point for point in branch if len(point.orbit.phases) > 4]
    beside = [point for point in struck if abs(point.parameter - 0.5463) < 3e-4]
    orders = [[event.switch for event in point.orbit.mesh.events] for point in beside]
    assert orders[0] == [0, 1, 0, 1, 0] and orders[-1] == [0, 1, 0, 0, 1]
    for point in beside:
        assert judged(case.exact, point, case.names).wrong(point, TOL) == ""


@pytest.mark.long
@pytest.mark.parametrize(("seed", "reason"), [(104, None), (132, None), (139, Reason.BOUND)])
def test_impacts_that_follow_each_other(seed: int, reason: Reason | None) -> None:
    """Assert all points of branches with up to 18 impacts in a row, and the ledger; two end where these
    are without number."""
    case = drawn("impacts", seed)
    branch = traced(case)
    assert reason in (None, branch.stop.reason)
    assert max(len(point.orbit.phases) for point in branch) >= 9
    found = verdicts(case, branch, seed, len(branch))
    assert (found.wrong, found.unjudged, list(branch.unaccounted)) == ([], [], [])


@pytest.mark.drawn
def test_last_digits_of_the_parameter() -> None:
    """Assert that errors tell what the parameter's last digits are to multipliers beside grazing, 2e-7."""
    case = drawn("clearances", 130)
    grazed = 1.715949071
    beside = [point for point in traced(case) if 1e-10 < point.parameter - grazed < 1e-7]
    assert beside
    for point in beside:
        assert judged(case.exact, point, case.names).multipliers < max(1e-8, 3 * point.error.by_orbit)


def briefest(branch: per.Branch) -> list[float]:
    """The shortest stretch between event nodes (rad) of each point."""
    return [float(point.orbit.mesh.segment_lengths(point.orbit.phases).min()) for point in branch]


BESIDE = 1.0920005367814
"""Where the contact of chains 1019 ends; 5e-11 beside it lies a fold, of a contact of 1e-4 rad."""


@pytest.mark.drawn
def test_contact_ends_beside_a_fold() -> None:
    """Assert that a step may end at both, and that no shorter contact is followed; all points are judged."""
    case = drawn("chains", 1019)
    branch = traced(case)
    assert branch.stop.reason is Reason.BOUND
    assert min(briefest(branch)) > 9e-5
    beside = [p for p in branch.special_points if abs(p.parameter - BESIDE) < 1e-10]
    assert [point.label for point in beside] == [per.Label.GRAZING, per.Label.FOLD]
    assert wrong(case, branch, len(branch)) == []


@pytest.mark.drawn
@pytest.mark.parametrize("ends_below", [None, 0.0])
def test_contact_that_is_brief_already(ends_below: float | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it ends where a step has gone past where contacts do, and no false label on the way.

    Also where the grazing that is foreseen within it, which is its end, is not known to be that.
    """
    case = drawn("chains", 1019)
    monkeypatch.setattr(taken, "special_points", _never_final)
    if ends_below is not None:
        monkeypatch.setattr(per.Collocation, "ends_below", ends_below)
    branch = traced(case)
    beside = [p for p in branch.special_points if abs(p.parameter - BESIDE) < 1e-10]
    assert min(briefest(branch)) < 9e-5
    assert [p.label for p in beside] == [per.Label.FOLD, per.Label.GRAZING]
    assert branch.stop.reason is Reason.BOUND
    assert verdicts(case, branch, 1019, len(branch)).wrong == []


@pytest.mark.drawn
def test_contact_that_is_rounding() -> None:
    """Assert that nothing is claimed of multipliers where rounding decides how long a contact is."""
    case = drawn("chains", 1019)
    point = min(traced(case), key=lambda point: min(briefest([point])))
    orbit, lengths = point.orbit, point.orbit.mesh.segment_lengths(point.orbit.phases)
    phases, brief = orbit.phases.copy(), int(lengths.argmin())
    phases[(brief + 1) % len(phases)] += 1e-12 - lengths[brief]
    spectrum = Spectrum(np.array([np.eye(orbit.nodes.shape[1])] * len(orbit.nodes)))
    briefer = replace(orbit, phases=phases)
    told, untold = (of_events(o, event_rows(case.system, o, ()), spectrum) for o in (orbit, briefer))
    assert np.isfinite(told) and np.isinf(untold)


def _never_final(*given: Any) -> list[Found]:
    """Special points of a step that knows nothing of a change of pattern at its end."""
    solver, base, new, ds, sought = given
    return special_points(solver, base, new, ds, replace(sought, final=False))


@pytest.mark.long
def test_rounding_beside_grazing() -> None:
    """Assert orbits to 1e-14 and multipliers from a contact of 1e-4 rad on, to what is claimed, at k = 2e4.

    Rounding of 1e-13 in the states was 1.6e-5 in the multipliers.
    """
    case = drawn("chains", 141)
    control = per.ArclengthControl(max_points=121)
    branch = per.trace(case.system, "Omega", (1.774, case.start), start=case.start, tol=TOL, control=control)
    beside = [point for point in branch if 1e-11 < point.parameter - 1.774230035478 < 1e-6]
    assert len(beside) >= 4
    for point in beside:
        verdict = judged(case.exact, point, case.names)
        assert verdict.orbit < 1e-14
        assert verdict.multipliers < max(1e-8, point.error.multiplier)


@pytest.mark.long
@pytest.mark.unaccounted
@pytest.mark.parametrize(
    ("kind", "seeds"),
    [
        *[("clearances", range(k, k + 10)) for k in range(100, 300, 10)],
        *[
            (kind, range(k, k + 10))
            for kind in ("gears", "impacts", "friction", "jumps")
            for k in range(100, 200, 10)
        ],
        *[("chains", range(k, k + 10)) for k in range(100, 200, 10)],
    ],
)
def test_seven_hundred(kind: str, seeds: Iterable[int], capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that of 600 models and 100 chains none is wrong, and print how far they are traced and why."""
    rows = [row(kind, seed) for seed in seeds]
    with capsys.disabled():
        print(f"\n{kind} {seeds}, {sum(each.seconds for each in rows):.0f} s")
        for each in rows:
            print(f"  {each.seed}  {each.points} points, {each.told}")
    assert [(each.seed, said) for each in rows for said in (*each.wrong, *each.gaps, *each.unjudged)] == []


@pytest.mark.drawn
def test_what_ends_where_friction_turns_leaves_the_mesh(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that beyond the end of an excursion each mesh that is tried lacks its event nodes."""
    gone, beyond = [], Ends.beyond

    def noted(end: Ends, system: System, orbit: Orbit) -> Iterator[Beyond]:
        for found in beyond(end, system, orbit):
            if end.site.row is REVERSAL:
                gone.append(len(orbit.mesh.events) - len(found.mesh.events))
            yield found

    monkeypatch.setattr(Ends, "beyond", noted)
    traced(drawn("friction", 119))
    assert gone and min(gone) >= 2
