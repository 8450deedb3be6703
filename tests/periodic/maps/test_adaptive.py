"""Cells chosen where a number changes most."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.maps import ends, task

import periodic as per

pytest.importorskip("adaptive")


def kink(task: per.maps.Task, branch: per.Branch) -> float:
    """A number with a steep front at F = 1.3 and no value beyond 1.9."""
    F = branch[0].orbit.parameters["F"]
    if F > 1.9:
        raise ValueError("nothing here")
    return math.tanh(50 * (F - 1.3))


def test_cells_lie_where_the_number_changes(tmp_path: Path) -> None:
    """Assert that more cells lie at a front than evenly, and that failures say so."""
    plan = per.maps.Adaptive({"F": (1.0, 2.0)}, "kink", cells=32)
    here = per.design_map(task(kink=kink), plan, 1, store=tmp_path / "map.nc")
    assert here["kink"].dims == ("cell",) and here.sizes["cell"] == 32 and (np.diff(here["F"]) > 0).all()
    near = np.abs(here["F"] - 1.3) < 0.05
    assert int(near.sum()) > 2 * 0.1 * 32
    assert here["kink"].values[~np.isnan(here["kink"])] == pytest.approx(
        np.tanh(50 * (here["F"].values[here["F"] <= 1.9] - 1.3))
    )
    assert (here["reason"][here["F"] > 1.9] == "kink: nothing here").all()
    assert per.design_map(task(kink=kink), plan, 1, store=tmp_path / "map.nc").identical(here)


def test_interrupted_sampling_goes_on_to_the_same_cells(tmp_path: Path) -> None:
    """Assert that a sampling in two parameters that is interrupted ends with the cells of one that is not."""
    plan = per.maps.Adaptive({"F": (0.5, 1.5), "zeta": (0.1, 0.4)}, "peak", cells=20)

    def press(progress: per.maps.Progress) -> None:
        if progress.done == 18:
            raise KeyboardInterrupt

    with pytest.raises(per.maps.MapInterrupted, match="after 18 of 20 cells"):
        per.design_map(task(), plan, 1, store=tmp_path / "map.nc", progress=press)
    found = per.design_map(task(), plan, 1, store=tmp_path / "map.nc")
    whole = per.design_map(task(), plan, 1, store=None)
    for name in ("F", "zeta", "peak"):
        assert np.array_equal(found[name], whole[name])


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: per.maps.Adaptive({}, "peak"), "bounds is empty; it must give the range"),
        (
            lambda: per.maps.Adaptive({"F": (2, 1)}, "peak"),
            r"bounds of F are \(2, 1\); they must be two rising",
        ),
        (lambda: per.maps.Adaptive({"F": 3}, "peak"), "bounds of F are 3; they must be two rising"),
        (
            lambda: per.maps.Adaptive({"F": (1, 2)}, "peak", cells=1),
            "cells is 1; it must be a whole number of at least 2",
        ),
        (
            lambda: per.design_map(task(), per.maps.Adaptive({"G": (1, 2)}, "peak"), 1, store=None),
            "bounds has 'G'; it must be one of the system's Omega, zeta, F",
        ),
        (
            lambda: per.design_map(task(), per.maps.Adaptive({"F": (1, 2)}, "fold"), 1, store=None),
            "number is 'fold'; it must be one of peak",
        ),
        (
            lambda: per.design_map(
                task(e=ends), per.maps.Adaptive({"F": (1, 2)}, "e", cells=2), 1, store=None
            ),
            "number is 'e', of which a branch has several; it must have one",
        ),
    ],
)
def test_refusals(make: Any, said: str) -> None:
    """Assert the sentence for a sampling that cannot be."""
    with pytest.raises(ValueError, match=f"^{said}"):
        make()


def test_without_the_sampler(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the sentence where the package is not installed."""
    monkeypatch.setitem(sys.modules, "adaptive", None)
    with pytest.raises(ValueError, match="^grid is Adaptive; its sampler must be installed"):
        per.design_map(task(), per.maps.Adaptive({"F": (1, 2)}, "peak"), 1, store=None)
