"""The methods and settings that are measured on one orbit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import periodic as per
from reports.studies.trade.methods.direct import NO_EVENTS, Adaptive, Even, Harmonics, shooting
from reports.studies.trade.methods.direct import tolerance as tolerance_of
from reports.studies.trade.methods.marching import Integrated, RungeKutta
from reports.studies.trade.methods.measure import Case, March
from reports.studies.trade.methods.names import (
    BALANCE,
    CVODES,
    DIAL,
    GAUSS_5,
    RADAU_5,
    RK4,
    SCHEMES,
    SHOOTING,
    Mesh,
    named,
    power,
)

NTST = (6, 12, 24, 48, 96, 192, 384)
STEPS = (12, 25, 50, 100, 200)
HARMONICS = (1, 2, 3, 5, 7, 10, 15, 20, 30, 45, 60)
INTEGRATOR = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
SHOT = (1e-5, 1e-6, 1e-8, 1e-10, 1e-12)
TOLERANCES = tuple(10.0**-k for k in range(2, 11))
COARSE = TOLERANCES[::2]


def even(schemes: Sequence[per.Scheme] = SCHEMES, ntst: Sequence[int] = NTST) -> Iterator[Case]:
    """Yield collocation on even meshes."""
    for scheme in schemes:
        for count in ntst:
            yield Case(named(scheme, Mesh.EVEN), f"ntst {count}", Even(scheme, count).solve)


def chosen(
    mesh: Mesh, schemes: Sequence[per.Scheme] = (RADAU_5,), tolerances: Sequence[float] = TOLERANCES
) -> Iterator[Case]:
    """Yield collocation on meshes that it chooses for a tolerance, with anchors or without."""
    for scheme in schemes:
        for tolerance in tolerances:
            kinks = None if mesh is Mesh.ANCHORED else NO_EVENTS
            way = Adaptive(per.Collocation(scheme=scheme, kinks=kinks), tolerance_of(tolerance))
            yield Case(named(scheme, mesh), f"tol {power(tolerance)}", way.solve)


def dial() -> Iterator[Case]:
    """Yield draft, standard and fine."""
    for accuracy in per.Accuracy:
        way = Adaptive(per.Collocation(), per.Tolerance.of(accuracy))
        yield Case(DIAL, accuracy.name.lower(), way.solve)


def harmonics(counts: Sequence[int] = HARMONICS) -> Iterator[Case]:
    """Yield harmonic balance."""
    for count in counts:
        yield Case(BALANCE, f"H {count}", Harmonics(count).solve)


def shots(tolerances: Sequence[float] = SHOT) -> Iterator[Case]:
    """Yield single shooting by CVODES."""
    for tolerance in tolerances:
        yield Case(SHOOTING, f"tol {power(tolerance)}", shooting(tolerance).solve)


def marches(
    blocks: int, steps: Sequence[int] = STEPS, tolerances: Sequence[float] = INTEGRATOR
) -> Iterator[March]:
    """Yield both time integrations, run for so many blocks of periods."""
    for count in steps:
        yield March(RK4, f"{count} steps a period", RungeKutta(count), blocks)
    for tolerance in tolerances:
        yield March(CVODES, f"tol {power(tolerance)}", Integrated(tolerance), blocks)


def everything(blocks: int) -> list[Case | March]:
    """Return all that a small system is measured with."""
    others = [scheme for scheme in SCHEMES if scheme != RADAU_5]
    return [
        *marches(blocks),
        *shots(),
        *harmonics(),
        *dial(),
        *even(),
        *(
            case
            for mesh in (Mesh.ADAPTIVE, Mesh.ANCHORED)
            for case in (*chosen(mesh), *chosen(mesh, others, COARSE))
        ),
    ]


def affordable() -> list[Case | March]:
    """Return what can be paid for with 100 states."""
    return [
        *marches(30, steps=(12, 25, 50), tolerances=(1e-4, 1e-6, 1e-8, 1e-10)),
        *shots((1e-6, 1e-8, 1e-10)),
        *harmonics((1, 3, 5, 7, 9, 12)),
        *dial(),
        *even(ntst=(6, 12, 24)),
        *chosen(Mesh.ADAPTIVE, (RADAU_5, GAUSS_5), (1e-3, 1e-5, 1e-7)),
    ]
