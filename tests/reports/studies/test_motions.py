"""The report on motions: what is quick is computed anew, and what the page says is what is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from reports.studies.motions.disc import BOX, RPM
from reports.studies.motions.judge import STEPS, Oscillator, found, missed
from reports.studies.motions.page import REPORT
from reports.studies.motions.rub import TORUS, rotor
from reports.studies.motions.tori import coupled

pytestmark = pytest.mark.studies

FOLDER = REPORT.folder


def test_nothing_large_is_missed() -> None:
    """Assert that the page's count of attractors missed is that of its rows, and is none."""
    kept = REPORT.kept(FOLDER)["judged"]
    above = [share for row in kept.rows for _, share in row["missed"] if share > 0.005]
    assert len(above) == kept.numbers["missed"] == 0
    assert kept.numbers["oscillators"] == 50 and kept.numbers["attractors"] > 70


@pytest.mark.parametrize("seed", [38, 44])
def test_judge_and_search_are_fresh(seed: int) -> None:
    """Assert the attractors of an oscillator anew, and that the judge's few starts lead to no other."""
    (row,) = [row for row in REPORT.kept(FOLDER)["judged"].rows if row["seed"] == seed]
    oscillator = Oscillator(seed)
    motions = found(oscillator)
    assert [motion.periods for motion in motions.stable] == [periods for periods, _ in row["stable"]]
    assert not missed(oscillator, motions, oscillator.judged(60, 6 * STEPS))


def test_known_systems() -> None:
    """Assert what the page says beside what is known."""
    for row in REPORT.kept(FOLDER)["known"].rows:
        if "exponent" in row["what"]:
            assert row["found"] == pytest.approx(row["known"], abs=0.02)
        elif not math.isnan(row["known"]):
            assert row["found"] == pytest.approx(row["known"], rel=1e-4)


def test_disc_at_500() -> None:
    """Assert both motions in oil, anew from a few starts: the larger comes back after two turns of waves."""
    numbers = REPORT.kept(FOLDER)["disc"].numbers
    assert numbers["least_um"] == pytest.approx(1.17, abs=0.005)
    assert numbers["largest_um"] == pytest.approx(25.0, abs=0.05)
    disc = sym.scene("vitrea79-810N")
    motions = per.motions(disc, {"speed": 500 * RPM}, box=BOX, starts=16, periods=2, places=0)
    swings = sorted((m.periods, 1e6 * m.point.peak_to_peak("x")) for m in motions.stable if m.point)
    assert [periods for periods, _ in swings] == [1, 2]
    assert [swing for _, swing in swings] == pytest.approx(
        [numbers["least_um"], numbers["largest_um"]], rel=1e-4
    )


def test_tori_are_fresh() -> None:
    """Assert numbers of tori against what is known, and those of one of them anew."""
    kept = REPORT.kept(FOLDER)["tori"]
    assert kept.numbers["worst_ratio"] < 1e-7
    torus = per.settled_torus(coupled(), start={"x": 1.0, "y": 0.5})
    rows = {row["what"]: row["found"] for row in kept.rows}
    assert torus.frequencies[0] == pytest.approx(rows["T2 at 0.5, a frequency"], rel=1e-9)
    families = [row for row in kept.rows if math.isnan(row["known"])]
    assert [row["folds"] for row in families] == [4, 0, 0, 0, 0]
    assert [row["others"] for row in families] == [["PD"] * 4, [], [], [], []]


def test_basins_are_fresh() -> None:
    """Assert shares of the gear pair's basins from random starts, within four standard errors."""
    rows = [row for row in REPORT.kept(FOLDER)["basins"].rows if row["name"] == "gears"]
    given = {"box": {"x": (-3, 3), "x'": (-2, 2)}, "starts": 1000}
    anew = per.basins(sym.scene("gear-pair"), {"Omega": 0.7}, **given)
    for row, motion in zip(rows, anew.motions, strict=True):
        error = np.sqrt(row["share"] * (1 - row["share"]) / 1000)
        assert motion.share == pytest.approx(row["share"], abs=4 * error)


def test_rub_is_fresh() -> None:
    """Assert a torus of the rub anew, and that of no start it is unknown where it leads."""
    kept = REPORT.kept(FOLDER)["rub"]
    assert all(row["undecided"] == 0 for row in kept.rows)
    names = {name for row in kept.rows for name, *_ in row["stable"]}
    assert {"stable, periodic", "stable, torus", "stable, chaotic"} <= names
    torus = per.settled_torus(rotor(), {"speed": TORUS}, start={"x": 0.9})
    assert torus.rotation_number == pytest.approx(kept.numbers["rotation"], rel=1e-8)
    assert len(torus.breaks) == kept.numbers["breaks"] == 2
