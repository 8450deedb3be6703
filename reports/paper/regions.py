"""Where the disc has more than one motion: regions over speed and waviness, preload or viscosity."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.polynomial import Polynomial

import periodic
from periodic import Branch, DoublingCondition, Label, Level, PeakToPeak
from reports.pages.section import Section, Tell
from reports.paper import regions_figures, regions_text
from reports.paper.doubled import small, speeds
from reports.paper.regions_curves import (
    AMPLITUDE,
    HALF,
    HEAVY,
    LEVEL,
    OTHER_OIL,
    PRELOAD,
    SCENE,
    VISCOSITY,
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
from reports.paper.resonance import natural_speed
from reports.paper.rows import Row, Verdict
from reports.paper.scenes import LUBRICATED, branch, system
from reports.paper.stiffness import nominal
from reports.view import MICRO, RPM
from symbolic.linear import modes

SECONDS = (AMPLITUDE, PRELOAD, VISCOSITY)
UNITS = {AMPLITUDE: (MICRO, "um"), PRELOAD: (1.0, "N"), VISCOSITY: (1.0, "Pas")}
"""What one unit of each second parameter is in SI, and how names of numbers call it."""

ASIDE = (0.95, 1.05)
"""Parts of a cusp's or tip's value at which the folds or doublings of a branch over speed are counted."""

NEARLY_NONE = 0.05
"""Change of x up to which the effect of the oil counts as slight."""

NEAR = 0.3
"""Distance of the points (rev/min) that the tip of a curve of doublings is interpolated between."""

SOFTENING = 1 / 24
"""omega = omega0 (1 - (A/delta0)^2/24): free motion of amplitude A in a Hertz contact of exponent 3/2."""


def averaged(name: str) -> tuple[float, float]:
    """Return speed (rev/min) and waviness amplitude (m) of a disc's cusp, by averaging to first order.

    With the damping ratio z at rest and omega = omega0 (1 - k A^2), A in static deflections, the response
    (a/delta0)^2 = 4 A^2 ((s + k A^2)^2 + z^2), s = omega/omega0 - 1, has its cusp at

        s = -sqrt(3) z,   k A^2 = 2 z/sqrt(3),   a/delta0 = 4 A z/sqrt(3).
    """
    disc, values = system(name), nominal(name)
    natural = natural_speed(disc)
    (z,) = modes(disc, {"speed": natural * RPM}).damping_ratios
    deflection = (values[PRELOAD] / values["stiffness"]) ** (1 / values["exponent"])
    size = math.sqrt(2 * z / (math.sqrt(3) * SOFTENING))
    return natural * (1 - math.sqrt(3) * z), float(4 / math.sqrt(3) * z * size * deflection)


def crossings(curves: tuple[Branch, ...], value: float) -> list[float]:
    """Return the speeds (rev/min) at which curves pass a value of the second parameter, slowest first."""
    found = {
        round(_speed(point), 9)
        for curve in curves
        for point in curve.labelled(Label.USER)
        if point.parameter == value
    }
    return sorted(found)


@cache
def tip(second: str) -> tuple[float, float]:
    """Return speed (rev/min) and value where the curve of doublings turns in its second parameter.

    A quartic of the speed runs through points traced about the turning point.
    """
    (curve,) = doublings(second)
    (turn,) = np.flatnonzero(np.diff(np.sign(np.diff(curve.values)))) + 1
    middle = float(curve.column("speed")[turn])
    at = [middle + k * NEAR * RPM for k in (-2, -1, 0, 1, 2)]
    across = periodic.trace(
        system(SCENE),
        "speed",
        (at[0] - NEAR * RPM, at[-1] + NEAR * RPM),
        at=at,
        guess=curve[int(turn)].orbit,
        determined={second: DoublingCondition()},
    )
    points = {p.parameter: p.orbit for p in across.labelled(Label.USER)}
    values = [periodic.Value(second)(system(SCENE), orbit) for orbit in points.values()]
    quartic = Polynomial.fit((np.array(list(points)) - middle) / RPM, values, 4)
    turns = np.asarray(quartic.deriv().roots())
    best = float(turns[np.abs(turns).argmin()].real)
    return middle / RPM + best, float(quartic(best))


def references(second: str, value: float) -> tuple[list[float], list[float]]:
    """Return the speeds (rev/min) of folds and doublings of branches over speed, slowest first.

    They are those of another disc where it has this value, else of a branch of their own at it.
    """
    others = {(PRELOAD, common()[PRELOAD][1]): HEAVY, (VISCOSITY, common()[VISCOSITY][0]): OTHER_OIL}
    name = others.get((second, value))
    if name is not None:
        turns = branch(name).labelled(Label.FOLD)[:2]
        return sorted(p.parameter / RPM for p in turns), speeds(small(name), Label.DOUBLING)
    upper, lower = crossings(folds(second), value)
    faster = crossings(doublings(second), value)
    low, high = 0.97 * upper, 1.03 * faster[-1]
    found = over(second, value, low, high, {"LP": 2})
    return speeds(found, Label.FOLD), speeds(found, Label.DOUBLING)


def meeting() -> dict[str, float]:
    """Return how far curves and branches over speed differ in the speeds where they meet, relative."""
    found = {}
    for second in SECONDS:
        unit, name = UNITS[second]
        for value in common()[second]:
            ours = crossings(folds(second), value), crossings(doublings(second), value)
            found[f"{second} {value / unit:.4g} {name}"] = max(
                float(np.abs(np.array(a) / np.array(b) - 1).max())
                for a, b in zip(ours, references(second, value), strict=True)
            )
    return found


def counts() -> dict[str, float]:
    """Return how many folds or doublings branches over speed have below and above each cusp and tip."""
    found: dict[str, float] = {}

    def count(name: str, label: Label, second: str, value: float, low: float, high: float) -> None:
        for factor in ASIDE:
            across = over(second, factor * value, low, high)
            found[f"{name} at {factor:g} of it"] = len(across.labelled(label))

    speed, value = least_waviness(SCENE)
    count("folds about the cusp over amplitude", Label.FOLD, AMPLITUDE, value, 270.0, 290.0)
    for second in HALF:
        (cusp,) = half(second).labelled(Label.CUSP)
        count(f"folds about the 2:1 cusp over {second}", Label.FOLD, second, cusp.parameter, 135.0, 145.0)
    for second in (AMPLITUDE, VISCOSITY):
        speed, value = tip(second)
        ends = (speed - 15, speed + 15)
        count(f"doublings about the tip over {second}", Label.DOUBLING, second, value, *ends)
    return found


def cusps() -> dict[str, float]:
    """Return the least waviness with folds of each disc, traced and averaged."""
    found: dict[str, float] = {}
    for name in LUBRICATED:
        speed, amplitude = least_waviness(name)
        near = averaged(name)
        found |= {
            f"{name} cusp rpm": speed / RPM,
            f"{name} cusp um": amplitude / MICRO,
            f"{name} averaged cusp rpm": near[0],
            f"{name} averaged cusp um": near[1] / MICRO,
        }
    return found


def borders(second: str) -> dict[str, float]:
    """Return where curves pass the common values, where they end, and their cusps and tips."""
    found: dict[str, float] = {}
    unit, name = UNITS[second]
    for value in (*common()[second], *(() if second == AMPLITUDE else folds(second)[0].values[[0, -1]])):
        where = f"at {value / unit:.4g} {name}"
        pair = crossings(folds(second), value) or sorted(_end(curve, value) for curve in folds(second))
        found |= {f"fold {k} {where} rpm": speed for k, speed in enumerate(pair, 1)}
    for value in common()[second]:
        for k, speed in enumerate(crossings(doublings(second), value), 1):
            found[f"doubling {k} at {value / unit:.4g} {name} rpm"] = speed
    if second in HALF:
        (cusp,) = half(second).labelled(Label.CUSP)
        found[f"2:1 cusp {name}"] = cusp.parameter / unit
        found[f"2:1 cusp over {second} rpm"] = _speed(cusp)
        found[f"tip over {second} rpm"], value = tip(second)
        found[f"tip {name}"] = value / unit
    return found


def _speed(point: periodic.Point) -> float:
    """The speed of a point of a curve, rev/min."""
    return periodic.Value("speed")(system(SCENE), point.orbit) / RPM


def _end(curve: Branch, value: float) -> float:
    (point,) = [p for p in (curve[0], curve[-1]) if p.parameter == value]
    return _speed(point)


def outputs() -> dict[str, float]:
    """Return the highest points over preload and viscosity, and where x is 10 um peak to peak."""
    found: dict[str, float] = {}
    for second in (PRELOAD, VISCOSITY):
        (unit, name), curve = UNITS[second], peaks(second)
        for point in (curve[0], curve[-1], *curve.labelled(Label.USER)):
            where = f"peak at {point.parameter / unit:.4g} {name}"
            found |= {f"{where} rpm": _speed(point), f"{where} um": point.peak_to_peak("x") / MICRO}
    found["level from N"] = float(level().values.min())
    for k, point in enumerate(sorted(level().labelled(Label.FOLD), key=lambda p: p.parameter), 1):
        found |= {f"level on fold {k} N": point.parameter, f"level on fold {k} rpm": _speed(point)}
    for value in (*common()[PRELOAD], 810.0):
        for k, speed in enumerate(crossings((level(),), value), 1):
            found[f"level {k} at {value:g} N rpm"] = speed
    return found


def level_difference() -> float:
    """Return how far the level's fast side at 2100 N is from where the branch over speed has it, relative."""
    ours = crossings((level(),), common()[PRELOAD][1])[-1]
    found = periodic.trace(
        system(HEAVY),
        "speed",
        (0.95 * ours * RPM, 1.1 * ours * RPM),
        start=1.1 * ours * RPM,
        events={"level": Level(PeakToPeak("x"), LEVEL)},
    )
    (there,) = [point for point in found if point.event == "level"]
    return abs(ours * RPM / there.parameter - 1)


@cache
def shrunk() -> tuple[float, float, float]:
    """Return where orbits of two periods shrink to one at their fold, and the doublings' value there.

    Speed (rev/min), amplitude of the fold's curve and of the doublings' (m), the latter at the same speed.
    """
    (cusp,) = doubled_folds(AMPLITUDE).labelled(Label.CUSP)
    speed = _speed(cusp)
    (begin,) = [p for p in doublings(AMPLITUDE)[0].labelled(Label.USER) if p.parameter == 0.5e-6][:1]
    across = periodic.trace(
        system(SCENE),
        "speed",
        (0.98 * speed * RPM, 1.02 * speed * RPM),
        at=[speed * RPM],
        guess=begin.orbit,
        determined={AMPLITUDE: DoublingCondition()},
    )
    (there,) = across.labelled(Label.USER)
    return speed, cusp.parameter, periodic.Value(AMPLITUDE)(system(SCENE), there.orbit)


def doubled_numbers() -> dict[str, float]:
    """Return the range in which motions of two periods are stable with more waviness and less preload."""
    found: dict[str, float] = {}
    for second, value in ((AMPLITUDE, common()[AMPLITUDE][1]), (PRELOAD, common()[PRELOAD][0])):
        unit, name = UNITS[second]
        begin, end = doubled_again(second, value)
        where = f"{value / unit:.4g} {name}"
        found |= {
            f"two periods from at {where} rpm": begin / RPM,
            f"two periods double at {where} rpm": end / RPM,
        }
    return found


def numbers() -> dict[str, float]:
    """Return the section's key numbers."""
    speed, fold, doubling = shrunk()
    found = cusps() | outputs() | counts() | doubled_numbers()
    for second in SECONDS:
        found |= borders(second)
    return found | {
        "two periods shrink at rpm": speed,
        "two periods shrink at um": fold / MICRO,
        "doublings there um": doubling / MICRO,
        "two periods from at 10000 N rpm": _end(doubled_folds(PRELOAD), 10000.0),
        "level difference": level_difference(),
        "resonance rises with preload": float(_rises(peaks(PRELOAD))),
        "x at 360 rpm um": _at_paper_speed(SCENE),
        "x at 360 rpm, other oil um": _at_paper_speed(OTHER_OIL),
    }


def section(tell: Tell) -> Section:
    """Return the section."""
    for what, made in (("folds", folds), ("doublings", doublings), ("folds of two periods", doubled_folds)):
        for second in SECONDS:
            tell(f"{what} over {second}")
            made(second)
    tell("peaks and the level of 10 um")
    found = numbers()
    tell("branches over speed for comparison")
    meets = meeting()
    return Section(
        title="Where there are two motions: regions over waviness, preload and viscosity",
        text=regions_text.text(found, meets),
        numbers=found | {f"difference {where}": value for where, value in meets.items()},
        rows=_rows(found),
        figures={f"regions-{second}": regions_figures.drawn(second) for second in SECONDS},
    )


def _rows(n: dict[str, float]) -> tuple[Row, ...]:
    thin, thick = "peak at 0.02975 Pas", "peak at 0.89 Pas"
    slow, fast = n["peak at 20 N rpm"], n["peak at 1e+04 N rpm"]
    change = n["x at 360 rpm, other oil um"] / n["x at 360 rpm um"] - 1
    return (
        Row(
            key="P17",
            what="resonance with rising preload (conclusion 1)",
            paper="rises",
            ours=f"highest point rises from {slow:.1f} rev/min at 20 N to {fast:.1f} at 10 000 N",
            check="curve of peaks; at 810 N and 2100 N the highest points of the branches over speed",
            given=Verdict.REPRODUCED if n["resonance rises with preload"] else Verdict.NOT_REPRODUCED,
        ),
        Row(
            key="P18",
            what="effect of the oil's viscosity on x at 360 rev/min (section 6)",
            paper="slight",
            ours=(
                f"{100 * change:.1f} % between the oils; but at resonance x is {n[f'{thin} um']:.1f} µm "
                f"with the thin film and {n[f'{thick} um']:.1f} µm with the thick one"
            ),
            check="branches over speed of both oils; curve of peaks over viscosity",
            given=Verdict.REPRODUCED if abs(change) < NEARLY_NONE else Verdict.NOT_REPRODUCED,
        ),
    )


def _at_paper_speed(name: str) -> float:
    """x peak to peak in um at 360 rev/min."""
    (point,) = branch(name, 365.0, 355.0, at=(360.0,)).labelled(Label.USER)
    return point.peak_to_peak("x") / MICRO


def _rises(curve: Branch) -> bool:
    """Whether the speed rises with the second parameter all along a curve."""
    order = np.argsort(curve.values, kind="stable")
    return bool((np.diff(curve.column("speed")[order]) >= 0).all())
