"""What a page holds of a branch and of a map, by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from periodic.results.interactive import content
from periodic.results.interactive.content import Signals, _rounded, kept
from periodic.results.interactive.mapped import map_content


class Points(SimpleNamespace):
    """A branch of points."""

    points: list[Any]

    def __len__(self) -> int:
        return len(self.points)


@pytest.mark.parametrize(
    ("count", "special", "expected"),
    [(5, (), [0, 1, 2, 3, 4]), (6, (), [0, 2, 4, 5]), (11, (4,), [0, 3, 4, 6, 9, 10]), (1, (), [0])],
)
def test_points_that_are_shown(
    count: int, special: tuple[int, ...], expected: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert all up to five, else every k-th, special ones and the last."""
    monkeypatch.setattr(content, "MOST_POINTS", 5)
    labels = [SimpleNamespace(value="LP" if k in special else "") for k in range(count)]
    branch: Any = Points(points=[SimpleNamespace(label=label) for label in labels])
    assert kept(branch) == expected


@pytest.mark.parametrize(
    ("names", "pairs"),
    [
        (["x", "x'", "y", "y'"], [(0, 1), (2, 3)]),
        (["z", "x", "x'", "f"], [(1, 2), (0, 3)]),
        (["x", "z"], [(0, 1)]),
        (["x"], []),
    ],
)
def test_phase_planes(names: list[str], pairs: list[tuple[int, int]]) -> None:
    """Assert states with their velocities, then what is left over the first."""
    branch: Any = Points(points=[SimpleNamespace(orbit=SimpleNamespace(names=names))])
    assert Signals(branch, None).names == names and Signals(branch, None).pairs == pairs


def test_other_outputs_of_a_system() -> None:
    """Assert those that are no states, after these."""
    branch: Any = Points(points=[SimpleNamespace(orbit=SimpleNamespace(names=["x", "x'"]))])
    system: Any = SimpleNamespace(outputs=[SimpleNamespace(name=name) for name in ("x", "force", "power")])
    assert Signals(branch, system).names == ["x", "x'", "force", "power"]


def test_six_digits() -> None:
    """Assert values to six digits, None of what is not finite."""
    assert [_rounded(v) for v in (1.23456789, -4e-9, 0.0)] == [1.23457, -4e-9, 0.0]
    assert [_rounded(v) for v in (np.nan, np.inf, -np.inf)] == [None] * 3


def test_map_over_two_parameters() -> None:
    """Assert axes with units, and numbers over both, the last axis outermost; no texts, no numbers of one."""
    data = xr.Dataset(
        {
            "a": (("p", "q"), [[1.0, 2.0, np.nan], [4.0, 5.0, 6.1234567]], {"units": "m"}),
            "stable": (("q", "p"), [[True, False], [True, True], [False, False]]),
            "one": (("p",), [1.0, 2.0]),
            "text": (("p", "q"), [["a"] * 3] * 2),
            "alone": 3.0,
        },
        coords={"p": ("p", [0.5, 1.5], {"units": "rad/s"}), "q": [1, 2, 3]},
    )
    found = map_content(data)
    assert found["axes"] == [
        {"name": "p", "unit": "rad/s", "values": [0.5, 1.5]},
        {"name": "q", "unit": "", "values": [1.0, 2.0, 3.0]},
    ]
    assert found["numbers"] == [
        {"name": "a", "unit": "m", "values": [[1.0, 4.0], [2.0, 5.0], [None, 6.12346]]},
        {"name": "stable", "unit": "", "values": [[1.0, 0.0], [1.0, 1.0], [0.0, 0.0]]},
    ]


def test_maps_of_other_sizes() -> None:
    """Assert one parameter, and the sentence for three of them and for none."""
    one = xr.Dataset({"a": (("p",), [1.0, 2.0])}, coords={"p": [0, 1]})
    assert map_content(one)["numbers"] == [{"name": "a", "unit": "", "values": [1.0, 2.0]}]
    three = xr.Dataset({"a": (("p", "q", "r"), np.ones((1, 1, 1)))}, coords={"p": [0], "q": [0], "r": [0]})
    none = xr.Dataset({"a": (("p",), [1.0])})
    apart = xr.Dataset({"a": (("p",), [1.0]), "b": (("q",), [1.0])}, coords={"p": [0], "q": [0]})
    for wrong in (three, none, apart):
        with pytest.raises(
            ValueError, match="^the map has the axes .*; a page shows numbers over one or two"
        ):
            map_content(wrong)
