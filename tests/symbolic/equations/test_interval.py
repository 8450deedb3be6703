"""Values that numbers of parts may have: refused where a part is made, a model compiled, a branch traced."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import periodic as per
import symbolic as sym

X, Y = sym.coordinate("x"), sym.coordinate("y")
DRIVEN = (sym.Mass(X, 1.0), sym.Damper(X, 0.1), sym.Spring(X, 1.0), sym.HarmonicForce(X, 0.1, 1.0))
SHAFT = (sym.Mass(X, 1.0), sym.Mass(Y, 1.0))


def system(*parts: sym.Part) -> sym.CompiledSystem:
    """A forced oscillator with more parts."""
    return sym.compile(sym.combine([*DRIVEN, *parts]))


def bearing(**given: object) -> sym.CompiledSystem:
    """A shaft in a ball bearing."""
    usual = {"law": sym.HertzLaw(1e9), "clearance": 1e-6, "speed": 100.0, "inner": 0.04, "outer": 0.06}
    part = sym.RollingBearing(X, Y, 8, **{**usual, **given})  # type: ignore[arg-type]
    return sym.compile(sym.combine([*SHAFT, part]))


def stretched(gap: float) -> sym.CompiledSystem:
    """An oscillator with a stop."""
    return system(sym.OneSidedSpring(X, sym.parameter("k_stop", 1.0, "N/m"), gap))


AT_LEAST = "it must be a number of at least 0"
REFUSED: list[tuple[Callable[[], object], str]] = [
    (lambda: sym.HertzLaw(-1.0), "stiffness of a HertzLaw is -1.0; it must be a positive number"),
    (lambda: sym.films.PowerFilm(1e-6, 0.0), "load of a PowerFilm is 0.0; it must be a positive number"),
    (lambda: system(sym.RigidStop(X, -0.5, 0.8)), "the rigid stop at x = -0.5 leaves no equilibrium"),
    (lambda: system(sym.RigidStop(X, -0.5, 0.8, below=True)), "the rigid stop at x = 0.5 leaves no equi"),
    (lambda: system(sym.Spring(X, 1.0, to=X)), "to is 'x' too; it must be another coordinate"),
    (lambda: system(sym.Coupling(X, X, 1.0)), "r is 'x' too; it must be another coordinate"),
    (lambda: sym.Unbalance(X, X, 1.0, 1.0), "y is 'x' too; it must be another coordinate"),
    (lambda: sym.Model(()), "parts is (); it must be a sequence of at least one Part"),
    (lambda: sym.Iwan(X, 1.0, 1.0), "limits is 1.0; it must be a sequence of numbers"),  # type: ignore[arg-type]
    (lambda: sym.GearMesh(X, 1.0, 1.0, 0.2), "variation is 0.2; it must be a sequence"),  # type: ignore[arg-type]
    (
        lambda: sym.films.SeriesFilm(sym.films.PowerFilm(1e-6, 1.0), 0),
        "contacts is 0; it must be a whole number",
    ),
    (lambda: bearing(clearance=-1.0), "clearance of x_y is -1.0; it must be a number from -0.0001 to 0.01"),
    (lambda: bearing(clearance=1.0), "clearance of x_y is 1.0; it must be a number from -0.0001 to 0.01"),
    (lambda: bearing(law=1e9), "law is 1000000000.0; it must be a ContactLaw"),
    (lambda: bearing(film=3), "film is 3; it must be a SeriesFilm"),
    (lambda: per.trace(system(), "Omega", (0.5, 1.0), values={"m": -1.0}), f"'m' is -1.0; {AT_LEAST}"),
    (
        lambda: per.trace(stretched(1.0), "k_stop", (-0.5, 1.0)),
        f"bound of parameter 'k_stop' is -0.5; {AT_LEAST}",
    ),
    (lambda: sym.simulate(system(), {"m": -1.0}), f"'m' is -1.0; {AT_LEAST}"),
    (
        lambda: per.design_map(
            per.maps.Task(system(), "Omega", (0.5, 1.0), numbers={"n": lambda task, branch: 1.0}),
            per.maps.Grid({"m": [1.0, -1.0]}),
        ),
        f"'m' is -1.0; {AT_LEAST}",
    ),
    (
        lambda: sym.compile(sym.combine([*DRIVEN[:3], force("m")])),
        "unit of 'f' is 'm'; it must be that of an",
    ),
]


def force(unit: str) -> sym.HarmonicForce:
    """A force of the frequency 0.2 in some unit."""
    return sym.HarmonicForce(X, 0.1, sym.parameter("f", 0.2, unit))


@pytest.mark.parametrize(("ask", "sentence"), REFUSED)
def test_refused(ask: Callable[[], object], sentence: str) -> None:
    """Assert the sentence."""
    with pytest.raises(ValueError) as error:
        ask()
    assert sentence in str(error.value)


def test_preloaded_bearing_is_allowed() -> None:
    """Assert that a small negative clearance is a preload."""
    assert dict((p.name, p.value) for p in bearing(clearance=-5e-6).parameters)["clearance"] == -5e-6


@pytest.mark.parametrize(("unit", "value"), [("Hz", 0.2), ("rev/min", 12.0)])
def test_unit_of_the_excitation(unit: str, value: float) -> None:
    """Assert that a frequency in Hz or rev/min is 2 pi or 2 pi/60 times that in rad/s."""
    frequency = sym.parameter("f", value, unit)
    own = sym.compile(sym.combine([*DRIVEN[:3], sym.HarmonicForce(X, 0.1, frequency)]))
    assert own.omega(own.nominal) == pytest.approx(0.4 * np.pi, rel=1e-15)
    (point, *_) = per.trace(own, "f", (0.9 * value, value), start=value)
    (other, *_) = per.trace(system(), "Omega", (0.36 * np.pi, 0.4 * np.pi), start=0.4 * np.pi)
    assert point.peak_to_peak("x") == pytest.approx(other.peak_to_peak("x"), rel=1e-12)
    assert point.maximum["x"] == pytest.approx(other.maximum["x"], rel=1e-12)


@pytest.mark.parametrize("value", [1e300, -1e300, 1e-300, 5e-324, 1.7e308, 1e101, 0.9e-100])
def test_numbers_at_the_ends_of_doubles(value: float) -> None:
    """Assert that numbers whose squares or reciprocals are none are refused, in models, traces and maps."""
    allowed = "it must be 0, or of a magnitude from 1e-100 to 1e.100$"
    with pytest.raises(ValueError, match=f"^k3 of x is .*; {allowed}"):
        system(sym.CubicSpring(X, value))
    found = system(sym.CubicSpring(X, 1.0))
    with pytest.raises(ValueError, match=f"^parameter 'k3' is .*; {allowed}"):
        per.trace(found, "Omega", (0.5, 0.6), values={"k3": value})
    task = per.maps.Task(found, "Omega", (0.5, 0.6), numbers={"peak": per.maps.Highest(per.PeakToPeak("x"))})
    with pytest.raises(ValueError, match=f"^parameter 'k3' is .*; {allowed}"):
        per.design_map(task, {"k3": [1.0, value]}, 1, store=None)


@pytest.mark.parametrize("value", [1e100, -1e100, 1e-100, 0.0])
def test_the_largest_and_the_least_are_taken(value: float) -> None:
    """Assert it of a parameter's nominal value."""
    assert {p.name: p.value for p in system(sym.CubicSpring(X, value)).parameters}["k3"] == value
