"""What a notebook shows of branches, points and orbits."""

from __future__ import annotations

import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from support.traces import duffing, duffing_system

import periodic as per
from periodic.display.htmltables import table
from periodic.display.sketch import Frame, Line, Mark, sketch


def parsed(text: str) -> ElementTree.Element:
    """HTML that is well-formed XML too."""
    return ElementTree.fromstring(f"<all>{text}</all>")


def test_branch() -> None:
    """Assert a row for each special point, a picture with stable and unstable lines, and the stop."""
    branch = duffing(at=(1.7,))
    found = parsed(branch._repr_html_())
    rows = [[cell.text for cell in row] for row in found.iter("tr")]
    assert rows[0] == [None, "Omega (rad/s)", "x p-p (m)", "|mu| max", "stable"]
    assert [row[0] for row in rows[1:]] == [point.label.value for point in branch.special_points]
    assert [row[-1] for row in rows[1:] if row[0] == "UZ"] == ["yes", "no", "yes"]
    largest = [np.abs(point.multipliers).max() for point in branch.special_points]
    assert [float(str(row[-2])) for row in rows[1:]] == pytest.approx(largest, abs=1e-5)
    lines = [line.get("stroke-dasharray") for line in found.iter("polyline")]
    assert [dashes is not None for dashes in lines] == [False, True, False]
    marks = [text.text for text in found.iter("text")]
    assert marks.count("LP") == 2 and marks.count("UZ") == 3 and "EP" not in marks
    assert [p.text for p in found.iter("p")] == [repr(branch)]


def test_lines_join() -> None:
    """Assert that stable and unstable lines end where the next begins, and that all points are there."""
    found = parsed(duffing()._repr_html_())
    lines = [str(line.get("points")).split() for line in found.iter("polyline")]
    assert [a[-1] for a in lines[:-1]] == [b[0] for b in lines[1:]]
    assert sum(map(len, lines)) - (len(lines) - 1) == len(duffing())


def test_branch_without_points() -> None:
    """Assert that what is left is why it ended."""
    empty = replace(duffing(), points=())
    found = parsed(empty._repr_html_())
    assert not list(found.iter("svg")) and [p.text for p in found.iter("p")] == [repr(empty)]


def test_point_and_orbit() -> None:
    """Assert the sizes of each signal, and multipliers of the point."""
    point = duffing()[10]
    text = point._repr_html_()
    assert text.endswith(point.orbit._repr_html_()) and f", multipliers {point.multipliers[0]:.5g}" in text
    (row, *_) = [[cell.text for cell in row] for row in parsed(text).iter("tr")][1:]
    assert row[0] == "x (m)" and float(str(row[3])) == pytest.approx(point.peak_to_peak("x"), rel=1e-3)


def test_equilibria() -> None:
    """Assert that a branch of equilibria is shown by its values."""
    system = duffing_system(0.1, 1.0, 0.0)
    branch = per.trace(system, "k", (0.5, 1.5), method=per.Equilibrium(frequency="Omega"))
    headings = [cell.text for cell in parsed(branch._repr_html_()).iter("th")]
    assert headings == [None, "k (N/m)", "x (m)", "Re lambda max (1/s)", "stable"]
    assert "equilibrium" in branch[0]._repr_html_()
    assert ", eigenvalues (1/s) " in branch[0]._repr_html_()


def test_sketch_keeps_within_its_frame() -> None:
    """Assert that points that are not finite are left out, a constant lies in the middle, names are text."""
    x, y = np.array([0.0, 1.0, np.nan, 3.0]), np.array([2.0, 2.0, 2.0, 2.0])
    text = sketch([Line(x, y)], [Mark(1.0, 2.0, "<b>")], "x & y", "up")
    (line,) = parsed(text).iter("polyline")
    assert len({pair.split(",")[1] for pair in str(line.get("points")).split()}) == 1
    assert len(str(line.get("points")).split()) == 3 and "<b>" not in text
    width = float(re.findall(r"viewBox='0 0 (\d+)", text)[0])
    assert all(0 <= float(pair.split(",")[0]) <= width for pair in str(line.get("points")).split())
    assert sketch([], [], "", "") == "" and table(["a"], []) == ""


def test_sketch_by_hand() -> None:
    """Assert every length of the picture of 380 by 210 with margins 58, 14, 14 and 36: frame 308 by 160."""
    given = [
        Line(np.array([0.0, 10.0]), np.array([1.0, 3.0])),
        Line(np.array([5.0]), np.array([2.0]), dashed=True),
    ]
    text = sketch(given, [Mark(5.0, 2.0, "LP"), Mark(10.0, 3.0, "BP")], "x", "y")
    root = parsed(text)
    (box,) = root.iter("rect")
    assert [box.get(key) for key in ("x", "y", "width", "height")] == ["54", "10", "316", "168"]
    solid, dashed = root.iter("polyline")
    assert (solid.get("points"), dashed.get("points")) == ("58.0,174.0 366.0,14.0", "212.0,94.0")
    assert (solid.get("stroke-dasharray"), dashed.get("stroke-dasharray")) == (None, "5 3")
    assert (solid.get("stroke-width"), solid.get("fill")) == ("1.7", "none")
    dots = [(dot.get("cx"), dot.get("cy"), dot.get("r")) for dot in root.iter("circle")]
    assert dots == [("212.0", "94.0", "2.6"), ("366.0", "14.0", "2.6")]
    texts = [(t.get("x"), t.get("y"), t.get("text-anchor"), t.text) for t in root.iter("text")]
    assert texts == [
        ("217.0", "90.0", "start", "LP"),
        ("361.0", "10.0", "end", "BP"),
        ("58", "191", "start", "0"),
        ("366", "191", "end", "10"),
        ("51", "178", "end", "1"),
        ("51", "18", "end", "3"),
        ("212", "205", "middle", "x"),
        (None, None, "middle", "y"),
    ]
    (turned,) = (t.get("transform") for t in root.iter("text") if t.get("transform"))
    assert turned == "translate(12 94) rotate(-90)"
    assert Frame((0.0, 2.0), (4.0, 2.0)).at(1.0, 2.0) == (58 + 308 / 4, 94.0)
