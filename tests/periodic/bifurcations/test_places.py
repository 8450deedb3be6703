"""What is decided of special points within a step, of solutions that are given: by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.bifurcations import branchcrossing, ledger, location, testfunction, turningpoint
from periodic.bifurcations.label import Label
from periodic.bifurcations.ledger import Entry
from periodic.bifurcations.turningpoint import Found
from periodic.bifurcations.withinstep import RejectedError, WithinStep, _NoOrbitError
from periodic.stability.multipliers import ERRORS_FROM_ONE, ROUNDED_ONE, Stability


def at(value: float, slope: float = 1.0, **more: Any) -> Any:
    """A solution at a parameter with a slope of it; `margin` is what test functions of these tests are."""
    found = SimpleNamespace(value=value, tangent=SimpleNamespace(parameter=slope), **more)
    found.once = lambda function: function(found)
    return found


def margin(**more: Any) -> testfunction.TestFunction:
    """The test function whose value a solution has."""
    return testfunction.TestFunction(label=Label.TORUS, value=lambda solution: solution.margin, **more)


class Within:
    """A step on which the margin is a function of the distance."""

    def __init__(self, function: Any, ds: float = 1.0) -> None:
        self.function = function
        self.base, self.new = self.at(0.0), self.at(ds)

    def at(self, distance: float, nearest: bool = False) -> Any:
        """The solution at a distance."""
        return at(distance, margin=self.function(distance), distance=distance)


@pytest.fixture
def located(monkeypatch: pytest.MonkeyPatch) -> list[tuple[float, float]]:
    """The spans in which zeros are located."""
    spans: list[tuple[float, float]] = []

    def noted(within: Any, span: Any, ds: float, test: Any) -> list[Any]:
        spans.append(span)
        return [span]

    monkeypatch.setattr(location, "_located", noted)
    return spans


NEVER = testfunction.Course()


def test_a_change_of_sign_is_located(located: list[tuple[float, float]]) -> None:
    """Assert the whole step as the span of one, and no span of a function of one sign."""
    falls: Any = Within(lambda d: 0.4 - d)
    assert location._where(falls, falls.new, 1.0, margin(), NEVER) == [(0.0, 1.0)]
    stays: Any = Within(lambda d: 2.0 - d)
    assert location._where(stays, stays.new, 1.0, margin(), NEVER) == []
    assert located == [(0.0, 1.0)]


def test_two_changes_of_sign_are_located_on_either_side(located: list[tuple[float, float]]) -> None:
    """Assert the spans about a place where (d - 0.4)(d - 0.6) is negative, if it is looked for."""
    dips: Any = Within(lambda d: (d - 0.4) * (d - 0.6))
    assert location._where(dips, dips.new, 1.0, margin(), NEVER) == []
    found = location._where(dips, dips.new, 1.0, margin(twice=lambda *_: True), NEVER)
    assert len(found) == 2 and located == found
    (begin, between), (same, end) = found  # type: ignore[misc]
    assert begin == 0.0 and end == 1.0 and between == same and 0.4 < between < 0.6
    # The parabola through 0.24 at 0 and 1 and the value one step before tells it too.
    course = testfunction.Course(1.0, {"NS ": 2.24})
    assert len(location._where(dips, dips.new, 1.0, margin(), course)) == 2


def test_a_margin_that_is_not_known_is_not_looked_at(located: list[tuple[float, float]]) -> None:
    """Assert it of 0 at the base, and of 0 at the end to which it does not fall."""
    sudden: Any = Within(lambda d: 0.0 if d == 1.0 else 1.0)
    assert location._where(sudden, sudden.new, 1.0, margin(twice=lambda *_: True), NEVER) == []
    begins: Any = Within(lambda d: 0.0 if d == 0.0 else 1.0)
    assert location._where(begins, begins.new, 1.0, margin(twice=lambda *_: True), NEVER) == []
    assert located == []


def test_a_step_that_ends_at_a_special_point_is_shortened(located: list[tuple[float, float]]) -> None:
    """Assert it of a margin that falls to 0 at the end: it is 0.1 of that at the base at 0.9 of the step."""
    ends: Any = Within(lambda d: 1.0 - d)
    with pytest.raises(RejectedError, match="the step ends at a special point") as caught:
        location._where(ends, ends.new, 1.0, margin(), NEVER)
    assert caught.value.shorter == 0.9


def test_place_of_another_sign_between_the_ends() -> None:
    """Assert the first of the dips at which the function is negative, the local one where there is one."""
    within: Any = Within(lambda d: 4 * (d - 0.45) ** 2 - 0.01)
    found = location.sign_between(within, within.new, 1.0, margin(dips=lambda *_: [(0.1, 0.48), (0.45, 0.0)]))
    assert found is not None and abs(found - 0.45) < 0.05
    assert location.sign_between(within, within.new, 1.0, margin(local=lambda s: 1.0 + s.distance)) is None
    mirrored: Any = Within(lambda d: -4 * (d - 0.45) ** 2 + 0.01)
    found = location.sign_between(mirrored, mirrored.new, 1.0, margin())
    assert found is not None and abs(found - 0.45) < 0.05


@pytest.mark.parametrize("confined", [(True, True), (False, True), (True, False)])
def test_no_place_is_looked_for_among_solutions_that_tell_there_is_none(confined: tuple[bool, bool]) -> None:
    """Assert that dips are left after the first where the step's end and the place of the dip tell so."""
    asked = list[float]()

    def value(distance: float) -> float:
        asked.append(distance)
        return 4 * (distance - 0.45) ** 2 - 0.01

    within: Any = Within(value)
    told = dict(zip((1.0, 0.1), confined, strict=True))
    test = margin(dips=lambda *_: [(0.1, 0.48), (0.45, 0.0)], confined=lambda _, new: told.get(new.distance))
    found = location.sign_between(within, within.new, 1.0, test)
    assert (found is None) == all(confined)
    assert not all(confined) or max(set(asked) - {0.0, 1.0}) == 0.1


@pytest.mark.parametrize(
    ("cosine", "resting", "rejected"),
    [(0.81, True, False), (0.79, True, True), (-0.9, True, True), (0.5, False, False)],
)
def test_equilibria_of_another_branch_are_refused(
    cosine: float, resting: bool, rejected: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that tangents of equilibria that are less than 0.8 aligned are of two branches."""
    orbit = SimpleNamespace(equilibrium=resting)
    solution = at(0.0, orbit=orbit, margin=0.0)
    base = at(0.0)
    base.tangent = SimpleNamespace(dot=lambda *_: cosine)
    solver = SimpleNamespace(problem=SimpleNamespace(units=lambda _: 1.0), alike=lambda *_: True)
    within: Any = SimpleNamespace(solver=solver, base=base, at=lambda _: at(0.0, margin=1.0))
    monkeypatch.setattr(location, "_root", lambda *_: (0.5, solution))
    monkeypatch.setattr(location, "refined", lambda _, found: found)
    monkeypatch.setattr(location, "_accepted", lambda _, found: found)
    if rejected:
        with pytest.raises(RejectedError, match="a special point of another branch was met"):
            location._located(within, (0.0, 1.0), 1.0, margin())
        return
    (found,) = location._located(within, (0.0, 1.0), 1.0, margin(name="mine"))
    assert (found.label, found.distance, found.solution, found.name) == (Label.TORUS, 0.5, solution, "mine")
    assert location._located(within, (0.0, 1.0), 1.0, margin(genuine=lambda _: False)) == []


@pytest.mark.parametrize(("value", "jumps"), [(0.0, False), (1.9e-3, False), (2.1e-3, True), (-2.1e-3, True)])
def test_function_that_jumps_through_0(value: float, jumps: bool) -> None:
    """Assert it where it is more than a thousandth of the larger end value, 2, at its change of sign."""
    ends: list[Any] = [SimpleNamespace(value=1.0), SimpleNamespace(value=-2.0)]
    solution: Any = SimpleNamespace(value=value)
    assert location._jumps(lambda s: s.value, solution, ends) is jumps


def pieces(*solutions: Any) -> list[Found]:
    """Pieces of a step between folds."""
    last = len(solutions) - 1
    labels = [Label.FOLD if 0 < k < last else Label.NONE for k in range(last + 1)]
    return [Found(label, float(k), s) for k, (label, s) in enumerate(zip(labels, solutions, strict=True))]


def test_values_are_located_in_the_pieces_that_pass_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert user points and a bound on the way 0 -> 2 -> 1: 0.5 once, 1.5 twice, the last point's not."""
    monkeypatch.setattr(
        location, "_at_value", lambda within, begin, end, value, label: (begin.distance, value, label)
    )
    problem = SimpleNamespace(low=-1.0, high=1.9)
    within: Any = SimpleNamespace(solver=SimpleNamespace(problem=problem))
    sought = location.Sought((0.0, 0.5, 1.5, 1.0), since=0.0)
    found: Any = location._at_values(within, pieces(at(0.0), at(2.0), at(1.0)), sought)
    assert found == [
        (0.0, 0.5, "UZ"),
        (0.0, 1.5, "UZ"),
        (0.0, 1.0, "UZ"),
        (0.0, 1.9, "EP"),
        (1.0, 1.5, "UZ"),
        (1.0, 1.0, "UZ"),
    ]


@pytest.mark.parametrize(
    ("solutions", "ok"),
    [
        ((at(0.0, 1.0), at(1.0, 1.0)), True),
        ((at(0.0, 1.0), at(-1.0, 1.0)), False),
        ((at(0.0, 1.0), at(2.0, 0.0), at(1.0, -1.0)), True),
        ((at(0.0, 1.0), at(2.0, 0.0), at(3.0, -1.0)), False),
    ],
)
def test_ends_lie_where_the_folds_lead(
    solutions: tuple[Any, ...], ok: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that the parameter goes the way of its slope, behind a fold that of the end's."""
    monkeypatch.setattr(location, "moves", lambda a, b: abs(b.value - a.value))
    if ok:
        location._check_ways(pieces(*solutions))
        assert len(solutions) > 1
        return
    with pytest.raises(RejectedError, match="the step ends on another part of the branch"):
        location._check_ways(pieces(*solutions))


def test_points_in_order_with_a_label() -> None:
    """Assert the order along the branch, without those that have no label."""
    found = [Found(Label(text), d, at(0.0)) for text, d in (("PD", 0.5), ("", 0.2), ("LP", 0.1))]
    assert [point.label for point in location._in_order(found)] == ["LP", "PD"]


def test_root_at_an_end_within_the_orbits_error() -> None:
    """Assert the end at which the function is smaller, where both have one sign; else the root between."""
    within: Any = Within(lambda d: 0.1 + d)
    assert WithinStep.root(within, (0.0, 1.0), lambda s: s.margin, 1e-9)[0] == 0.0
    falls: Any = Within(lambda d: 1.1 - d)
    assert WithinStep.root(falls, (0.0, 1.0), lambda s: s.margin, 1e-9)[0] == 1.0
    crosses: Any = Within(lambda d: d - 0.25)
    assert WithinStep.root(crosses, (0.0, 1.0), lambda s: s.margin, 1e-9)[0] == pytest.approx(0.25, abs=1e-9)


def test_orbits_beside_a_root_where_there_is_none() -> None:
    """Assert the nearest place within the interval at which there is an orbit, a step of 1e-8 of it away."""

    class Torn(Within):
        _aside = WithinStep._aside

        def at(self, distance: float, nearest: bool = False) -> Any:
            if 0 < abs(distance - 0.5) < 5e-8 or distance == 0.5:
                raise _NoOrbitError("none", distance)
            return super().at(distance)

    within: Any = Torn(lambda d: d - 0.5)
    within.base.orbit = SimpleNamespace(equilibrium=False)
    place, _ = within._aside((0.0, 1.0), _NoOrbitError("none", 0.5))
    assert place == pytest.approx(0.5 + 1e-7, abs=1e-12)  # ten times as far for orbits
    within.base.orbit = SimpleNamespace(equilibrium=True)
    place, _ = within._aside((0.0, 1.0), _NoOrbitError("none", 0.5))
    assert place == pytest.approx(0.5 + 1e-7, abs=1e-12)
    with pytest.raises(_NoOrbitError):
        within._aside((0.5, 0.5 + 1e-8), _NoOrbitError("none", 0.5))


def test_root_of_the_polynomial_through_four_values() -> None:
    """Assert the root of a cubic exactly, from its values at the nearest four of five places."""

    def cubic(d: float) -> float:
        return (d - 0.3) * (1 + d**2)

    known = {d: cubic(d) for d in (0.0, 0.2, 0.4, 0.8)} | {5.0: 77.0}
    assert branchcrossing._root(known, 0.2, 0.4) == pytest.approx(0.3, abs=1e-9)


@pytest.mark.parametrize(
    ("label", "distance", "one"),
    [("LP", 0.5 + 0.9e-3, True), ("LP", 0.5 + 1.1e-3, False), ("BP", 0.5, False), ("LP", 0.4991, True)],
)
def test_point_that_is_the_fold(label: str, distance: float, one: bool) -> None:
    """Assert that a point of the same label within a thousandth of the step is the same."""
    fold, point = Found(Label.FOLD, 0.5, at(0.0)), Found(Label(label), distance, at(0.0))
    assert turningpoint.is_one(point, fold, 1.0) is one


def test_points_at_which_orbits_shrink() -> None:
    """Assert a HB on a branch of orbits, and a fold at which an orbit is a twentieth of those beside it."""
    orbit, rest = (at(0.0, orbit=SimpleNamespace(equilibrium=e)) for e in (False, True))
    assert Found(Label.HOPF, 0.0, orbit).shrunk and not Found(Label.HOPF, 0.0, rest).shrunk
    assert not Found(Label.FOLD, 0.0, orbit).shrunk

    def sized(span: float, alone: bool = True) -> Any:
        return at(0.0, orbit=SimpleNamespace(span=lambda: span), problem=SimpleNamespace(autonomous=alone))

    assert turningpoint.shrinks(sized(0.049), sized(1.0), sized(2.0))
    assert not turningpoint.shrinks(sized(0.051), sized(1.0), sized(2.0))
    assert not turningpoint.shrinks(sized(0.049, alone=False), sized(1.0), sized(2.0))


def having(*multipliers: complex, slope: float = 1.0) -> Any:
    """A solution with multipliers, that are known."""
    found = np.array(multipliers, dtype=complex)
    spectrum = SimpleNamespace(nontrivial=found, multipliers=found, known=True)
    how = SimpleNamespace(stability=Stability.MULTIPLIERS, trusted=np.inf)
    problem = SimpleNamespace(conditions=(), trivial=0)
    return at(
        0.0,
        slope,
        spectrum=spectrum,
        discretisation=how,
        problem=problem,
        error=SimpleNamespace(multiplier=0.0),
    )


@pytest.mark.parametrize(
    ("before", "after", "labels"),
    [
        (having(0.5, 0.2), having(0.4, 0.3), []),
        (having(0.5, 0.2), having(-1.5, 0.2), ["PD"]),
        (having(0.5, 0.2), having(1.5, 0.2), ["BP"]),
        (having(0.5, 0.2), having(1.5, 0.2, slope=-1.0), ["LP"]),
        (having(0.5, 0.2), having(-1.5, 1.5), ["BP", "PD"]),
        (having(0.3 + 0.1j, 0.3 - 0.1j), having(1.3 + 0.1j, 1.3 - 0.1j), ["NS"]),
        (having(0.5, 0.2, slope=-1.0), having(0.5, 0.2, slope=-1.0), []),
        (having(0.5, 0.2), having(0.5, 0.2, slope=-1.0), ["LP"]),
    ],
)
def test_points_that_coincide_with_a_grazing(before: Any, after: Any, labels: list[str]) -> None:
    """Assert them by the multipliers beside it: through 1 and -1 one each, pairs otherwise."""
    assert sorted(turningpoint.at_once(before, after)) == labels
    assert turningpoint.unstable(having(1.5, -1.1, 0.9, 2j)) == 3


def entry(label: str, *growth: float, noise: float = 1e-6, **more: Any) -> Entry:
    """A point in the ledger."""
    return Entry(Label(label), 0.0, more.pop("slope", 1.0), np.array(growth), noise, **more)


def test_growth_of_multipliers_and_of_eigenvalues() -> None:
    """Assert log |mu|, and real parts over the largest eigenvalue, of -3 + 4i and 1."""
    found = np.array([-3 + 4j, 1.0])
    assert ledger.growth(found, False) == pytest.approx([np.log(5), 0.0])
    assert ledger.growth(found, True) == pytest.approx([-0.6, 0.2])
    assert np.isfinite(ledger.growth(np.zeros(2, dtype=complex), False)).all()


def test_noise_of_growth() -> None:
    """Assert the error times the largest multiplier, at least 1."""
    error: Any = SimpleNamespace(multiplier=1e-6)
    assert ledger.noise(error, np.array([0.5, -4.0])) == pytest.approx(ERRORS_FROM_ONE * 4e-6 + ROUNDED_ONE)
    assert ledger.noise(error, np.array([0.5])) == pytest.approx(ERRORS_FROM_ONE * 1e-6 + ROUNDED_ONE)


@pytest.mark.parametrize(
    ("point", "crossing"),
    [
        (entry(""), 0),
        (entry("GR"), 0),
        (entry("LP"), 1),
        (entry("PD"), 1),
        (entry("NS"), 2),
        (entry("HB"), None),
        (entry("HB", equilibrium=True), 2),
        (entry("LP", conservative=True), 0),
        (entry("BP", conservative=True), 1),
        (entry("CP"), None),
    ],
)
def test_how_many_multipliers_pass(point: Entry, crossing: int | None) -> None:
    """Assert it of each label; None where it is not known."""
    assert point.crossing == crossing


def test_possible_numbers_outside_the_circle() -> None:
    """Assert them by the noise, at ends of branches within a thousandth, and without those that pass."""
    assert entry("", 0.1, -0.1, 1e-7, -1e-7).unstable == {1, 2, 3}
    assert entry("", 0.1, -0.1, 1e-5, -1e-5).unstable == {2}
    assert entry("EP", 0.1, 0.9e-3, 1.1e-3).unstable == {2, 3}
    assert entry("PD", 0.1, 1e-8, -0.2).beside == {1}
    assert entry("NS", 1e-8, -1e-8, 0.3, 0.4).beside == {2}
    assert entry("BP", 1e-8, -1e-8, 0.3, conservative=True).beside == {1}


@pytest.mark.parametrize(
    ("point", "before", "folds", "after"),
    [
        (entry("EP", 0.5, -0.5), {1}, False, {1}),
        (entry("EP", 0.5, 1e-4), {0, 1}, False, {1, 2}),
        (entry("EP", 0.5, -0.5), {0}, False, set()),
        (entry("", 0.5, 1e-7), {1, 2, 3}, False, {1, 2}),
        (entry("CP", 0.5, 1e-7), {1}, False, {0, 1, 2}),
        (entry("PD", 0.5, 1e-7), {1}, False, {2}),
        (entry("PD", 0.5, 1e-7), {2}, False, {1}),
        (entry("PD", 0.5, 1e-7, grazing=True), {2}, False, {1, 3}),
        (entry("BP", 0.5, 1e-7), {1}, False, {2}),
        (entry("BP", 0.5, 1e-7), {1}, True, {1, 2}),
        (entry("BP", 0.5, 1e-7, slope=0.9e-5), {2}, False, {1, 2}),
        (entry("NS", 0.5, 1e-7, 1e-7), {1}, False, {3}),
    ],
)
def test_possible_numbers_after_a_point(point: Entry, before: set[int], folds: bool, after: set[int]) -> None:
    """Assert them from those before it."""
    assert point.after(before, folds) == after


def test_a_parameter_that_reverses_without_a_fold() -> None:
    """Assert it by the change between two points and their slopes, but for changes below its error."""

    def point(value: float, slope: float, label: str = "", blur: float = 0.0) -> Entry:
        return Entry(Label(label), value, slope, np.zeros(0), 0.0, blur)

    assert not ledger._reversed(point(0.0, 1.0), point(1.0, 1.0))
    assert ledger._reversed(point(0.0, 1.0), point(1.0, -1.0))
    assert ledger._reversed(point(0.0, 1.0), point(-1.0, 1.0))
    assert not ledger._reversed(point(0.0, 1.0), point(-1.0, 1.0, blur=1.1))
    assert not ledger._reversed(point(0.0, 1.0), point(1.0, -1.0, "LP"))
    assert not ledger._reversed(point(0.0, 1.0), point(1.0, -0.9e-5))
    slopes = [point(0.0, slope) for slope in (1.0, 1.0, 0.0, -1.0, -1.0)]
    assert ledger._folding(slopes) == [False, False, True, False, False]
    assert ledger._folding(slopes[:1]) == [False]


def test_sentence_of_a_gap() -> None:
    """Assert how changes are said."""
    assert str(ledger.Gap(0.5, 1.25, "x")) == "between 0.5 and 1.25 x"
    assert (
        ledger._passed({0}, {2, 1}, Label.NONE)
        == "unstable multipliers go from 0 to 1 or 2 without a labelled point"
    )
    assert (
        ledger._passed({1}, {0}, Label.DOUBLING)
        == "unstable multipliers go from 1 to 0, which PD does not explain"
    )


@pytest.mark.parametrize(
    ("trivial", "marginal", "known", "equilibrium"),
    [(0, False, True, False), (1, False, True, False), (2, True, True, False), (0, False, False, True)],
)
def test_entry_of_a_solution(
    trivial: int, marginal: bool, known: bool, equilibrium: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert value, slope over the range, growth, noise where the multipliers are known, and blur."""
    monkeypatch.setattr(ledger, "codim2", SimpleNamespace(marginal=lambda problem: marginal))
    monkeypatch.setattr(ledger, "known_spectrum", lambda solution: known)
    multipliers = np.array([0.5, -0.25], dtype=complex)
    solution: Any = SimpleNamespace(
        spectrum=SimpleNamespace(nontrivial=multipliers, multipliers=np.array([3.0, 0.5], dtype=complex)),
        orbit=SimpleNamespace(equilibrium=equilibrium),
        problem=SimpleNamespace(scale=4.0, trivial=trivial),
        tangent=SimpleNamespace(parameter=-2.0),
        error=SimpleNamespace(multiplier=1e-6, motion=1e-3),
        value=-5.0,
    )
    found = ledger.entry(solution, Label.FOLD)
    assert (found.label, found.value, found.slope) == (Label.FOLD, -5.0, -0.5)
    assert found.blur == pytest.approx(5e-3)
    assert (found.equilibrium, found.conservative) == (equilibrium, trivial == 2)
    growths = [1.0, -0.5] if equilibrium else np.log([0.5, 0.25])
    assert found.growth == pytest.approx(growths)
    exact = ledger.ERRORS_FROM_ONE * 1e-6 * 3.0 + ledger.ROUNDED_ONE
    assert found.noise == (np.inf if marginal else pytest.approx(exact))
