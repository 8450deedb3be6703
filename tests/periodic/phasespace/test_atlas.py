"""Everything over a parameter: the gear pair's branch with the shares of its stable stretches."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.kept import kept
from support.oscillators import oscillator

import periodic as per
import symbolic as sym

pytestmark = pytest.mark.usefixtures("users_kernels")


@kept
def gears() -> per.phasespace.Atlas:
    """The gear pair about its resonance."""
    box = {"x": (-3, 3), "x'": (-2, 2)}
    given = {"count": 5, "diagram": 9, "starts": 40, "places": 8, "periods": 2}
    return per.atlas(sym.scene("gear-pair"), "Omega", (0.56, 0.96), box=box, **given)


def test_one_branch_with_two_stable_stretches() -> None:
    """Assert that the branch is traced once, and that shares of its stretches make the whole."""
    found = gears()
    (sheet,) = found.sheets
    assert found.values == pytest.approx([0.56, 0.66, 0.76, 0.86, 0.96])
    assert len(sheet.shares) == 2 and sheet.shares.sum(axis=0) == pytest.approx(1.0)
    assert (sheet.shares[0] > 0).tolist() == [True, True, True, False, False]
    folds = [point.parameter for point in sheet.branch.labelled("LP")]
    assert folds == pytest.approx([0.835837679, 0.598153117], abs=1e-6)
    basins = per.basins(
        sym.scene("gear-pair"), {"Omega": 0.66}, box={"x": (-3, 3), "x'": (-2, 2)}, starts=2000
    )
    for motion in basins.motions:
        near = min(sheet.shares[:, 1], key=lambda share: abs(share - motion.share))
        assert near == pytest.approx(motion.share, abs=4 * (motion.share * (1 - motion.share) / 40) ** 0.5)


def test_diagram_is_on_the_branch() -> None:
    """Assert that settled motions from any start are on one of the stable stretches at their value."""
    found = gears()
    at = found.dots[np.isclose(found.dots[:, 0], 0.66)]
    own = [float(states[0, 0]) for number, states in found.sheets[0].sections[1] if number >= 0]
    away = np.abs(at[:, 1:] - np.array(own)).min(axis=1)
    assert len(at) > 100 and away.max() < 1e-4


def test_words_and_picture(tmp_path: Path) -> None:
    """Assert what it says, and the axes of its picture."""
    found = gears()
    assert repr(found) == "Atlas(1 branches over Omega from 0.56 to 0.96)"
    lines = str(found).splitlines()
    assert lines[1].startswith("1: one period; bound reached")
    assert lines[2].startswith("   1a is stable from 0.56 to LP fold at 0.83583")
    assert (
        lines[3].startswith("   1b is stable from LP fold at 0.59815")
        and " to 0.96, and attracts " in lines[3]
    )
    assert lines[4].startswith("   GR grazing at 0.8284") and lines[4].endswith(", LP fold at 0.598153117")
    figure = found.plot()
    upper, lower = figure.axes
    assert (upper.get_ylabel(), lower.get_xlabel()) == ("x at tau = 0", "Omega (rad/s)")
    figure.savefig(tmp_path / "atlas.png")


def test_refusals() -> None:
    """Assert the sentences for what is not allowed."""
    system = oscillator()
    with pytest.raises(ValueError, match=r"bounds is \(2, 1\); it must be two finite numbers"):
        per.atlas(system, "Omega", (2, 1))
    with pytest.raises(ValueError, match="values has 'Omega', over which the atlas is; it must be left out"):
        per.atlas(system, "Omega", (1, 2), {"Omega": 1.0})
    with pytest.raises(ValueError, match="state is 'z'; it must be one of x, x'"):
        per.atlas(system, "Omega", (1, 2), state="z")
    with pytest.raises(ValueError, match="count is 1; it must be a whole number of at least 2"):
        per.atlas(system, "Omega", (1, 2), count=1)
    free = sym.Equations(lambda s, p: {"x": s.v, "v": -s.x - p.c * s.v}, {"x": 1.0, "v": 0.0}, {"c": 0.1})
    with pytest.raises(ValueError, match="the system is not excited"):
        per.atlas(sym.compile(free), "c", (0.1, 0.2), box={"x": (-1, 1), "v": (-1, 1)})


def test_speeds_of_the_box_are_those_asked_for() -> None:
    """Assert that a range of velocities is in SI at each value, and that the diagram of them is too."""
    box = {"x": (-2, 2), "x'": (-1, 1)}
    given = {"count": 2, "diagram": 2, "starts": 8, "places": 0, "periods": 1}
    found = per.atlas(oscillator(), "Omega", (0.5, 2.0), box=box, state="x'", **given)
    assert [motions.box["x'"] for motions in found.motions] == [pytest.approx((-1, 1))] * 2
    last = found.dots[found.dots[:, 0] == 2.0]
    end = next(p for p in found.sheets[0].branch if p.parameter == 2.0)
    assert last[:, 1] == pytest.approx(float(end.orbit["x'"](0.0)), abs=1e-4)
