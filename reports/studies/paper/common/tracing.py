"""The study's traced branches: the one place that calls the engine, and the branches over speed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache

import periodic as per
from reports.studies.paper.common.discs import LOST, MICRO
from reports.studies.paper.common.scenes import nominal, system
from symbolic import CompiledSystem
from symbolic.arrays import Array
from symbolic.scenes.axes import RPM

Condition = per.DoublingCondition | per.FoldCondition | per.Level | per.Peak

UNITS = {"speed": RPM}
"""SI values of the units in which bounds and values of a parameter are given here, if not SI."""


def traced(
    disc: CompiledSystem,
    parameter: str,
    ends: tuple[float, float],
    *,
    start: float | None = None,
    at: Sequence[float] = (),
    guess: per.Orbit | None = None,
    values: Mapping[str, float] | None = None,
    determined: Mapping[str, Condition] | None = None,
    events: Mapping[str, per.Level] | None = None,
    stop: Mapping[str, int] | None = None,
    step: per.ArclengthControl | None = None,
    accuracy: per.Accuracy = per.Accuracy.STANDARD,
) -> per.Branch:
    """Return `per.trace` over a parameter; ends, start and at in rev/min where it is the speed."""
    unit = UNITS.get(parameter, 1.0)
    low, high = sorted(ends)
    return per.trace(
        disc,
        parameter,
        (low * unit, high * unit),
        start=None if start is None else start * unit,
        at=[value * unit for value in at],
        guess=guess,
        values=values,
        determined=determined,
        tol=accuracy,
        control=step,
        watch=per.Watch(events=events or {}, stop=stop or {}),
    )


@cache
def branch(
    name: str,
    begin: float = 500.0,
    end: float = 100.0,
    at: tuple[float, ...] = (),
    overrides: tuple[tuple[str, str], ...] = (),
) -> per.Branch:
    """Return the branch of a built-in scene between two speeds in rev/min, with points `at` some.

    Its points lie close enough for splines through them.
    """
    dense = per.ArclengthControl(ds_max=0.1)
    return traced(system(name, *overrides), "speed", (begin, end), start=begin, at=at, step=dense)


def at_speed(found: per.Branch, rpm: float) -> list[per.Point]:
    """Return the points of a branch asked for at a speed, in the order in which it passes them."""
    return [p for p in found.labelled(per.Label.USER) if abs(p.parameter / RPM - rpm) < 1e-6]


def shown(name: str, rpm: float) -> per.Point:
    """Return the point at a speed of the part of a disc's branch next to 360 rev/min."""
    (point,) = at_speed(branch(name, 365.0, 355.0, at=(rpm,)), rpm)
    return point


def speed(name: str, orbit: per.Orbit) -> float:
    """Return the speed of an orbit of a disc in rev/min."""
    return per.Value("speed")(system(name), orbit) / RPM


def xy(found: per.Branch) -> tuple[Array, Array]:
    """Return speeds in rev/min and x peak to peak in um along a branch."""
    return found.values / RPM, found.peak_to_peak("x") / MICRO


@cache
def lost_from(name: str) -> float:
    """Return the speed (rev/min) below which the upper sheet loses contact in every cycle.

    Raises ArithmeticError for a branch that keeps contact.
    """
    lost = {"contact lost": per.Level(per.Minimum("load"), LOST * nominal(name)["preload"])}
    found = traced(system(name), "speed", (100, 500), start=500, events=lost, stop={"contact lost": 1})
    if not found.labelled("contact lost"):
        raise ArithmeticError(f"scene {name} does not lose contact from 500 rev/min on")
    return found.labelled("contact lost")[0].parameter / RPM
