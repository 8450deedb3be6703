"""Where the disc has more than one motion: regions over speed and waviness, preload or viscosity."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

from periodic import Branch, DoublingCondition, Label, Value
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.paper import regions_figures
from reports.studies.paper.branches.doubled import small, speeds
from reports.studies.paper.branches.regions_curves import (
    AMPLITUDE,
    HALF,
    LEVEL,
    PRELOAD,
    SCENE,
    SECONDS,
    UNITS,
    VISCOSITY,
    across,
    as_thin_as,
    common,
    doubled_again,
    doubled_folds,
    doublings,
    folds,
    half,
    least_waviness,
    level,
    over,
    peaks,
)
from reports.studies.paper.branches.resonance import natural_speed
from reports.studies.paper.common.discs import HEAVY, LUBRICATED, MICRO, OIL_B, RPM_SHOWN, TITLES
from reports.studies.paper.common.scenes import nominal, static_deflection, system
from reports.studies.paper.common.tracing import branch, shown, speed, traced
from symbolic.motion.linear import modes
from symbolic.scenes.axes import RPM

ASIDE = (0.95, 1.05)
"""Parts of a cusp's or tip's value at which the folds or doublings of a branch over speed are counted."""

TIP_DISTANCE = 0.3
"""Distance of the points (rev/min) that the tip of a curve of doublings is interpolated between."""

SOFTENING = 1 / 24
"""omega = omega0 (1 - (A/delta0)^2/24): free motion of amplitude A in a Hertz contact of exponent 3/2."""


def averaged(name: str) -> tuple[float, float]:
    """Return speed (rev/min) and waviness amplitude (m) of a disc's cusp, by averaging to first order.

    With the damping ratio z at rest and omega = omega0 (1 - k A^2), A in static deflections, the response
    (a/delta0)^2 = 4 A^2 ((s + k A^2)^2 + z^2), s = omega/omega0 - 1, has its cusp at

        s = -sqrt(3) z,   k A^2 = 2 z/sqrt(3),   a/delta0 = 4 A z/sqrt(3).
    """
    natural = natural_speed(system(name))
    (z,) = modes(system(name), {"speed": natural * RPM}).damping_ratios
    size = math.sqrt(2 * z / (math.sqrt(3) * SOFTENING)) * static_deflection(nominal(name))
    return natural * (1 - math.sqrt(3) * z), float(4 / math.sqrt(3) * z * size)


def crossings(curves: tuple[Branch, ...], value: float) -> list[float]:
    """Return the speeds (rev/min) at which curves pass a value of the second parameter, slowest first."""
    met = [p for curve in curves for p in curve.labelled(Label.USER) if p.parameter == value]
    return sorted({round(speed(SCENE, point.orbit), 9) for point in met})


def cusp(curve: Branch) -> tuple[float, float]:
    """Return speed (rev/min) and second parameter of a curve's only cusp."""
    (point,) = curve.labelled(Label.CUSP)
    return speed(SCENE, point.orbit), point.parameter


@cache
def tip(second: str) -> tuple[float, float]:
    """Return speed (rev/min) and value where the curve of doublings turns in its second parameter.

    A quartic of the speed runs through points traced about the turning point.
    """
    (curve,) = doublings(second)
    (turn,) = np.flatnonzero(np.diff(np.sign(np.diff(curve.values)))) + 1
    middle = float(curve.column("speed")[turn]) / RPM
    at = tuple(middle + k * TIP_DISTANCE for k in (-2, -1, 0, 1, 2))
    found = across(second, DoublingCondition(), curve[int(turn)].orbit, at, TIP_DISTANCE)
    orbits = {p.parameter / RPM - middle: p.orbit for p in found.labelled(Label.USER)}
    values = [Value(second)(system(SCENE), orbit) for orbit in orbits.values()]
    quartic = Polynomial.fit(np.array(list(orbits)), values, 4)
    turns = np.asarray(quartic.deriv().roots())
    best = float(turns[np.abs(turns).argmin()].real)
    return middle + best, float(quartic(best))


def references(second: str, value: float) -> tuple[list[float], list[float]]:
    """Return the speeds (rev/min) of folds and doublings of branches over speed, slowest first.

    They are those of another disc where it has this value, else of a branch of their own at it.
    """
    others = {(PRELOAD, 2100.0): HEAVY, (VISCOSITY, as_thin_as(OIL_B)): OIL_B}
    if name := others.get((second, value)):
        turns = branch(name).labelled(Label.FOLD)[:2]
        return sorted(p.parameter / RPM for p in turns), speeds(small(name), Label.DOUBLING)
    low, high = crossings(folds(second), value)[0], crossings(doublings(second), value)[-1]
    found = over(second, value, 0.97 * low, 1.03 * high, {"LP": 2})
    return speeds(found, Label.FOLD), speeds(found, Label.DOUBLING)


def meeting() -> dict[str, float]:
    """Return how far curves and branches over speed differ in the speeds where they meet, relative."""
    found = {}
    for second in SECONDS:
        unit, name = UNITS[second]
        for value in common(second):
            ours = crossings(folds(second), value), crossings(doublings(second), value)
            found[f"difference {second} {value / unit:.4g} {name}"] = max(
                float(np.abs(np.array(a) / np.array(b) - 1).max())
                for a, b in zip(ours, references(second, value), strict=True)
            )
    return found


def counts() -> dict[str, float]:
    """Return how many folds or doublings branches over speed have below and above each cusp and tip."""
    _, least = least_waviness(SCENE)
    cases = [("folds about the cusp", AMPLITUDE, Label.FOLD, least, (270.0, 290.0))]
    for second in HALF:
        value = cusp(half(second))[1]
        cases.append(("folds about the 2:1 cusp", second, Label.FOLD, value, (135.0, 145.0)))
    for second in (AMPLITUDE, VISCOSITY):
        at, value = tip(second)
        cases.append(("doublings about the tip", second, Label.DOUBLING, value, (at - 15, at + 15)))
    return {
        f"{what} over {second} at {part:g} of it": len(over(second, part * value, *ends).labelled(label))
        for what, second, label, value, ends in cases
        for part in ASIDE
    }


def cusps() -> dict[str, float]:
    """Return the least waviness with folds of each disc, traced and averaged."""
    found: dict[str, float] = {}
    for name in LUBRICATED:
        for word, (rpm, amplitude) in (("cusp", least_waviness(name)), ("averaged cusp", averaged(name))):
            found |= {f"{name} {word} rpm": rpm, f"{name} {word} um": amplitude / MICRO}
    return found


def borders(second: str) -> dict[str, float]:
    """Return where curves pass the common values, where they end, and their cusps and tips."""
    found: dict[str, float] = {}
    unit, name = UNITS[second]
    for value in (*common(second), *(() if second == AMPLITUDE else folds(second)[0].values[[0, -1]])):
        where = f"at {value / unit:.4g} {name}"
        pair = crossings(folds(second), value) or sorted(_end(curve, value) for curve in folds(second))
        found |= {f"fold {k} {where} rpm": rpm for k, rpm in enumerate(pair, 1)}
    for value in common(second):
        for k, rpm in enumerate(crossings(doublings(second), value), 1):
            found[f"doubling {k} at {value / unit:.4g} {name} rpm"] = rpm
    if second in HALF:
        found[f"2:1 cusp over {second} rpm"], value = cusp(half(second))
        found[f"tip over {second} rpm"], top = tip(second)
        found |= {f"2:1 cusp {name}": value / unit, f"tip {name}": top / unit}
    return found


def _end(curve: Branch, value: float) -> float:
    """The speed at the end of a curve that lies at a value of the second parameter, rev/min."""
    (point,) = [p for p in (curve[0], curve[-1]) if p.parameter == value]
    return speed(SCENE, point.orbit)


def outputs() -> dict[str, float]:
    """Return the highest points over preload and viscosity, and where x is 10 um peak to peak."""
    found: dict[str, float] = {}
    for second in (PRELOAD, VISCOSITY):
        (unit, name), curve = UNITS[second], peaks(second)
        for point in (curve[0], curve[-1], *curve.labelled(Label.USER)):
            where, rpm = f"peak at {point.parameter / unit:.4g} {name}", speed(SCENE, point.orbit)
            found |= {f"{where} rpm": rpm, f"{where} um": point.peak_to_peak("x") / MICRO}
    found["level from N"] = float(level().values.min())
    turns = sorted((p.parameter, speed(SCENE, p.orbit)) for p in level().labelled(Label.FOLD))
    for k, (force, rpm) in enumerate(turns, 1):
        found |= {f"level on fold {k} N": force, f"level on fold {k} rpm": rpm}
    for value in (*common(PRELOAD), 810.0):
        for k, rpm in enumerate(crossings((level(),), value), 1):
            found[f"level {k} at {value:g} N rpm"] = rpm
    return found


def level_difference() -> float:
    """Return how far the level's fast side at 2100 N is from where the branch over speed has it, relative."""
    ours = crossings((level(),), 2100.0)[-1]
    ends = (0.95 * ours, 1.1 * ours)
    found = traced(system(HEAVY), "speed", ends, start=ends[1], events={"level": LEVEL})
    (there,) = [point for point in found if point.event == "level"]
    return abs(ours * RPM / there.parameter - 1)


def shrunk() -> dict[str, float]:
    """Return where orbits of two periods shrink to one at their fold, and the doublings' value there."""
    rpm, amplitude = cusp(doubled_folds(AMPLITUDE))
    begin = next(p for p in doublings(AMPLITUDE)[0].labelled(Label.USER) if p.parameter == 0.5e-6)
    found = across(AMPLITUDE, DoublingCondition(), begin.orbit, (rpm,), 0.02 * rpm)
    (there,) = found.labelled(Label.USER)
    return {
        "two periods shrink at rpm": rpm,
        "two periods shrink at um": amplitude / MICRO,
        "doublings there um": Value(AMPLITUDE)(system(SCENE), there.orbit) / MICRO,
    }


def doubled_numbers() -> dict[str, float]:
    """Return the range in which motions of two periods are stable with more waviness and less preload."""
    found: dict[str, float] = {}
    for second, value in ((AMPLITUDE, common(AMPLITUDE)[1]), (PRELOAD, common(PRELOAD)[0])):
        where = f"{value / UNITS[second][0]:.4g} {UNITS[second][1]}"
        begin, end = doubled_again(second, value)
        found |= {f"two periods from at {where} rpm": begin, f"two periods double at {where} rpm": end}
    return found


def numbers() -> dict[str, float]:
    """Return the section's key numbers, without the differences of `meeting`."""
    found = cusps() | outputs() | counts() | doubled_numbers() | shrunk()
    for second in SECONDS:
        found |= borders(second)
    return found | {
        "two periods from at 10000 N rpm": _end(doubled_folds(PRELOAD), 10000.0),
        "level difference": level_difference(),
        "oil A as thin as oil B Pas": as_thin_as(OIL_B),
        "resonance rises with preload": float(_rises(peaks(PRELOAD))),
        "x at 360 rpm um": shown(SCENE, RPM_SHOWN).peak_to_peak("x") / MICRO,
        "x at 360 rpm, other oil um": shown(OIL_B, RPM_SHOWN).peak_to_peak("x") / MICRO,
    }


def _rises(curve: Branch) -> bool:
    """Whether the speed rises with the second parameter all along a curve."""
    order = np.argsort(curve.values, kind="stable")
    return bool((np.diff(curve.column("speed")[order]) >= 0).all())


def compute(tell: Tell) -> Found:
    """Trace all curves and the branches that they are compared with."""
    for what, made in (("folds", folds), ("doublings", doublings), ("folds of two periods", doubled_folds)):
        for second in SECONDS:
            tell(f"{what} over {second}")
            made(second)
    tell("peaks and the level of 10 um")
    found = numbers()
    tell("branches over speed for comparison")
    figures = {f"regions-{second}": regions_figures.drawn(second) for second in SECONDS}
    return Found(numbers=found | meeting(), figures=figures)


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the discs' titles, and the checks by what they are about."""
    differs, below = "difference ", " at 0.95 of it"
    units = {"um": "µm", "Pas": "Pa s"}
    places = {key: key.removeprefix(differs).split() for key in kept.numbers if key.startswith(differs)}
    return {
        "titles": TITLES,
        "counted": [key.removesuffix(below) for key in kept.numbers if key.endswith(below)],
        "differences": {
            f"{second} {value} {units.get(unit, unit)}": kept.numbers[key]
            for key, (second, value, unit) in places.items()
        },
    }


SECTION = Section(
    title="Where there are two motions: regions over waviness, preload and viscosity",
    compute=compute,
    context=context,
)
