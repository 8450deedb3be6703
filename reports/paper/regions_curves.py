"""Curves over speed and a second parameter: folds, doublings, folds of doubled orbits, peaks, one level.

All of the disc with oil A at 810 N; each curve begins at an orbit of a branch over speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import periodic
from periodic import Branch, DoublingCondition, FoldCondition, Label, Level, Orbit, Peak, PeakToPeak
from reports.paper.doubled import doubled, small
from reports.paper.scenes import branch, system
from reports.paper.stiffness import nominal
from reports.view import RPM

SCENE = "vitrea79-810N"

AMPLITUDE, PRELOAD, VISCOSITY = "amplitude", "preload", "viscosity"

RANGES = {AMPLITUDE: (1e-9, 4e-6), PRELOAD: (20.0, 10000.0), VISCOSITY: (0.02, 20.0)}
"""Corrugation amplitude in m, preload in N, viscosity in Pa s."""

HEAVY, OTHER_OIL = "vitrea79-2100N", "turbo33-810N"


def as_thin_as(name: str) -> float:
    """Return the viscosity (Pa s) at which oil A makes the film of another disc's oil.

    h0 is as viscosity^0.625 piezoviscosity^0.46.
    """
    own, other = nominal(SCENE), nominal(name)
    return float(other["viscosity"] * (other["piezoviscosity"] / own["piezoviscosity"]) ** (0.46 / 0.625))


def common() -> dict[str, tuple[float, ...]]:
    """Return the values of each second parameter at which curves are compared with branches over speed."""
    return {AMPLITUDE: (0.5e-6, 3e-6), PRELOAD: (200.0, 2100.0), VISCOSITY: (as_thin_as(OTHER_OIL), 5.0)}


def traced(
    second: str,
    condition: DoublingCondition | FoldCondition | Level | Peak,
    guess: Orbit,
    bounds: tuple[float, float] | None = None,
    at: tuple[float, ...] = (),
    stop: Mapping[str, int] | None = None,
) -> Branch:
    """Return the curve over a second parameter on which a condition determines the speed."""
    return periodic.trace(
        system(SCENE),
        second,
        bounds or RANGES[second],
        guess=guess,
        determined={"speed": condition},
        at=at,
        stop=stop,
    )


def fold(which: int, name: str = SCENE) -> Orbit:
    """Return the orbit at the upper (0) or lower (1) fold of the resonance."""
    return branch(name).labelled(Label.FOLD)[which].orbit


@cache
def folds(second: str) -> tuple[Branch, ...]:
    """Return the curves of the resonance's folds: the lower's, and the upper's where it is another curve."""
    lower = traced(second, FoldCondition(), fold(1), at=common()[second])
    if lower.labelled(Label.CUSP):
        return (lower,)
    return lower, traced(second, FoldCondition(), fold(0), at=common()[second])


@cache
def least_waviness(name: str) -> tuple[float, float]:
    """Return speed (rad/s) and amplitude (m) of the cusp that the lower fold of a disc comes to."""
    amplitude = nominal(name)[AMPLITUDE]
    found = periodic.trace(
        system(name),
        AMPLITUDE,
        (1e-6 * amplitude, amplitude),
        guess=fold(1, name),
        determined={"speed": FoldCondition()},
        stop={"CP": 1},
    )
    (cusp,) = found.labelled(Label.CUSP)
    return float(found.column("speed")[list(found).index(cusp)]), cusp.parameter


HALF = {AMPLITUDE: (5e-6, (136.0, 142.0), (1e-6, 5.5e-6)), VISCOSITY: (0.03, (110.0, 160.0), (0.02, 1.0))}
"""A value of the second parameter at which the 2:1 resonance has folds, speeds (rev/min) about them, and the
range that their curve is traced over."""


@cache
def half(second: str) -> Branch:
    """Return the curve of the folds of the 2:1 resonance, at half the natural speed."""
    value, (low, high), bounds = HALF[second]
    over_speed = over(second, value, low, high)
    return traced(second, FoldCondition(), over_speed.labelled(Label.FOLD)[-1].orbit, bounds)


def over(second: str, value: float, low: float, high: float, stop: Mapping[str, int] | None = None) -> Branch:
    """Return the branch over speed (rev/min), from the upper end down, at a value of the second parameter."""
    ends = (low * RPM, high * RPM)
    return periodic.trace(system(SCENE), "speed", ends, start=ends[1], values={second: value}, stop=stop)


@cache
def doublings(second: str) -> tuple[Branch, ...]:
    """Return the curves of the small motion's doublings: the faster's, and the slower's if it is another."""
    faster, slower = (point.orbit for point in small().labelled(Label.DOUBLING))
    at = common()[second]
    first = traced(second, DoublingCondition(), faster, at=at)
    if second != PRELOAD:
        return (first,)
    return first, traced(second, DoublingCondition(), slower, at=at)


DOUBLED = {AMPLITUDE: (0.4e-6, 4e-6), PRELOAD: (100.0, 10000.0), VISCOSITY: (0.02, 12.0)}
"""Ranges over which orbits of two periods are traced."""


@cache
def doubled_folds(second: str) -> Branch:
    """Return the curve of the fold at which orbits of two periods end, until they shrink to one period."""
    begin = doubled().labelled(Label.FOLD)[0].orbit
    return traced(second, FoldCondition(), begin, DOUBLED[second], at=common()[second], stop={"CP": 1})


FURTHER = 1.25
"""Speeds, in parts of the fold's, up to which motions of two periods are followed from their fold."""


@cache
def doubled_again(second: str, value: float) -> tuple[float, float]:
    """Return the speeds (rad/s) of the fold of motions of two periods and of their own first doubling.

    At a common value of the second parameter, on the sheet of the larger motion.
    """
    (begin,) = [p for p in doubled_folds(second).labelled(Label.USER) if p.parameter == value]
    fold_speed = periodic.Value("speed")(system(SCENE), begin.orbit)
    ends = (fold_speed / FURTHER, fold_speed * FURTHER)
    found = periodic.trace(system(SCENE), "speed", ends, guess=begin.orbit, stop={"PD": 1})
    (doubling,) = found.labelled(Label.DOUBLING)
    return fold_speed, doubling.parameter


@cache
def peaks(second: str) -> Branch:
    """Return the orbits of the largest x peak to peak over speed."""
    top = max(branch(SCENE), key=lambda point: point.peak_to_peak("x"))
    return traced(second, Peak(PeakToPeak("x")), top.orbit, at=(*common()[second], nominal(SCENE)[second]))


LEVEL = 10e-6
"""x peak to peak (m) of the curve of constant ripple."""


@cache
def level() -> Branch:
    """Return the orbits over preload whose x is 10 um peak to peak, from the upper sheet's at 810 N on."""
    crossing = periodic.trace(
        system(SCENE),
        "speed",
        (300 * RPM, 330 * RPM),
        start=330 * RPM,
        events={"level": Level(PeakToPeak("x"), LEVEL)},
        stop={"level": 1},
    )
    at = (*common()[PRELOAD], nominal(SCENE)[PRELOAD])
    return traced(PRELOAD, Level(PeakToPeak("x"), LEVEL), crossing[-1].orbit, at=at)
