"""Orbits of a branch between its points."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.stops import stopped

import periodic as per
import symbolic as sym


def duffing() -> sym.CompiledSystem:
    """x'' + .05 x' + x + x^3 = .3 cos(Omega t)."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": 0.3 * wave.cos - 0.05 * x.v - x.x - x.x**3}

    return sym.compile(sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"Omega": 1.0}, frequency="Omega"))


def test_three_orbits_of_one_speed() -> None:
    """Assert those that `at` would have given points, to the tolerance, in order along the branch."""
    system = duffing()
    branch = per.trace(system, "Omega", (0.5, 3.0), start=0.5)
    asked = per.trace(system, "Omega", (0.5, 3.0), start=0.5, at=(1.7,)).labelled(per.Label.USER)
    found = per.points_at(system, branch, 1.7)
    assert len(found) == len(asked) == 3
    for point, other in zip(found, asked, strict=True):
        assert point.parameter == 1.7 and point.label is per.Label.NONE
        assert point.maximum["x"] == pytest.approx(other.maximum["x"], rel=1e-6)
        assert np.sort(abs(point.multipliers)) == pytest.approx(np.sort(abs(other.multipliers)), abs=1e-6)
        assert point.stable is other.stable


def test_a_branch_has_its_orbits_at_any_value(tmp_path: Path) -> None:
    """Assert those of `points_at`, digit by digit, with the settings that it was traced with; from a file,
    which does not know its system, and for other names the sentence."""
    system = duffing()
    branch = per.trace(system, "Omega", (0.5, 3.0), start=0.5, tol=1e-8)
    found = branch.at(Omega=1.7)
    assert [p.maximum for p in found] == [p.maximum for p in per.points_at(system, branch, 1.7, tol=1e-8)]
    assert len(found) == 3 and max(point.error.orbit for point in found) < 1e-8
    with pytest.raises(ValueError, match=r"^at is given omega; it takes Omega, as at\(Omega=1.0\)$"):
        branch.at(omega=1.7)
    with pytest.raises(ValueError, match="^at is given nothing; it takes Omega"):
        branch.at()
    branch.save(tmp_path / "kept.nc")
    said = "^the branch is from a file, which does not know its system; points_at.system, branch, 1.7. does$"
    with pytest.raises(ValueError, match=said):
        per.Branch.load(tmp_path / "kept.nc").at(Omega=1.7)


def test_an_interrupted_branch_has_them_too() -> None:
    """Assert it of the part that there is."""
    system = duffing()

    seen = list[float]()

    def progress(point: per.Point) -> None:
        seen.append(point.parameter)
        if len(seen) == 5:
            raise KeyboardInterrupt

    with pytest.raises(per.Interrupted) as caught:
        per.trace(system, "Omega", (0.5, 3.0), start=3.0, watch=per.Watch(progress=progress))
    part = caught.value.branch
    middle = (part[1].parameter + part[2].parameter) / 2
    (point,) = part.at(Omega=middle)
    assert point.parameter == middle


def test_points_that_the_branch_has() -> None:
    """Assert the points themselves, at both ends and in between, each once."""
    system = duffing()
    branch = per.trace(system, "Omega", (2.5, 3.0), start=3.0)
    for k in (0, 3, len(branch) - 1):
        (point,) = per.points_at(system, branch, branch[k].parameter)
        assert point is branch[k]


def test_orbit_between_a_grazing_and_the_next_point() -> None:
    """Assert that it has the events that it has there, and that several points at a grazing are one."""
    system = stopped(1e2)
    branch = per.trace(system, "Omega", (0.6, 0.9), start=0.6)
    (grazing,) = branch.labelled(per.Label.GRAZING)
    (here,) = per.points_at(system, branch, grazing.parameter)
    assert here.parameter == grazing.parameter
    (beyond,) = per.points_at(system, branch, grazing.parameter + 1e-5)
    assert beyond.maximum["q"] > 1 and len(beyond.orbit.phases) == 2
    (before,) = per.points_at(system, branch, grazing.parameter - 1e-5)
    assert before.maximum["q"] < 1 and len(before.orbit.phases) == 0


def test_free_oscillation() -> None:
    """Assert z' = (mu + i) z - (1 + i / 2) |z|^2 z: |z| = mu^(1/2) and omega = 1 - mu / 2."""

    def rates(x: Any, p: Any) -> dict[str, Any]:
        square = x.x**2 + x.y**2
        return {
            "x": p.mu * x.x - x.y - square * (x.x - x.y / 2),
            "y": p.mu * x.y + x.x - square * (x.y + x.x / 2),
        }

    system = sym.compile(sym.Equations(rates, {"x": 0.0, "y": 0.0}, {"mu": 0.5}))
    rest = per.trace(system, "mu", (-0.1, 0.1), method=per.Equilibrium())
    guess = per.hopf(system, rest.labelled(per.Label.HOPF)[0].orbit, "mu")
    free: Any = {"omega": per.PhaseCondition()}
    branch = per.trace(system, "mu", (0.0, 1.0), guess=guess, determined=free)
    (point,) = per.points_at(system, branch, 0.3, determined=free)
    names = [parameter.name for parameter in system.parameters]
    assert point.parameter == 0.3 and point.maximum["x"] == pytest.approx(np.sqrt(0.3), rel=1e-6)
    assert point.orbit.parameter[names.index("omega")] == pytest.approx(0.85, rel=1e-6)


def test_values_that_are_not_on_the_branch() -> None:
    """Assert the sentences, and what is said of points of another force."""
    system = duffing()
    branch = per.trace(system, "Omega", (2.5, 3.0), start=3.0)
    nothing: Any = None
    with pytest.raises(ValueError, match="^branch is None; it must be a Branch$"):
        per.points_at(system, nothing, 2.7)
    with pytest.raises(ValueError, match="^value is 4; the branch has Omega from 2.5 to 3$"):
        per.points_at(system, branch, 4.0)
    with pytest.raises(ValueError, match="^value is nan; the branch has Omega"):
        per.points_at(system, branch, float("nan"))
    empty = per.trace(system, "Omega", (2.5, 3.0), start=3.0, control=per.ArclengthControl(max_newton=1))
    with pytest.raises(ValueError, match="^branch has no points; it ended with: largest number of Newton"):
        per.points_at(system, empty, 2.7)
    few = per.HarmonicBalance(harmonics=1, most=1)
    middle = (branch[2].parameter + branch[3].parameter) / 2
    with pytest.raises(ArithmeticError, match="was not reached from the points at .*: tolerance not reached"):
        per.points_at(system, branch, middle, method=few, tol=1e-10)


def test_peaks_by_name() -> None:
    """Assert that those asked for are there, with none where none is met."""
    watch = per.Watch(peaks={"high": per.Maximum("x"), "none": per.PeakToPeak("x")})
    branch = per.trace(duffing(), "Omega", (0.5, 3.0), start=0.5, watch=watch)
    assert set(branch.peaks) == {"high", "none"}
    assert branch.peaks["high"] == branch.labelled("high") and len(branch.peaks["high"]) >= 1
    assert per.trace(duffing(), "Omega", (2.5, 3.0)).peaks == {"peak of x": (), "peak of v": ()}
