"""What becomes of a machine: how far its branch is traced from either end, and whether its points are so."""

from __future__ import annotations

import resource
import time
import warnings
from collections.abc import Iterator

import numpy as np
from support.drawn.machines.drawn import FAMILIES, machine
from support.drawn.machines.machine import Machine

import periodic as per
import symbolic as sym
from reports.studies.extremes.survey import within
from survey.machines.judge import judged
from survey.rows import BACK, Row, _retraced, engine

TOL = 1e-6

SEEDS = 20
"""Machines of a family; each is traced from both ends."""

SECONDS = 300.0
"""CPU seconds that a branch may take."""

CONTROL = per.ArclengthControl(max_points=4000, max_newton=60000)

JUDGED = 10
"""Points of a branch that are judged, drawn at random."""

DOWN = " down"
"""Ends the kind of a row that is traced from the upper end."""

OTHERS = {" at 1e-3": 1e-3, " at 1e-9": 1e-9}
"""Ends of kinds that are traced at other tolerances, a tenth of the machines."""


def models(seeds: int = SEEDS) -> Iterator[tuple[str, int]]:
    """Yield kind and seed of all, the families in turn, so that a part of them is a sample.

    At last a tenth of the machines at the other tolerances.
    """
    for seed in range(seeds):
        yield from ((family + way, seed) for family in FAMILIES for way in ("", DOWN))
    for seed in range(seeds // 10):
        kinds = [family + way for family in FAMILIES for way in ("", DOWN)]
        yield from ((kind + at, seed) for kind in kinds for at in OTHERS)


def parts(kind: str) -> tuple[str, bool, float]:
    """Return the family of a kind, whether it is traced from the upper end, and at which tolerance."""
    at = next((end for end in OTHERS if kind.endswith(end)), "")
    way = kind.removesuffix(at)
    return way.removesuffix(DOWN), way.endswith(DOWN), OTHERS.get(at, TOL)


def row(kind: str, seed: int, count: int = JUDGED) -> Row:
    """Trace a machine and judge as many points. Any warning or exception is recorded as wrong."""
    begun, (family, down, tol) = time.process_time(), parts(kind)
    try:
        drawn = machine(family, seed)
        system = sym.compile(drawn.model)
        with warnings.catch_warnings(), within(SECONDS):
            warnings.simplefilter("error")
            branch = _as_far(drawn, system, down, tol)
    except KeyboardInterrupt:
        told = "time is up before there is a branch"
        return Row(kind, seed, "INTERRUPTED", told, seconds=SECONDS, engine=engine())
    except Exception as error:
        said = f"{type(error).__name__}: {error}"
        return Row(kind, seed, "RAISED", str(error), wrong=(said,), engine=engine())
    seconds = round(time.process_time() - begun, 2)
    sure, ratio, wrong, unjudged = _judged(drawn, system, branch, seed, count, tol)
    return Row(
        kind,
        seed,
        branch.stop.reason.name,
        f"{branch.stop} ({drawn.told})",
        len(branch),
        branch.newton_iterations,
        seconds,
        branch.shortfall,
        sure,
        ratio,
        wrong,
        tuple(map(str, branch.unaccounted)),
        unjudged,
        engine=engine(),
        memory=round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6, 3),
        retraced=BACK in str(branch.stop) and _retraced(branch, [o.name for o in system.outputs]),
    )


def _as_far(drawn: Machine, system: sym.CompiledSystem, down: bool, tol: float) -> per.Branch:
    """The branch from an end of the range, or what there is of it where its time is up."""
    start = drawn.bounds[int(down)]
    try:
        return per.trace(system, drawn.parameter, drawn.bounds, start=start, tol=tol, control=CONTROL)
    except per.Interrupted as interrupted:
        return interrupted.branch


def _judged(
    drawn: Machine, system: sym.CompiledSystem, branch: per.Branch, seed: int, count: int, tol: float
) -> tuple[int, float, tuple[str, ...], tuple[str, ...]]:
    """How many points are judged, the largest error over what is claimed, what is wrong, what is not."""
    if drawn.accelerations is None:
        return 0, 0.0, (), ()
    scales = np.array([state.scale for state in system.states])[::2]
    grazings = {point.parameter for point in branch.labelled(per.Label.GRAZING)}
    points = [point for point in branch if point.parameter not in grazings]
    sure, ratio, wrong, unjudged = 0, 0.0, list[str](), list[str]()
    for k in np.random.default_rng(seed).permutation(len(points))[:count]:
        point = points[int(k)]
        place = f"{drawn.parameter} {point.parameter!r} {point.label.value}".strip()
        try:
            verdict = judged(drawn, scales, point, tol)
        except ArithmeticError as error:
            unjudged.append(f"{place}: {error}")
            continue
        sure, ratio = sure + 1, max(ratio, verdict.orbit / max(tol, point.error.orbit))
        said = verdict.wrong(point, tol)
        if said:
            wrong.append(f"{place}: {said}")
    return sure, ratio, tuple(wrong), tuple(unjudged)
