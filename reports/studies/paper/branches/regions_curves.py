"""Curves over speed and a second parameter: folds, doublings, folds of doubled orbits, peaks, one level.

All of the disc with oil A at 810 N; each curve begins at an orbit of a branch over speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from periodic import Branch, DoublingCondition, FoldCondition, Label, Level, Orbit, Peak, PeakToPeak
from reports.studies.paper.branches.doubled import doubled, small
from reports.studies.paper.common.discs import MICRO, OIL_A, OIL_B
from reports.studies.paper.common.scenes import nominal, system
from reports.studies.paper.common.tracing import Condition, branch, speed, traced

SCENE = OIL_A

SECONDS = AMPLITUDE, PRELOAD, VISCOSITY = "amplitude", "preload", "viscosity"

UNITS = {AMPLITUDE: (MICRO, "um"), PRELOAD: (1.0, "N"), VISCOSITY: (1.0, "Pas")}
"""What one unit of each second parameter is in SI, and how names of numbers call it."""

RANGES = {AMPLITUDE: (1e-9, 4e-6), PRELOAD: (20.0, 10000.0), VISCOSITY: (0.02, 20.0)}
"""Corrugation amplitude in m, preload in N, viscosity in Pa s."""


def as_thin_as(name: str) -> float:
    """Return the viscosity (Pa s) at which oil A makes the film of another disc's oil.

    h0 is as viscosity^0.625 piezoviscosity^0.46.
    """
    own, other = nominal(SCENE), nominal(name)
    return float(other["viscosity"] * (other["piezoviscosity"] / own["piezoviscosity"]) ** (0.46 / 0.625))


def common(second: str) -> tuple[float, ...]:
    """Return the values of a second parameter at which curves are compared with branches over speed."""
    thin = as_thin_as(OIL_B)
    return {AMPLITUDE: (0.5e-6, 3e-6), PRELOAD: (200.0, 2100.0), VISCOSITY: (thin, 5.0)}[second]


def along(
    second: str,
    condition: Condition,
    guess: Orbit,
    bounds: tuple[float, float] | None = None,
    at: tuple[float, ...] | None = None,
    stop: Mapping[str, int] | None = None,
) -> Branch:
    """Return the curve over a second parameter on which a condition determines the speed.

    It has points at the common values unless others are asked for.
    """
    values = common(second) if at is None else at
    ends, determined = bounds or RANGES[second], {"speed": condition}
    return traced(system(SCENE), second, ends, guess=guess, determined=determined, at=values, stop=stop)


def across(
    second: str, condition: Condition, guess: Orbit, speeds: tuple[float, ...], margin: float
) -> Branch:
    """Return the curve over speed, points at some (rev/min), with the second parameter by a condition."""
    ends = (min(speeds) - margin, max(speeds) + margin)
    return traced(system(SCENE), "speed", ends, guess=guess, determined={second: condition}, at=speeds)


def over(second: str, value: float, low: float, high: float, stop: Mapping[str, int] | None = None) -> Branch:
    """Return the branch over speed (rev/min), from the upper end down, at a value of the second parameter."""
    return traced(system(SCENE), "speed", (low, high), start=high, values={second: value}, stop=stop)


def fold(which: int, name: str = SCENE) -> Orbit:
    """Return the orbit at the upper (0) or lower (1) fold of the resonance."""
    return branch(name).labelled(Label.FOLD)[which].orbit


@cache
def folds(second: str) -> tuple[Branch, ...]:
    """Return the curves of the resonance's folds: the lower's, and the upper's where it is another curve."""
    lower = along(second, FoldCondition(), fold(1))
    return (lower,) if lower.labelled(Label.CUSP) else (lower, along(second, FoldCondition(), fold(0)))


@cache
def least_waviness(name: str) -> tuple[float, float]:
    """Return speed (rev/min) and amplitude (m) of the cusp that the lower fold of a disc comes to."""
    amplitude, determined = nominal(name)[AMPLITUDE], {"speed": FoldCondition()}
    ends, guess = (1e-6 * amplitude, amplitude), fold(1, name)
    found = traced(system(name), AMPLITUDE, ends, guess=guess, determined=determined, stop={"CP": 1})
    (cusp,) = found.labelled(Label.CUSP)
    return speed(name, cusp.orbit), cusp.parameter


HALF = {AMPLITUDE: (5e-6, (136.0, 142.0), (1e-6, 5.5e-6)), VISCOSITY: (0.03, (110.0, 160.0), (0.02, 1.0))}
"""A value of the second parameter at which the 2:1 resonance has folds, speeds (rev/min) about them, and the
range that their curve is traced over."""


@cache
def half(second: str) -> Branch:
    """Return the curve of the folds of the 2:1 resonance, at half the natural speed."""
    value, ends, bounds = HALF[second]
    begin = over(second, value, *ends).labelled(Label.FOLD)[-1].orbit
    return along(second, FoldCondition(), begin, bounds, at=())


@cache
def doublings(second: str) -> tuple[Branch, ...]:
    """Return the curves of the small motion's doublings: the faster's, and the slower's if it is another."""
    faster, slower = (point.orbit for point in small().labelled(Label.DOUBLING))
    chosen = (faster, slower) if second == PRELOAD else (faster,)
    return tuple(along(second, DoublingCondition(), orbit) for orbit in chosen)


DOUBLED = {AMPLITUDE: (0.4e-6, 4e-6), PRELOAD: (100.0, 10000.0), VISCOSITY: (0.02, 12.0)}
"""Ranges over which orbits of two periods are traced."""


@cache
def doubled_folds(second: str) -> Branch:
    """Return the curve of the fold at which orbits of two periods end, until they shrink to one period."""
    begin = doubled().labelled(Label.FOLD)[0].orbit
    return along(second, FoldCondition(), begin, DOUBLED[second], stop={"CP": 1})


FURTHER = 1.25
"""Speeds, in parts of the fold's, up to which motions of two periods are followed from their fold."""


@cache
def doubled_again(second: str, value: float) -> tuple[float, float]:
    """Return the speeds (rev/min) of the fold of motions of two periods and of their own first doubling.

    At a common value of the second parameter, on the sheet of the larger motion.
    """
    (begin,) = [p for p in doubled_folds(second).labelled(Label.USER) if p.parameter == value]
    at = speed(SCENE, begin.orbit)
    ends = (at / FURTHER, at * FURTHER)
    found = traced(system(SCENE), "speed", ends, guess=begin.orbit, stop={"PD": 1})
    (doubling,) = found.labelled(Label.DOUBLING)
    return at, speed(SCENE, doubling.orbit)


@cache
def peaks(second: str) -> Branch:
    """Return the orbits of the largest x peak to peak over speed."""
    top = max(branch(SCENE), key=lambda point: point.peak_to_peak("x"))
    at = (*common(second), nominal(SCENE)[second])
    return along(second, Peak(PeakToPeak("x")), top.orbit, at=at)


LEVEL = Level(PeakToPeak("x"), 10e-6)
"""x peak to peak of the curve of constant ripple: 10 um."""


@cache
def level() -> Branch:
    """Return the orbits over preload whose x is 10 um peak to peak, from the upper sheet's at 810 N on."""
    at, watched = (*common(PRELOAD), nominal(SCENE)[PRELOAD]), {"level": LEVEL}
    crossing = traced(system(SCENE), "speed", (300, 330), start=330, events=watched, stop={"level": 1})
    return along(PRELOAD, LEVEL, crossing[-1].orbit, at=at)
