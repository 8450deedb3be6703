"""Peaks of measures along a branch, wherever its points lie, against closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import periodic as per
import symbolic as sym
from periodic.orbit.orbit import Orbit
from periodic.system import System


def oscillator(ratio: float) -> sym.CompiledSystem:
    """A mass on a spring, forced by 1 N."""
    x, omega = sym.coordinate("x"), sym.parameter("Omega", 0.5, "rad/s")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 2 * ratio), sym.HarmonicForce(x, 1.0, omega)]
    return sym.compile(sym.combine(parts))


class Swing:
    """Peak to peak of x, without a derivative."""

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return it."""
        return per.PeakToPeak("x")(system, orbit)


@pytest.mark.parametrize("measure", [per.PeakToPeak("x"), Swing()], ids=["derivative", "difference"])
@pytest.mark.parametrize("ratio", [0.01, 0.1, 0.3])
def test_resonance_of_an_oscillator(ratio: float, measure: Any) -> None:
    """Assert frequency (1 - 2 z^2)^(1/2) and amplitude 1/(2 z (1 - z^2)^(1/2)) of its peak, to 1e-6."""
    watch = per.Watch(peaks={"resonance": measure})
    branch = per.trace(oscillator(ratio), "Omega", (0.5, 1.5), tol=1e-8, watch=watch)
    (peak,) = branch.labelled("resonance")
    assert (peak.label, peak.event) == ("PK", "resonance")
    assert peak.parameter == pytest.approx(math.sqrt(1 - 2 * ratio**2), rel=1e-6)
    assert peak.peak_to_peak("x") == pytest.approx(1 / (ratio * math.sqrt(1 - ratio**2)), rel=1e-9)
    assert max(p.peak_to_peak("x") for p in branch) <= peak.peak_to_peak("x") * (1 + 1e-12)


def test_peak_beside_a_fold_and_trough() -> None:
    """Assert that a hardening oscillator peaks before its fold, once on the whole branch, with no trough."""
    x, omega = sym.coordinate("x"), sym.parameter("Omega", 0.5, "rad/s")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.05), sym.CubicSpring(x, 1.0)]
    system = sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 0.3, omega)]))
    watch = per.Watch(peaks={"peak": per.PeakToPeak("x")}, stop={"peak": 9})
    branch = per.trace(system, "Omega", (1.0, 4.0), watch=watch)
    (peak,) = branch.labelled("peak")
    fold = branch.labelled("LP")[0]
    assert peak.parameter < fold.parameter
    assert peak.peak_to_peak("x") > fold.peak_to_peak("x")
    assert peak.peak_to_peak("x") == max(p.peak_to_peak("x") for p in branch)


def test_branch_ends_at_its_peak() -> None:
    """Assert that `stop` knows the names of peaks."""
    watch = per.Watch(peaks={"resonance": per.PeakToPeak("x")}, stop={"resonance": 1})
    branch = per.trace(oscillator(0.1), "Omega", (0.5, 1.5), watch=watch)
    assert branch[-1].event == "resonance"


def test_condensed_structure() -> None:
    """Assert the peak of a light cantilever's tip with a cubic spring, where only places are unknowns."""
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=10)
    part = sym.Structure(beam, damping=0.02)
    tip, omega = part["tip"], sym.parameter("Omega", 3.0, "rad/s")
    model = part + sym.CubicSpring(tip, 1.0) + sym.HarmonicForce(tip, 0.02, omega)
    watch = per.Watch(peaks={"peak": per.PeakToPeak("tip")})
    found = [
        per.trace(sym.compile(model, condense=way), "Omega", (3.0, 4.0), tol=1e-7, watch=watch)
        for way in (True, False)
    ]
    (first,), (second,) = (branch.labelled("peak") for branch in found)
    assert first.parameter == pytest.approx(second.parameter, rel=2e-6)
    assert first.peak_to_peak("tip") == pytest.approx(second.peak_to_peak("tip"), rel=1e-7)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"peaks": {"peak": 1.0}}, "peak peak is 1.0; it must be a functional of an orbit"),
        ({"peaks": {"LP": per.PeakToPeak("x")}}, "peaks has 'LP', which is a label or an event"),
        ({"peaks": 3}, "peaks is 3"),
        ({"peaks": {"a": per.PeakToPeak("x")}, "stop": {"b": 1}}, "stop has 'b'; it must name .*, a$"),
    ],
)
def test_bad_peaks(given: dict[str, Any], said: str) -> None:
    """Assert the sentences."""
    with pytest.raises((ValueError, TypeError), match=f"^{said}"):
        per.Watch(**given)


def test_rotor_in_a_film_whose_resonance_lies_between_points() -> None:
    """Assert the peak of a rigid rotor of 35 kg on a journal bearing, 32.0 nm at 4463 rev/min."""
    rpm = math.pi / 30
    x, y = (sym.coordinate(name, scale=1e-5) for name in "xy")
    speed = sym.parameter("speed", 2000 * rpm, "rad/s")
    film = sym.JournalBearing(x, y, viscosity=0.018, radius=0.03, length=0.02, clearance=8e-5, speed=speed)
    parts = [sym.Mass(x, 35.0), sym.Mass(y, 35.0), sym.ConstantForce(y, -35 * 9.81), film]
    system = sym.compile(sym.combine([*parts, sym.Unbalance(x, y, 35.0, 1e-8, speed)]))
    watch = per.Watch(peaks={"peak of x": per.PeakToPeak("x")})
    branch = per.trace(system, "speed", (2000 * rpm, 8000 * rpm), start=2000 * rpm, watch=watch)
    (peak,) = branch.labelled("peak of x")
    assert peak.parameter / rpm == pytest.approx(4462.71, abs=0.01)
    assert 1e9 * peak.peak_to_peak("x") == pytest.approx(32.0166, abs=1e-3)


def test_peak_that_is_not_met(tmp_path: Path) -> None:
    """Assert that a branch has no points of its name, also from a file, and asks for it when resumed."""
    watch = per.Watch(peaks={"resonance": per.PeakToPeak("x")})
    system, few = oscillator(0.1), per.ArclengthControl(max_points=2)
    branch = per.trace(system, "Omega", (1.2, 1.5), control=few, watch=watch)
    branch.save(tmp_path / "branch.nc")
    read = per.Branch.load(tmp_path / "branch.nc")
    assert branch.labelled("resonance") == read.labelled("resonance") == ()
    with pytest.raises(ValueError, match="^label is 'other'; it must be one of .*, resonance$"):
        read.labelled("other")
    with pytest.raises(per.ResumeError, match="peaks"):
        per.trace(system, "Omega", (1.2, 1.5), guess=read)
    whole = per.trace(system, "Omega", (1.2, 1.5), guess=read, watch=watch)
    assert whole.stop.reason is per.Reason.BOUND


def test_branch_of_a_file_that_is_older_than_peaks() -> None:
    """Assert that it is taken up, where none are asked for, and not where some are."""
    system, few = oscillator(0.1), per.ArclengthControl(max_points=2)
    branch = per.trace(system, "Omega", (1.2, 1.5), control=few)
    points = tuple(replace(p, minimum_slope={}, maximum_slope={}) for p in branch.points)
    made = {name: value for name, value in branch.made.items() if name != "peaks"}
    older = replace(branch, points=points, made=made)
    assert per.trace(system, "Omega", (1.2, 1.5), guess=older).stop.reason is per.Reason.BOUND
    with pytest.raises(per.ResumeError, match="peaks"):
        watch = per.Watch(peaks={"resonance": per.PeakToPeak("x")})
        per.trace(system, "Omega", (1.2, 1.5), guess=older, watch=watch)


def test_optimum_of_a_design_scales_with_its_loads() -> None:
    """Assert that twice the force and twice the slip limit give twice the lowest peak, at twice the limit."""
    damper, swing = sym.scene("jenkins-damper"), per.PeakToPeak("x")
    found = []
    for times in (1.0, 2.0):
        force = times * float(damper.nominal[[p.name for p in damper.parameters].index("F")])
        response = per.trace(damper, "Omega", (0.9, 1.4), values={"F_slider": 0.1 * times, "F": force})
        highest = max(response, key=lambda point: point.peak_to_peak("x"))
        curve = per.trace(
            damper,
            "F_slider",
            (0.09 * times, 0.2 * times),
            guess=highest.orbit,
            determined={"Omega": per.Peak(swing)},
            watch=per.Watch(peaks={"lowest": swing}),
        )
        (best,) = curve.peaks["lowest"]
        found.append((best.peak_to_peak("x") / times, best.parameter / times))
    assert found[0] == pytest.approx(found[1], rel=1e-8)
