"""Branches that several test modules look at, each traced once per session."""

from __future__ import annotations

import math

import numpy as np

import periodic as per
import symbolic as sym
from support.kept import kept, once
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

RPM = 2 * math.pi / 60
STANDARD, FINE = per.Accuracy.STANDARD, per.Accuracy.FINE
NO_VALUES: tuple[float, ...] = ()


@once
def duffing_system(damping: float, cubic: float, force: float) -> sym.CompiledSystem:
    """x'' + damping x' + x + cubic x^3 = force cos(Omega t)."""
    x = sym.coordinate("x")
    oscillator = sym.Mass(x, 1.0) + sym.Damper(x, damping) + sym.Spring(x, 1.0)
    return sym.compile(oscillator + sym.CubicSpring(x, cubic) + sym.HarmonicForce(x, force))


DUFFING_A = (0.1, 1.0, 0.5)
DUFFING_NLVIB = (0.05, 0.1, 0.18)


@kept
def duffing(
    problem: tuple[float, float, float] = DUFFING_A,
    accuracy: per.Accuracy = STANDARD,
    bounds: tuple[float, float] = (0.3, 3.0),
    at: tuple[float, ...] = NO_VALUES,
) -> per.Branch:
    """Branch of a Duffing oscillator from one bound to the other."""
    return per.trace(duffing_system(*problem), "Omega", bounds, at=at, tol=accuracy)


@once
def disc_system(scene: str, ratio: float | None = None) -> sym.CompiledSystem:
    """Compiled system of a disc scene, perhaps at another damping ratio."""
    return build(load(scene, [] if ratio is None else [("damping.ratio", str(ratio))]))


@kept
def disc(
    scene: str = "vitrea79-810N",
    accuracy: per.Accuracy | float = STANDARD,
    rpm: tuple[float, float] = (500.0, 100.0),
    at: tuple[float, ...] = NO_VALUES,
    ds: float = per.ArclengthControl().ds,
    ratio: float | None = None,
) -> per.Branch:
    """Branch of a disc scene between two speeds in rev/min."""
    return per.trace(
        disc_system(scene, ratio),
        "speed",
        (rpm[0] * RPM, rpm[1] * RPM),
        at=[value * RPM for value in at],
        tol=accuracy,
        control=per.ArclengthControl(ds=ds),
    )


def fold_speeds(branch: per.Branch) -> list[float]:
    """Speeds of the folds of a disc branch in rev/min, in order along it."""
    return [point.parameter / RPM for point in branch.labelled(per.Label.FOLD)]


def user_points(branch: per.Branch, value: float) -> list[per.Point]:
    """The points (UZ) at just one parameter value, in order along the branch."""
    return [point for point in branch.labelled(per.Label.USER) if point.parameter == value]


def largest_multiplier(point: per.Point) -> float:
    """The largest modulus of a point's multipliers."""
    return float(np.abs(point.multipliers).max())
