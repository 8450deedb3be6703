"""Tori of settled motions and their families: known numbers, births, folds, both kinds of frequencies."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from support.kept import kept

import periodic as per
import symbolic as sym
from periodic.tori.family import Family
from reports.studies.motions.tori import coupled, forced, two_forces

pytestmark = pytest.mark.usefixtures("users_kernels")


@kept
def with_two_forces() -> per.Torus:
    """The torus at eta = 1.9."""
    return per.settled_torus(two_forces())


def test_two_forces() -> None:
    """Assert rotation number sqrt(2), and averages known to ten digits from integration over 4000 units."""
    system, torus = two_forces(), with_two_forces()
    assert torus.rotation_number == pytest.approx(math.sqrt(2) - 1, rel=1e-10)
    for power, name, known in (
        (2, "x", 0.00542667682441),
        (4, "x", 5.63111720483e-5),
        (2, "v", 0.0225188513595),
    ):
        found = per.tori.average(system, torus, lambda s, name=name, power=power: s[name] ** power)
        assert found == pytest.approx(known, rel=1e-9)


def test_both_frequencies_free() -> None:
    """Assert the frequencies of coupled oscillators near a resonance of 10 to 7, and averages."""
    system = coupled()
    torus = per.settled_torus(system, start={"x": 1.0, "y": 0.5})
    first, beside = torus.frequencies
    assert torus.free
    assert sorted([first, first - beside]) == pytest.approx([1.0315375291, 1.47363265105], rel=1e-9)
    assert per.tori.average(system, torus, lambda s: s["x"] ** 2) == pytest.approx(1.99803323659, rel=1e-9)
    assert per.tori.average(system, torus, lambda s: s["y"] ** 2) == pytest.approx(1.99380063634, rel=1e-9)
    exponents = per.lyapunov(system, start={"x": 1.0, "y": 0.5}, periods=1000)
    sizes = np.abs(per.tori.torus_multipliers(system, torus))
    assert sizes[:2] == pytest.approx([1.0, 1.0], abs=1e-6)
    assert sizes[2:] == pytest.approx(np.exp(exponents.values[2:] * torus.period), rel=2e-3)


def test_one_frequency_free() -> None:
    """Assert the free frequency of a forced oscillator, and the average of x^2."""
    torus = per.settled_torus(forced())
    assert 1.4 * (1 - torus.rotation_number) == pytest.approx(0.9965355256, rel=1e-9)
    assert per.tori.average(forced(), torus, lambda s: s["x"] ** 2) == pytest.approx(1.9463176, rel=1e-7)


@kept
def rotor_family() -> per.tori.TorusBranch:
    """Whirl of the rotor with internal damping, traced down to its birth."""
    rotor = sym.scene("jeffcott-internal-damping")
    torus = per.settled_torus(rotor, {"n": 2.0})
    return per.trace(rotor, "n", (1.6, 2.2), guess=torus, at=[2.1])


def test_family_ends_where_it_is_born() -> None:
    """Assert the torus bifurcation that the branch of orbits has at 1.7147671116, from the tori alone."""
    family = rotor_family()
    told = family.stops[0]
    assert told.startswith("the torus shrinks to an orbit, a torus bifurcation (NS) near ")
    assert float(told.rpartition(" ")[2]) == pytest.approx(1.7147671116, rel=1e-6)
    assert family.stops[1] == "end of the range at 2.2"
    assert all(point.stable for point in family if point.torus.size > 0.05)
    (asked,) = family.labelled("UZ")
    assert asked.parameter == 2.1
    again = per.settled_torus(sym.scene("jeffcott-internal-damping"), {"n": 2.1})
    assert again.rotation_number == pytest.approx(asked.torus.rotation_number, rel=1e-8)


def test_both_ways_to_a_torus() -> None:
    """Assert that the torus of a motion is that followed from its birth."""
    rotor = sym.scene("jeffcott-internal-damping")
    branch = per.trace(rotor, "n", (1.2, 2.0), start=1.2)
    born = per.torus(rotor, branch.labelled("NS")[0], "n", 2.0)
    (middle,) = [point for point in rotor_family() if point.parameter == pytest.approx(2.0, abs=1e-12)]
    turns = middle.torus.rotation_number  # the other way round its curve
    assert 1 - turns == pytest.approx(born.rotation_number, rel=1e-9)
    assert middle.torus.size == pytest.approx(born.size, rel=1e-8)


def test_family_round_its_folds() -> None:
    """Assert the folds of the oscillator with two forces, each an end of what is stable."""
    system = two_forces()
    family = per.trace(system, "eta", (1.2, 2.0), guess=with_two_forces())
    folds = [point.parameter for point in family.labelled("LP")]
    assert folds == pytest.approx([1.796784629, 1.337617627], abs=1e-8)
    finer = per.trace(system, "eta", (1.2, 1.9), guess=per.settled_torus(system, angles=81))
    assert sorted(p.parameter for p in finer.labelled("LP")) == pytest.approx(sorted(folds), abs=1e-8)
    first, last = (family.points.index(fold) for fold in family.labelled("LP"))
    assert not any(point.stable for point in family[first + 1 : last])
    assert family.rotation_numbers == pytest.approx(math.sqrt(2) - 1, rel=1e-9)


def test_motion_in_time_is_that_of_the_equations() -> None:
    """Assert a hundred periods on a torus against a motion followed by another integrator."""
    system, torus = forced(), per.settled_torus(forced())
    time, states = per.tori.in_time(system, torus, periods=20, samples=16)
    path = system.motion(torus.states[0], np.zeros(0), torus.parameter, time * 1.4, 1e-12)
    assert np.abs(states["x"] - path.state[:, 0]).max() < 1e-7


def test_spectrum(tmp_path: Path) -> None:
    """Assert Parseval's sum of all lines, and the strongest against a long motion's Fourier sum."""
    system, torus = forced(), per.settled_torus(forced())
    lines = per.tori.combinations(system, torus, "x", lines=1000)
    mean = lines.amplitudes[(lines.orders == 0).all(axis=1)]
    power = (lines.amplitudes**2).sum() / 2 + (mean**2).sum() / 2
    assert power == pytest.approx(per.tori.average(system, torus, lambda s: s["x"] ** 2), rel=1e-10)
    time, states = per.tori.in_time(system, torus, periods=2000, samples=32)
    window = np.exp(-1 / np.maximum(1 - np.linspace(-1, 1, len(time)) ** 2, 1e-12))
    for at, size in zip(lines.frequencies[:4], lines.amplitudes[:4], strict=True):
        one = 2 * abs(window @ (states["x"] * np.exp(-1j * at * time))) / window.sum()
        assert one == pytest.approx(size, rel=1e-5)
    own = 1.4 * (1 - torus.rotation_number)
    assert lines.frequencies[:2] == pytest.approx([own, 1.4], rel=1e-9)
    assert repr(lines).startswith("Combinations(") and "of x, the strongest 1.9" in repr(lines)
    axes = lines.plot()
    assert axes.get_ylabel() == "amplitude of x"
    axes.figure.savefig(tmp_path / "spectrum.png")
    with pytest.raises(ValueError, match="name is 'y'; it must be one of x, v"):
        per.tori.combinations(system, torus, "y")


def test_tables_and_pictures(tmp_path: Path) -> None:
    """Assert what a family and its points say, and the axes of its picture."""
    family = rotor_family()
    assert "rotation number" in str(family).splitlines()[0] and "<table" in family._repr_html_()
    assert repr(family).startswith(f"TorusBranch({len(family)} tori over n; the torus shrinks")
    assert repr(family[3]).startswith("TorusPoint(")
    axes = family.plot()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("n (rad/s)", "size of the section (scaled)")
    axes.figure.savefig(tmp_path / "family.png")


def test_refusals() -> None:
    """Assert a sentence for motions that are no tori, and for arguments that are for orbits."""
    with pytest.raises(per.TorusError, match="the motion is not quasi-periodic with two frequencies"):
        per.settled_torus(sym.scene("duffing"), {"Omega": 2.0})
    with pytest.raises(ValueError, match="angles is 40; it must be odd"):
        per.settled_torus(forced(), angles=40)
    torus = with_two_forces()
    with pytest.raises(ValueError, match=r"tol is 0\.001; with a Torus as a guess it must be left out"):
        per.trace(two_forces(), "eta", (1.0, 2.0), guess=torus, tol=1e-3)  # type: ignore[call-overload]
    with pytest.raises(ValueError, match="start is 3; it must lie within the bounds 1 to 2"):
        per.trace(two_forces(), "eta", (1.0, 2.0), guess=torus, start=3.0)
    with pytest.raises(ValueError, match=r"bounds is \(2, 1\); it must be two finite numbers"):
        per.trace(two_forces(), "eta", (2, 1), guess=torus)


def test_what_is_not_found_on_the_way_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a value asked for at which Newton's method fails is named where the family says its end."""
    monkeypatch.setattr(Family, "between", lambda *given: None)
    family = per.trace(forced(), "eta", (1.4, 1.44), guess=per.settled_torus(forced()), at=[1.41])
    assert "no torus UZ was found near 1.41" in family.stops[1]
    assert family.stops[1].startswith("end of the range at 1.44") and not family.labelled("UZ")
