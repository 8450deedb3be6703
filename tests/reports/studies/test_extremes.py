"""The report on extremes: its rows are those of the code, its judge can tell wrong from right."""

from __future__ import annotations

import re
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from reference.piecewise import periodic
from support.fresh import TIME, assert_fresh
from support.stops import exactly

import periodic as per
import symbolic as sym
from reports.studies.extremes import multipliers, piecewise, vanderpol
from reports.studies.extremes.confirm import CVODES, FINE, Checked, check, compared, finer, near
from reports.studies.extremes.page import REPORT, STUDIES
from reports.studies.extremes.study import key_numbers
from reports.studies.extremes.survey import Case, Outcome, Row, survey
from reports.studies.extremes.words import domain, error, number
from reports.studies.pages.page import PAGE
from reports.studies.pages.text import FIGURES

pytestmark = pytest.mark.studies

FOLDER = REPORT.folder
FEW = per.ArclengthControl(max_points=20)

SURVEYED = {
    "seconds$": TIME,
    "(points|iterations|checked)$": 0.3,  # another machine's rounding lets steps end elsewhere
    # Errors, to a factor of ten: enough to tell 1e-9 from 1e-7. What is below the floor is noise.
    "error$|estimate$|floor$|smallest$": 0.9,
    "largest$": 1e-2,  # at the points that the steps chose
    "detail$": 1e-5,  # as many digits as it has
}
WHOLE = {"damping": SURVEYED, "grazing": {"multiplier_error$": TIME, "floor$": TIME} | SURVEYED}
"""Quick studies, computed whole; at grazing multipliers have two values, so that their error is none. The
floor there is that of the orbit with the least multiplier: all up to grazing have the same, but for rounding.
"""


@pytest.mark.parametrize("name", WHOLE)
def test_sections_are_fresh(name: str) -> None:
    """Assert that quick sections, computed whole, are what the page was made from."""
    assert_fresh(REPORT, name, WHOLE[name])


def test_brief_contacts_are_confirmed() -> None:
    """Assert that CVODES finds the multipliers where contact is lost by 1e-7: it restarts at event nodes.

    Otherwise it steps over them, and finds others by 2.7e-3 on some machines.
    """
    (case,) = (case for case in STUDIES["grazing"].cases() if case.value == -1e-7)
    system = case.system()
    found = case.confirm(system, case.trace(system, per.ArclengthControl()))
    assert found.right and found.by == CVODES
    assert found.multiplier_error < 1e-7


def kept(name: str) -> list[Row]:
    """Return the rows that the page was made from."""
    return [Row(**row) for row in REPORT.kept(FOLDER)[name].rows]


def assert_cell(name: str, case: Case) -> None:
    """Assert that a cell comes out as the page has it."""
    (row,) = [r for r in kept(name) if (r.value, r.way) == (case.value, case.way)]
    again = survey(case)
    assert (again.outcome, again.specials, again.check) == (row.outcome, row.specials, row.check)
    if row.largest is None:
        assert again.detail == row.detail and not again.points
        return
    assert again.largest == pytest.approx(row.largest, rel=1e-2)  # at the points that the steps chose
    assert again.error is not None and again.estimate is not None
    assert near(again.error, again.estimate) and near(row.error or 0.0, row.estimate or 0.0)


@pytest.mark.parametrize("name", [name for name in STUDIES if name not in WHOLE])
def test_quick_cells_are_fresh(name: str) -> None:
    """Assert that some cells of every other study, computed anew, are those of the page."""
    chosen = [case for case in STUDIES[name].cases() if case.value in STUDIES[name].quick]
    assert chosen
    for case in chosen:
        assert_cell(name, case)


@pytest.mark.long
@pytest.mark.parametrize("name", STUDIES)
def test_all_cells_are_fresh(name: str) -> None:
    """Assert that every cell comes out as the page has it; only where its time is up may vary."""
    cases, rows = STUDIES[name].cases(), kept(name)
    assert [(c.value, c.way) for c in cases] == [(r.value, r.way) for r in rows]
    for case, row in zip(cases, rows, strict=True):
        again = survey(replace(case, seconds=4 * case.seconds))
        assert again.outcome == row.outcome or "time" in row.detail


@pytest.mark.parametrize("name", STUDIES)
def test_numbers_follow_from_rows(name: str) -> None:
    """Assert that the numbers kept are those of the rows kept."""
    assert key_numbers(kept(name)) == pytest.approx(REPORT.kept(FOLDER)[name].numbers)


def test_page_is_that_of_its_sections() -> None:
    """Assert that text and numbers on the page are those of the code, that nothing is missing or too much."""
    page = (FOLDER / PAGE).read_text("utf-8")
    assert page == REPORT.text(FOLDER)
    assert tuple(REPORT.kept(FOLDER)) == tuple(REPORT.sections)
    shown = re.findall(rf"\]\({FIGURES}/([\w-]+\.png)\)", page)
    assert sorted(shown) == sorted(file.name for file in (FOLDER / FIGURES).iterdir())


def test_nothing_is_silently_wrong() -> None:
    """Assert that no branch on the page is wrong, and that every orbit on it was held against another."""
    for name in STUDIES:
        for row in kept(name):
            assert row.outcome != Outcome.WRONG.value, (name, row)
            assert row.outcome != Outcome.TRACED.value or (
                row.error is not None and near(row.error, row.estimate or 0.0)
            )


@pytest.mark.parametrize("mu", [1e-3, 1e-16, 1e-100, 1e4, 1e8, 1e14])
def test_multipliers_are_right_or_below_the_floor(mu: float) -> None:
    """Assert that every multiplier errs by no more than the noise floor, known exactly."""
    damped, unstable = (1.0, 1.0, -np.pi / np.log(mu)), (0.0, -1.0, 2 * np.pi / np.log(mu))
    damping_, stiffness, omega = damped if mu < 1 else unstable
    branch = multipliers.traced(omega, multipliers.system(damping_, stiffness), FEW)
    assert len(branch) >= 5
    for point in branch:
        exact = np.exp(2 * np.pi * multipliers.rates(damping_, stiffness) / point.parameter)
        away = np.abs(np.sort_complex(point.multipliers) - np.sort_complex(exact))
        assert (away <= point.floor).all()
        assert mu > 1e-100 or (np.abs(point.multipliers) <= point.floor).all()


def test_floor_is_not_large() -> None:
    """Assert that the floor leaves ordinary multipliers alone: below 1e-5 on a branch of the dry disc."""
    (case,) = [c for c in STUDIES["damping"].cases() if c.value == 0.1]
    branch = case.trace(case.system(), FEW)
    assert max(point.floor for point in branch) < 1e-5


def test_wrong_orbits_are_found() -> None:
    """Assert that an orbit moved by 1e-4 or more, and multipliers of another orbit, are not confirmed."""
    case = STUDIES["speed"].cases()[-1]
    system = case.system()
    branch = case.trace(system, per.ArclengthControl(max_points=3))
    point, other = branch[0], branch[-1]
    assert check(system, point, "speed", ()).right
    span = point.orbit.span()
    for change in (1e-3, 1e-4):
        knots = point.orbit.nodes + change * span, point.orbit.stages + change * span
        moved = replace(point, orbit=replace(point.orbit, nodes=knots[0], stages=knots[1]))
        found = check(system, moved, "speed", ())
        assert not found.right and found.error == pytest.approx(change, rel=0.05)
    assert other.multipliers != pytest.approx(point.multipliers, abs=1e-3)
    swapped = check(system, replace(point, multipliers=other.multipliers), "speed", ())
    assert not swapped.right and "multipliers" in swapped.verdict
    away, found_multipliers = finer(system, point, "speed", ())
    assert away < 1e-7 and found_multipliers == pytest.approx(point.multipliers, abs=1e-7)


def test_stability_is_judged() -> None:
    """Assert that a stable orbit whose true multiplier exceeds 1 is called wrong, a marginal one not."""
    (case,) = [c for c in STUDIES["damping"].cases() if c.value == 1.0]
    point = case.trace(case.system(), FEW)[0]
    claimed = replace(point, multipliers=np.array([0.9999, 0.1], dtype=complex))
    true = np.array([1.01, 0.1], dtype=complex)
    assert not compared(claimed, 0.0, true, CVODES).stable
    assert compared(claimed, 0.0, true * 0.99, CVODES).stable
    marginal = replace(claimed, multipliers=np.array([1 - 1e-12, 0.1], dtype=complex))
    assert compared(marginal, 0.0, true, CVODES).stable
    told = Checked(error=0.0, multiplier_error=0.0, near=True, stable=False, count=1, by=FINE)
    assert not told.right and "stability" in told.verdict


def test_outcomes() -> None:
    """Assert how refusals, warnings, short budgets and orbits that are not confirmed are recorded."""
    (case,) = [c for c in STUDIES["damping"].cases() if c.value == 0.1]

    def slow() -> sym.CompiledSystem:
        while True:
            pass

    def again(*given: Any) -> per.Branch:
        while True:  # an interrupt may be lost in CasADi, and come again
            case.trace(*given)

    def warned(*_: object) -> per.Branch:
        warnings.warn("overflow", RuntimeWarning, stacklevel=1)
        raise AssertionError

    def refused(*_: object) -> per.Branch:
        raise ValueError("start is 3; it must be 2")

    def lost(*_: object) -> Checked:
        return Checked(error=np.inf, multiplier_error=0.0, near=False, stable=True, count=1, by=FINE)

    def off(*_: object) -> Checked:
        return Checked(error=1e-3, multiplier_error=0.0, near=False, stable=True, count=1, by=FINE)

    assert survey(case).outcome == "traced"
    assert survey(replace(case, trace=refused)).detail == "start is 3; it must be 2"
    assert survey(replace(case, trace=refused)).outcome == "refused"
    assert survey(replace(case, trace=warned)).outcome == "wrong"
    assert survey(replace(case, points=5)).outcome == "cut short"
    assert survey(replace(case, trace=again, seconds=0.5)).outcome in ("cut short", "stopped")
    assert survey(replace(case, system=slow, seconds=0.02)).outcome == "cut short"
    assert survey(replace(case, confirm=lost)).outcome == "unconfirmed"
    assert survey(replace(case, confirm=off)).outcome == "wrong"


def test_domain_and_words() -> None:
    """Assert which run of values is the domain, and how numbers are said."""
    outcomes = ["stopped", "traced", "cut short", "wrong", "traced"]
    rows = [
        Row(value=10.0**k, way="", name="", outcome=outcome, detail="") for k, outcome in enumerate(outcomes)
    ]
    assert domain(rows) == "10 to 100"
    assert domain([replace(row, at_end=True) for row in rows]) == "10"
    two = [*rows, *(replace(row, way="dry") for row in rows[3:])]
    assert domain(two) == "10 to 100; dry: 1e4"
    assert domain(rows[:1]) == "none" and domain(rows[3:]) == "1e4"
    assert [number(v) for v in (1e4, 1e6, 1e-9, 810.0, 0.001)] == ["1e4", "1e6", "1e-9", "810", "0.001"]
    assert [number(v) for v in (273430.0, 2734.3, -1e-5, 0.0)] == ["273430", "2734.3", "-1e-5", "0"]
    assert error(3.4e-9) == "3e-9" and error(None) == "-" and error(0.0) == "< 1e-15"


def test_period_of_van_der_pol() -> None:
    """Assert the asymptotic period against DOP853 at mu = 10 to its own order, mu^-5/3."""
    assert vanderpol.period(10.0) == pytest.approx(19.0783695669, abs=3 * 10 ** (-5 / 3))
    assert vanderpol.period(1e4) == pytest.approx(16137.381218, abs=1e-5)


@pytest.mark.parametrize("stiffness", [1.0, 1e3])
def test_orbits_at_a_stop_in_closed_form(stiffness: float) -> None:
    """Assert orbit and multipliers of the study's closed form against that of the tests, past grazing."""
    phase, guess = 2.0, np.array([0.0, 0.7])
    state, monodromy = piecewise.orbit(stiffness, 0.72, phase, guess)
    exact = periodic(exactly(stiffness), 0.72, state, phase=phase)
    assert exact.highest[0] > 0
    assert state == pytest.approx(exact.start, abs=1e-11)
    assert monodromy == pytest.approx(exact.monodromy, rel=1e-7, abs=1e-7)
