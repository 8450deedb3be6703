"""Key numbers of the report's section on regions of two motions, those that are quick to find again."""

from __future__ import annotations

import numpy as np
import pytest

import periodic as per
from reports.studies.paper import regions
from reports.studies.paper.branches.regions_curves import (
    AMPLITUDE,
    PRELOAD,
    SCENE,
    VISCOSITY,
    along,
    as_thin_as,
    fold,
    least_waviness,
    over,
)
from reports.studies.paper.common.discs import LUBRICATED, MICRO
from reports.studies.paper.common.scenes import system
from reports.studies.paper.page import REPORT
from reports.studies.paper.rows import rows
from symbolic.scenes.axes import RPM

pytestmark = pytest.mark.studies


def kept() -> dict[str, float]:
    """The numbers that the page was made from."""
    return {key: float(value) for key, value in REPORT.kept(REPORT.folder)["regions"].numbers.items()}


def speed(point: per.Point) -> float:
    """The speed of a point of a curve, rev/min."""
    return per.Value("speed")(system(SCENE), point.orbit) / RPM


CUSPS = {
    "vitrea79-810N": (278.184065, 0.053738324),
    "vitrea79-2100N": (328.575287, 0.042185671),
    "turbo33-810N": (282.450844, 0.00023066966),
    "turbo33-2100N": (331.294312, 0.00019910685),
}


def test_least_waviness_with_two_motions() -> None:
    """Assert the cusp of the disc with oil A at 810 N, traced anew."""
    found, amplitude = least_waviness(SCENE)
    assert found == pytest.approx(CUSPS[SCENE][0], rel=1e-7)
    assert amplitude / MICRO == pytest.approx(CUSPS[SCENE][1], rel=1e-7)


@pytest.mark.parametrize("name", LUBRICATED)
def test_averaging_comes_near_the_cusps(name: str) -> None:
    """Assert that the page's cusps are these, and that averaging to first order in the damping comes near."""
    found, amplitude = CUSPS[name]
    assert kept()[f"{name} cusp rpm"] == pytest.approx(found, rel=1e-7)
    assert kept()[f"{name} cusp um"] == pytest.approx(amplitude, rel=1e-7)
    near, size = regions.averaged(name)
    # the damping ratio is 0.006 with oil A, 0.00015 with oil B
    rough = 0.05 if name.startswith("vitrea79") else 2e-3
    assert near == pytest.approx(found, rel=1e-3)
    assert size / MICRO == pytest.approx(amplitude, rel=rough)


@pytest.mark.parametrize("factor, count", [(0.98, 0), (1.02, 2)])
def test_folds_begin_at_the_cusp(factor: float, count: int) -> None:
    """Assert that branches over speed have no fold below the cusp's waviness and two above it."""
    across = over(AMPLITUDE, factor * CUSPS[SCENE][1] * MICRO, 270.0, 290.0)
    assert len(across.labelled(per.Label.FOLD)) == count


def test_lower_folds_over_preload() -> None:
    """Assert that the curve of the lower fold meets that of the disc with 2100 N and a branch at 200 N."""
    curve = along(PRELOAD, per.FoldCondition(), fold(1), (150.0, 2200.0), at=(200.0, 2100.0))
    light, heavy = (speed(point) for point in curve.labelled(per.Label.USER))
    if light > heavy:
        light, heavy = heavy, light
    # a fold of the branch of that disc in tests/reports/studies/paper/test_unseen.py
    assert heavy == pytest.approx(307.692770, abs=2e-6)
    assert light == pytest.approx(kept()["fold 2 at 200 N rpm"], rel=1e-8)
    up = per.trace(
        system(SCENE),
        "speed",
        (0.9 * light * RPM, 1.1 * light * RPM),
        start=0.9 * light * RPM,
        values={PRELOAD: 200.0},
        watch=per.Watch(stop={"LP": 1}),
    )
    assert up[-1].parameter / RPM == pytest.approx(light, rel=1e-8)


def test_lower_fold_over_viscosity_meets_the_other_oil() -> None:
    """Assert that the oil enters by its film alone: at a viscosity that makes oil B's film, oil B's fold."""
    thin = as_thin_as("turbo33-810N")
    curve = along(VISCOSITY, per.FoldCondition(), fold(1), (0.02, 1.0), at=(thin,), stop={"UZ": 1})
    (point,) = curve.labelled(per.Label.USER)
    assert speed(point) == pytest.approx(253.316928, abs=2e-6)
    assert not curve.labelled(per.Label.CUSP)


def test_speed_rises_and_folds_stay_apart() -> None:
    """Assert what the page says of preload and viscosity: no cusp, folds apart at both ends."""
    n = kept()
    for where in ("20 N", "1e+04 N", "0.02 Pas", "20 Pas"):
        assert n[f"fold 2 at {where} rpm"] - n[f"fold 1 at {where} rpm"] > 2.0
    peaks = [n[f"peak at {q} N rpm"] for q in ("20", "200", "810", "2100", "1e+04")]
    assert (np.diff(peaks) > 0).all()
    # highest points of branches over speed, by a spline: tests/reports/studies/paper/test_frequency.py
    assert n["peak at 810 N um"] == pytest.approx(26.207, abs=2e-3)
    assert n["peak at 2100 N um"] == pytest.approx(41.537, abs=2e-3)


def test_checks_of_the_page() -> None:
    """Assert that curves and branches met on the page, and its counts about cusps and tips."""
    n = kept()
    differences = [value for key, value in n.items() if key.startswith("difference")]
    assert len(differences) == 6 and max(differences) < 1e-8
    assert n["level difference"] < 1e-8
    assert n["doublings there um"] == pytest.approx(n["two periods shrink at um"], rel=1e-5)
    # over viscosity the folds and doublings are below, over waviness above
    below = [key for key in n if key.endswith(" at 0.95 of it")]
    assert len(below) == 5
    for key in below:
        pair = n[key], n[key.replace("0.95", "1.05")]
        assert pair == ((2, 0) if VISCOSITY in key else (0, 2))


def test_rows() -> None:
    """Assert the verdicts of this section's rows."""
    assert {row.key: row.verdict for row in rows("regions", kept())} == {
        "P17": "reproduced",
        "P18": "reproduced",
    }
