"""Branches as results: reading, tables, pictures and files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from support.equations import growing
from support.kept import kept
from support.numpy_systems import AlgebraicOscillator, BrokenOscillator
from support.traces import disc, duffing

import periodic as per

Label = per.Label


@pytest.fixture
def axes() -> Axes:
    """Axes of a figure of their own."""
    return Figure().subplots()


@kept
def branches() -> dict[str, per.Branch]:
    """A smooth branch, one with event nodes and an unknown, one both ways, one without a point."""
    system = AlgebraicOscillator()
    return {
        "duffing": duffing(at=(1.8,)),
        "disc": disc(rpm=(290.0, 270.0), accuracy=per.Accuracy.DRAFT),
        "both ways": per.trace(system, "Omega", (0.4, 1.6), start=0.8),
        "empty": per.trace(BrokenOscillator(), "Omega", (0.4, 1.2)),
    }


@pytest.fixture(params=["duffing", "disc", "both ways", "empty"])
def pair(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[per.Branch, per.Branch]:
    """A branch, and the same saved and loaded."""
    branch = branches()[request.param]
    branch.save(tmp_path / "branch.nc")
    return branch, per.Branch.load(tmp_path / "branch.nc")


def test_indexing() -> None:
    """Assert that a branch is a sequence of its points."""
    branch = duffing()
    assert len(branch) == len(branch.points) == len(list(branch))
    assert branch[0] is branch.points[0] and branch[-1] is branch.points[-1]
    assert list(branch) == list(branch.points)
    with pytest.raises(IndexError):
        branch[len(branch)]


def test_columns() -> None:
    """Assert that values, stability and peak to peak have one entry for each point."""
    branch = duffing()
    assert branch.values.tolist() == [point.parameter for point in branch]
    assert branch.stable.tolist() == [point.stable for point in branch]
    spans = [point.maximum["x"] - point.minimum["x"] for point in branch]
    assert branch.peak_to_peak("x").tolist() == spans


def test_special_points_are_in_order() -> None:
    """Assert that special points come in order along the branch."""
    labels = [point.label for point in duffing(at=(1.8,)).special_points]
    user, fold, end = Label.USER, Label.FOLD, Label.END
    assert labels == [end, user, fold, user, fold, user, end]


def test_stability_changes_at_folds_alone() -> None:
    """Assert that the branch is unstable between its folds and stable elsewhere."""
    branch = duffing()
    first, second = (branch.points.index(point) for point in branch.labelled(Label.FOLD))
    inside = [first <= i <= second for i in range(len(branch))]
    assert branch.stable.tolist() == [not unstable for unstable in inside]


def test_multipliers_are_sorted() -> None:
    """Assert that every point has its multipliers in order of falling modulus."""
    for point in disc():
        assert (np.diff(np.abs(point.multipliers)) <= 1e-15).all()


def test_table() -> None:
    """Assert that the table has a heading and one line of equal width for each point, with its label."""
    branch = duffing(at=(1.8,))
    head, *lines = branch.table().splitlines()
    assert head.split()[:2] == ["label", "Omega"]
    assert len(lines) == len(branch) and len({len(line) for line in (head, *lines)}) == 1
    for line, point in zip(lines, branch, strict=True):
        named = "PK x" if point.label == "PK" else point.label.value
        assert line.startswith(named.rjust(len("label")))
        assert f"{point.parameter:.12g}" in line.split()
        assert (" yes " in line) == point.stable


def test_load_gives_the_same_numbers(pair: tuple[per.Branch, per.Branch]) -> None:
    """Assert that every number of every point survives saving bit for bit."""
    before, after = pair
    assert len(before) == len(after)
    for a, b in zip(before, after, strict=True):
        assert (a.parameter, a.label, a.error, a.residual) == (b.parameter, b.label, b.error, b.residual)
        assert (a.minimum, a.maximum, a.iterations, a.slope) == (b.minimum, b.maximum, b.iterations, b.slope)
        assert a.multipliers.tolist() == b.multipliers.tolist()


def test_load_gives_the_same_orbits(pair: tuple[per.Branch, per.Branch]) -> None:
    """Assert that orbits and meshes survive saving bit for bit, event nodes included."""
    for a, b in ((p.orbit, q.orbit) for p, q in zip(*pair, strict=True)):
        for name in ("nodes", "stages", "algebraic", "phases", "parameter"):
            before, after = getattr(a, name), getattr(b, name)
            assert before.shape == after.shape and before.tobytes() == after.tobytes()
        assert (a.mesh.scheme, a.mesh.events, a.mesh.period) == (
            b.mesh.scheme,
            b.mesh.events,
            b.mesh.period,
        )
        assert [x.tobytes() for x in a.mesh.breaks] == [x.tobytes() for x in b.mesh.breaks]


def test_load_gives_the_same_branch(pair: tuple[per.Branch, per.Branch]) -> None:
    """Assert that names, units, reasons and versions survive saving."""
    before, after = pair
    for name in ("parameter", "layout", "stop", "stop_backwards", "newton_iterations", "elapsed", "versions"):
        assert getattr(before, name) == getattr(after, name)
    assert before.table() == after.table()


def test_tied_orbits_are_among_the_saved() -> None:
    """Assert that the disc's branch of the tests above has points with and without event nodes."""
    assert {len(point.orbit.mesh.events) for point in branches()["disc"]} == {0, 1}


def test_loaded_orbit_can_be_traced_from(tmp_path: Path) -> None:
    """Assert that a loaded orbit is a start of a trace of its own."""
    branches()["both ways"].save(tmp_path / "branch.nc")
    orbit = per.Branch.load(tmp_path / "branch.nc")[-1].orbit
    branch = per.trace(AlgebraicOscillator(), "Omega", (1.6, 1.5), guess=orbit)
    assert branch.stop.reason is per.Reason.BOUND and branch[0].parameter == 1.6


def test_file_tells_names_and_units(tmp_path: Path) -> None:
    """Assert that another program finds parameter, names, units and versions in the file."""
    duffing().save(tmp_path / "branch.nc")
    with xr.open_dataset(tmp_path / "branch.nc", engine="h5netcdf") as data:
        assert data.attrs["parameter"] == "Omega"
        assert '["Omega", "rad/s", 1.0]' in data.attrs["layout"]
        assert "orbitrace" in data.attrs["versions"]
        assert data["value"].values.tolist() == duffing().values.tolist()
        assert not any(variable.dtype.hasobject for name, variable in data.items() if name != "label")


def pieces(axes: Axes) -> Iterator[tuple[str, np.ndarray]]:
    """Style and abscissas of every line longer than a point."""
    for line in axes.get_lines():
        if len(line.get_xdata()) > 1:
            yield line.get_linestyle(), np.asarray(line.get_xdata())


def test_plot_lines(axes: Axes) -> None:
    """Assert solid stable parts, a dashed one between the folds, and curves through the points."""
    branch = duffing()
    assert per.plot(branch, axes=axes) is axes
    drawn = list(pieces(axes))
    assert [style for style, _ in drawn] == ["-", "--", "-"]
    low, high = sorted(point.parameter for point in branch.labelled(Label.FOLD))
    inside = drawn[1][1]
    assert low - 1e-12 <= inside.min() and inside.max() <= high + 1e-12
    through = np.unique(np.concatenate([x for _, x in drawn]))
    assert np.isin(branch.values, through).all() and len(through) > 5 * len(branch)


def test_plot_labels(axes: Axes) -> None:
    """Assert that folds carry their label and the axes name and unit."""
    per.plot(duffing(at=(1.8,)), axes=axes)
    assert [text.get_text() for text in axes.texts] == ["LP", "LP"]
    assert axes.get_xlabel() == "Omega (rad/s)"
    assert axes.get_ylabel() == "x peak to peak (m)"


def test_plot_of_another_output_or_measure(axes: Axes) -> None:
    """Assert that an output can be named, and a function of a point plotted in its place."""
    branch = branches()["both ways"]
    per.plot(branch, "force", axes=axes)
    assert axes.get_ylabel() == "force peak to peak (N)"
    per.plot(branch, axes=axes, measure=lambda point: 2.0 * point.parameter)
    drawn = [line for line in axes.get_lines() if len(line.get_xdata()) > 1][-1]
    assert np.asarray(drawn.get_ydata()) == pytest.approx(2.0 * np.asarray(drawn.get_xdata()))
    assert axes.get_ylabel() == "measure"


def test_plot_of_nothing(axes: Axes) -> None:
    """Assert that a branch without points is an empty picture."""
    per.plot(branches()["empty"], axes=axes)
    assert list(pieces(axes)) == []


def test_plot_of_an_unknown_output(axes: Axes) -> None:
    """Assert that an output which the branch lacks is refused by name."""
    with pytest.raises(ValueError, match="^output is 'load'; it must be one of x$"):
        per.plot(duffing(), "load", axes=axes)


def test_point_is_immutable() -> None:
    """Assert that a point cannot be changed, only replaced."""
    point = duffing()[0]
    with pytest.raises(AttributeError):
        point.parameter = 1.0  # type: ignore[misc]
    assert replace(point, label=Label.USER).label is Label.USER and point.label is Label.END


def test_plot_marks_tori_and_their_stretches(axes: Axes) -> None:
    """Assert NS on a plot, the window between two of them dashed and what follows solid."""
    branch = per.trace(growing(), "mu", (0.0, 1.0))
    per.plot(branch, axes=axes)
    assert [text.get_text() for text in axes.texts] == ["NS", "NS"]
    (_, before), (style, window), (_, after) = pieces(axes)
    assert style == "--" and [window.min(), window.max()] == pytest.approx([0.30, 0.36], rel=1e-6)
    assert before.max() == window.min() and window.max() == after.min()


def test_what_was_not_reached_is_said_once() -> None:
    """Assert the sentence on points whose multipliers, then whose orbits too, miss the tolerance."""
    branch = duffing(at=(1.8,))
    assert branch.shortfall == ""
    rough = replace(branch[3].error, multiplier=2e-4)
    points = (*branch.points[:3], replace(branch[3], error=rough), *branch.points[4:])
    missed, where = replace(branch, points=points), f"near Omega = {branch[3].parameter:.6g}"
    assert missed.shortfall == f"1 of {len(branch)} points: multipliers to 1e-3 only, {where}"
    assert missed.table().endswith(missed.shortfall)
    rough = replace(rough, orbit=2e-6)
    points = (*points[:-1], replace(points[-1], error=rough))
    both = replace(branch, points=points).shortfall
    assert both.startswith(
        f"2 of {len(branch)} points: orbits to 1e-5 only and multipliers to 1e-3 only, from"
    )
