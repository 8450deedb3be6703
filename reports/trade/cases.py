"""The methods and settings that are measured on one orbit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import periodic as per
from reports.trade.direct import Adaptive, Even, Harmonics, shooting
from reports.trade.marching import Integrated, RungeKutta
from reports.trade.measure import Case, March
from reports.trade.words import power

RK4, CVODES, SHOOTING = "RK4 to steady state", "CVODES to steady state", "shooting"
ANCHORED, UNTIED, BALANCE = "Radau 5, anchored", "Radau 5, adaptive", "harmonic balance"

NTST = (6, 12, 24, 48, 96, 192, 384)
STEPS = (12, 25, 50, 100, 200)
HARMONICS = (1, 2, 3, 5, 7, 10, 15, 20, 30, 45, 60)
INTEGRATOR = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
SHOT = (1e-5, 1e-6, 1e-8, 1e-10, 1e-12)
TOLERANCES = tuple(10.0**-k for k in range(2, 11))
COLUMNS = tuple(range(2, 8))


def even(family: per.Family, columns: Sequence[int] = COLUMNS, ntst: Sequence[int] = NTST) -> Iterator[Case]:
    """Yield collocation on even meshes."""
    for ncol in columns:
        for count in ntst:
            yield Case(even_name(family, ncol), f"ntst {count}", Even(per.Scheme(family, ncol), count).solve)


def even_name(family: per.Family, ncol: int) -> str:
    """Return the name of a family of even meshes."""
    return f"{'Radau' if family is per.Family.RADAU else 'Gauss'} {ncol}, even"


def dial(
    *, anchored: bool, ncol: int = 5, tolerances: Sequence[float] = TOLERANCES, family: str = ""
) -> Iterator[Case]:
    """Yield Radau collocation on meshes that it chooses for a tolerance, with anchors or without."""
    scheme = per.Scheme(per.Family.RADAU, ncol)
    name = family or (ANCHORED if anchored else UNTIED)
    for tolerance in tolerances:
        way = Adaptive(per.Collocation(), scheme, tolerance, anchored)
        yield Case(name, f"tol {power(tolerance)}", way.solve)


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
    return [
        *marches(blocks),
        *shots(),
        *even(per.Family.RADAU),
        *even(per.Family.GAUSS),
        *dial(anchored=False),
        *dial(anchored=True),
        *harmonics(),
    ]
