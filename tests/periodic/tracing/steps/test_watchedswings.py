"""Peak to peaks that a branch watches by default: its curve between the points, and their peaks."""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from support.drawn.machines.drawn import machine
from survey.machines.curves import away, lacking

import periodic as per
import symbolic as sym
from periodic.results.peaks import PEAK_OF
from periodic.tracing.steps import watchedswings
from periodic.tracing.steps.watchedswings import WatchedSwings, _back, _continued


def oscillator(ratio: float) -> sym.CompiledSystem:
    """A mass on a spring, forced by 1 N."""
    x, omega = sym.coordinate("x"), sym.parameter("Omega", 0.5, "rad/s")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 2 * ratio), sym.HarmonicForce(x, 1.0, omega)]
    return sym.compile(sym.combine(parts))


def swing(omega: np.ndarray, ratio: float) -> np.ndarray:
    """Peak to peak of x in closed form."""
    return 2 / np.hypot(1 - omega**2, 2 * ratio * omega)


@pytest.mark.parametrize("method", [per.Collocation(), per.Shooting(), per.HarmonicBalance()])
@pytest.mark.parametrize("ratio", [0.003, 0.03, 0.3])
def test_resonance_is_a_point_and_the_curve_is_right(ratio: float, method: per.Discretisation) -> None:
    """Assert the peak of an oscillator to 1e-6 and its curve to 1 % of its range, unasked."""
    branch = per.trace(oscillator(ratio), "Omega", (0.5, 1.5), method=method)
    (peak,) = branch.peaks["peak of x"]
    assert (peak.label, peak.event) == ("PK", "peak of x")
    assert peak.parameter == pytest.approx(math.sqrt(1 - 2 * ratio**2), rel=1e-6)
    assert peak.peak_to_peak("x") == pytest.approx(1 / (ratio * math.sqrt(1 - ratio**2)), rel=1e-6)
    assert peak in branch.points
    assert peak not in branch.special_points
    omega, found = branch.curve("x p-p")
    true = swing(omega, ratio)
    assert np.abs(found - true).max() < 0.01 * np.ptp(true)


def test_trough_too() -> None:
    """Assert resonances of two masses, and the troughs between, against their response in closed form."""
    x, y, omega = sym.coordinate("x"), sym.coordinate("y"), sym.parameter("Omega", 0.3, "rad/s")
    parts = [sym.Mass(x, 1.0), sym.Mass(y, 1.0), sym.Spring(x, 1.0), sym.Spring(x, 1.0, to=y)]
    damped = [sym.Damper(x, 0.01, to=y), sym.HarmonicForce(x, 1.0, omega)]
    system = sym.compile(sym.combine([*parts, *damped]))
    branch = per.trace(system, "Omega", (0.3, 2.0))
    places = {"x": (0.618, 1.0, 1.618), "y": (0.618, 1.225, 1.618)}
    for k, name in enumerate("xy"):
        for peak, near, sign in zip(branch.peaks[f"peak of {name}"], places[name], (-1, 1, -1), strict=True):

            def height(omega: float, k: int = k, sign: int = sign) -> float:
                stiff = np.array([[2.0, -1.0], [-1.0, 1.0]]) + 0.01j * omega * np.array([[1, -1], [-1, 1]])
                return sign * float(np.abs(np.linalg.solve(stiff - omega**2 * np.eye(2), [1.0, 0.0])[k]))

            true = minimize_scalar(height, (near - 1e-3, near, near + 1e-3), tol=1e-10)
            assert peak.parameter == pytest.approx(true.x, rel=1e-6)
            assert peak.peak_to_peak(name) == pytest.approx(2 * sign * true.fun, rel=1e-6)


def test_none_where_none_are_wanted() -> None:
    """Assert an empty mapping, no peaks in between, and the longer steps."""
    system = oscillator(0.03)
    plain = per.trace(system, "Omega", (0.5, 1.5), watch=per.Watch(peaks={}))
    assert plain.peaks == {}
    assert len(plain) < len(per.trace(system, "Omega", (0.5, 1.5)))


def test_constant_swing_has_no_peaks() -> None:
    """Assert that rounding makes none, of a swing that the parameter does not change."""
    x, force = sym.coordinate("x"), sym.parameter("rest", 1.0, "N")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.1), sym.HarmonicForce(x, 1.0, 1.0)]
    system = sym.compile(sym.combine([*parts, sym.ConstantForce(x, force)]))
    branch = per.trace(system, "rest", (1.0, 2.0))
    assert branch.peaks == {"peak of x": ()}
    assert np.ptp(branch.peak_to_peak("x")) < 1e-6 * branch[0].peak_to_peak("x")


def test_cubic_is_continued() -> None:
    """Assert that a cubic, continued, is itself, and so is its slope."""
    a, b, end = 1.0, 3.0, 4.5
    value, slope = _continued(
        np.array([a**3]), np.array([3 * a**2]), np.array([b**3]), np.array([3 * b**2]), b - a, end - b
    )
    assert value == pytest.approx([end**3], rel=1e-13)
    assert slope == pytest.approx([3 * end**2], rel=1e-13)


def test_nothing_is_watched_by_default_of_a_record() -> None:
    """Assert that without tests a step has no bound and no peaks."""
    branch = per.trace(oscillator(0.3), "Omega", (0.5, 1.5))
    watched = WatchedSwings()
    assert watched.ratio(branch.points, branch[-1], 0.1) == 0.0  # type: ignore[arg-type]
    assert watched.stationary(branch[0], branch[-1], 0.1) == {}  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("family", "seed"),
    [("journal bearings", 0), ("squeeze-film dampers", 2), ("gear pairs", 1), ("gears on two shafts", 1)],
)
def test_machines_of_the_catalogue(family: str, seed: int) -> None:
    """Assert curves of every coordinate to 1 % of their range, at orbits between all points of a branch."""
    drawn = machine(family, seed)
    system = sym.compile(drawn.model)
    branch = per.trace(system, drawn.parameter, drawn.bounds)
    short, unwatched = per.ArclengthControl(ds=0.01, ds_max=0.01), per.Watch(peaks={})
    fine = per.trace(system, drawn.parameter, drawn.bounds, control=short, watch=unwatched)
    assert len(fine) > 2 * len(branch)
    for name in (peak.removeprefix(PEAK_OF) for peak in branch.peaks):
        assert away(fine, branch, name) < 0.01
        assert lacking(fine, branch, name) == []


def test_halves_turn_their_slopes() -> None:
    """Assert that a branch traced both ways from its middle has the curve of one traced through."""
    system = oscillator(0.1)
    both = per.trace(system, "Omega", (0.5, 1.5), start=1.0)
    assert 0 < both.backwards < len(both)
    omega, found = both.curve("x p-p")
    assert np.abs(found - swing(omega, 0.1)).max() < 0.01 * np.ptp(found)
    for a, b in itertools.pairwise(both.points[1:-1]):
        assert b.parameter > a.parameter
        assert a.slope > 0


def test_files_keep_slopes(tmp_path: object) -> None:
    """Assert the same curve of a branch from its file, and one without slopes of points of an older file."""
    from dataclasses import replace
    from pathlib import Path

    branch = per.trace(oscillator(0.1), "Omega", (0.5, 1.5))
    path = Path(str(tmp_path)) / "branch.nc"
    branch.save(path)
    read = per.Branch.load(path)
    assert np.array_equal(read.curve("x p-p"), branch.curve("x p-p"))
    old = replace(branch, points=tuple(replace(p, minimum_slope={}, maximum_slope={}) for p in branch.points))
    straight, exact = old.curve("x p-p"), branch.curve("x p-p")
    assert np.abs(straight[1] - np.interp(straight[0], branch.values, branch.peak_to_peak("x"))).max() < 1e-12
    assert not np.allclose(straight[1], exact[1], rtol=1e-3)


class Made(SimpleNamespace):
    """A point of a branch with peak to peak s + b s^4 at the arclength s, which is the parameter too."""

    def __init__(self, s: float, b: float, label: str = "", equilibrium: bool = False) -> None:
        value, slope = s + b * s**4, 1 + 4 * b * s**3
        super().__init__(
            parameter=s,
            slope=1.0,
            label=per.Label(label),
            equilibrium=equilibrium,
            orbit=SimpleNamespace(equilibrium=equilibrium),
            minimum={"x": 0.0},
            maximum={"x": value},
            minimum_slope={"x": 0.0},
            maximum_slope={"x": slope},
            found=SimpleNamespace(peak_to_peak=np.array([value]), peak_to_peak_slope=np.array([slope])),
            problem=SimpleNamespace(full=SimpleNamespace(outputs=[SimpleNamespace(name="x")])),
        )


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The output x, to a tolerance of 1e-6, of made points."""
    monkeypatch.setattr(watchedswings, "measured", lambda solution: solution.found)
    test: Any = object()
    return WatchedSwings({"x": test}, 1e-6, {"x": 1e-3})


@pytest.mark.parametrize(("before", "length"), [(1.0, 1.0), (0.6, 1.0), (2.0, 0.5)])
def test_error_of_the_cubic_by_hand(before: float, length: float, watched: Any) -> None:
    """Assert m'''' h^4/384 over 1 % of the range, to the fourth root, however long the step before was."""
    b, s = 1e-4, 3.0
    behind = [Made(s - before, b), Made(s, b)]
    range_ = Made(s + length, b).maximum["x"] - behind[0].maximum["x"]
    allowed = 0.01 * range_ + 1e-6 * Made(s + length, b).maximum["x"]
    expected = (24 * b * length**4 / 384 / allowed) ** 0.25
    assert watched.ratio(behind, Made(s + length, b), length) == pytest.approx(expected, rel=5e-3)


def test_range_is_that_of_the_whole_branch(watched: Any) -> None:
    """Assert that it counts points long gone, and not those of a branch that is cut back."""
    b, new = 1e-4, Made(4.0, 1e-4)
    near = [Made(2.0, b), Made(3.0, b)]
    few, many = watched.ratio(near, new, 1.0), watched.ratio([*near, Made(-9.0, b), *near], new, 1.0)
    ranges = [new.maximum["x"] - low.maximum["x"] for low in (near[0], Made(-9.0, b))]
    assert few / many == pytest.approx((ranges[1] / ranges[0]) ** 0.25, rel=1e-3)
    assert watched.ratio(near, new, 1.0) == few


@pytest.mark.parametrize(
    "behind",
    [
        [Made(3.0, 0.1)],
        [Made(2.8, 0.1), Made(3.0, 0.1)],
        [Made(2.0, 0.1), Made(3.0, 0.1, "GR")],
        [Made(2.0, 0.1, "GR"), Made(3.0, 0.1)],
        [Made(2.0, 0.1, equilibrium=True), Made(3.0, 0.1)],
    ],
    ids=["first", "too short", "grazing", "behind a grazing", "rest"],
)
def test_nothing_tells(behind: Any, watched: Any) -> None:
    """Assert no bound where no cubic can be continued over the step."""
    assert watched.ratio(behind, Made(4.0, 0.1), 1.0) == 0.0


def test_points_within_the_step_before_are_passed(watched: Any) -> None:
    """Assert that what is continued begins at least half a step behind, whatever lies between."""
    b = 1e-4
    plain, more = [Made(2.0, b), Made(3.0, b)], [Made(2.0, b), Made(2.9, b, "UZ"), Made(3.0, b)]
    new = Made(4.0, b)
    assert watched.ratio(more, new, 1.0) == pytest.approx(watched.ratio(plain, new, 1.0), rel=1e-3)


def test_slopes_of_opposite_signs_tell_a_peak(watched: Any) -> None:
    """Assert it of those that exceed the error over the step, with the index of the output."""
    point, end = Made(0.0, 0.0), Made(1.0, 0.0)
    assert watched.stationary(point, end, 0.1) == {}
    end.found.peak_to_peak_slope[:] = -1.0
    assert [*watched.stationary(point, end, 0.1)] == [0]
    end.found.peak_to_peak_slope[:] = -0.9e-5  # over the step as little as the error, 1e-6 of 1
    assert watched.stationary(point, end, 0.1) == {}
    end.found.peak_to_peak_slope[:] = -1.1e-5
    assert [*watched.stationary(point, end, 0.1)] == [0]
    end.found.peak_to_peak[:] = 0.0
    end.found.peak_to_peak_slope[:] = -1.1e-8  # of what is at rest below 1e-3
    assert [*watched.stationary(point, end, 0.1)] == [0]
    assert watched.stationary(Made(0.0, 0.0, equilibrium=True), end, 0.1) == {}


@pytest.mark.parametrize(
    ("roots", "back"),
    [
        ((0.2, 0.6), 0.4**3 / 6),
        ((-0.1, 0.6), 0.0),
        ((-0.4, -0.1), 0.0),
        ((-0.2, 1.1), 0.0),
        ((1.2, 1.3), 0.0),
    ],
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_peak_and_trough_of_a_cubic(roots: tuple[float, float], back: float, sign: float) -> None:
    """Assert how far it goes back between roots of slope (t - a)(t - b): (b - a)^3/6 if both lie inside."""
    slope = sign * np.polynomial.Polynomial.fromroots(roots)
    value = slope.integ()
    given = [np.array([each]) for each in (value(1.0) - value(0.0), slope(0.0), slope(1.0))]
    assert _back(*given) == pytest.approx([back], rel=1e-12)


def test_step_with_peak_and_trough_is_told(watched: Any) -> None:
    """Assert it by hand, of slopes 1 and ends as high: 3^(1/2)/9 back; not of rest, grazings and noise."""
    begin, end = Made(0.0, 0.0), Made(1.0, 0.0)
    end.found.peak_to_peak[:] = 0.0
    assert watched.turns_twice(begin, end, 1.0)
    assert not watched.turns_twice(begin, Made(1.0, 0.0), 1.0)
    assert not watched.turns_twice(Made(0.0, 0.0, "GR"), end, 1.0)
    assert not watched.turns_twice(Made(0.0, 0.0, equilibrium=True), end, 1.0)
    end.found.peak_to_peak[:], high = 1.0, Made(1.0, 0.0)
    high.maximum["x"] = 1.0
    high.maximum_slope["x"] = end.found.peak_to_peak_slope[0]
    assert watched.turns_twice(high, end, 1.1e-5) and not watched.turns_twice(high, end, 1e-5)
    assert not WatchedSwings().turns_twice(begin, end, 1.0)


def test_branch_ends_at_a_usual_peak() -> None:
    """Assert that `stop` knows the peaks that are watched unasked, and refuses others by name."""
    system = oscillator(0.1)
    branch = per.trace(system, "Omega", (0.5, 1.5), watch=per.Watch(stop={"peak of x": 1}))
    assert branch[-1].event == "peak of x"
    with pytest.raises(ValueError, match="^stop has 'peak of y'; the peaks that are watched are peak of x$"):
        per.trace(system, "Omega", (0.5, 1.5), watch=per.Watch(stop={"peak of y": 1}))
    with pytest.raises(ValueError, match="^stop has 'peak of x'; the peaks that are watched are none$"):
        per.trace(system, "Omega", (0.5, 1.5), watch=per.Watch(peaks={}, stop={"peak of x": 1}))
