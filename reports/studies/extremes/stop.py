"""Section of the report: a mass that comes to its stop, from soft to all but rigid, each way."""

from __future__ import annotations

import time
from functools import partial

import numpy as np

import periodic as per
import symbolic as sym
from reports.studies.extremes.confirm import EXACT, Checked, compared, joined
from reports.studies.extremes.piecewise import DAMPING, FORCE, GAP, orbit
from reports.studies.extremes.study import Study
from reports.studies.extremes.survey import Case, Outcome, Row
from reports.studies.extremes.words import error

STIFFNESSES = (1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6)
RANGE = (0.65, 0.8)
"""Of Omega; grazing is at .7106873691."""

STEPPED = 16
"""Values of Omega at which time stepping lets the motion settle, rising."""

PERIODS, TOLERANCE, SETTLED = 100, 1e-9, 1e-6
"""Of time stepping: periods at each value, tolerance, and what a settled state changes by in the last one."""

SHOT = 1e2
"""The stiffest stop whose grazing shooting is asked to pass."""


def system(stiffness: float) -> sym.CompiledSystem:
    """Return q'' + .1 q' + q + k max(q - 1, 0) = .5 cos(Omega t)."""
    q = sym.coordinate("q")
    model = sym.Mass(q, 1.0) + sym.Damper(q, DAMPING) + sym.Spring(q, 1.0) + sym.HarmonicForce(q, FORCE)
    return sym.compile(model + sym.OneSidedSpring(q, stiffness, GAP))


def traced(
    begin: float,
    method: per.extend.Discretisation,
    compiled: sym.CompiledSystem,
    control: per.ArclengthControl,
) -> per.Branch:
    """Return the branch from one end of the range."""
    return per.trace(compiled, "Omega", RANGE, start=begin, control=control, method=method)


def exact(stiffness: float, compiled: sym.CompiledSystem, branch: per.Branch) -> Checked:
    """Hold every point against the orbit in closed form; at grazing itself multipliers have two values."""
    grazings = {point.parameter for point in branch.labelled(per.Label.GRAZING)}
    return joined([_exact(stiffness, point) for point in branch if point.parameter not in grazings])


def _exact(stiffness: float, point: per.Point) -> Checked:
    omega, orbit_ = point.parameter, point.orbit
    phases = orbit_.grid.left
    tau = float(phases[np.abs(orbit_["q"](phases / omega) - GAP).argmax()])
    begin = np.array([orbit_["q"](tau / omega), orbit_["q'"](tau / omega)])
    found, monodromy = orbit(stiffness, omega, tau, begin)
    away = float(np.abs(found - begin).max()) / orbit_.span()
    return compared(point, away, np.linalg.eigvals(monodromy).astype(np.complex128), EXACT)


def stepped(case: Case) -> Row:
    """Integrate in time at rising values of Omega, and hold what has settled against the closed form."""
    compiled, clock, errors = case.system(), time.process_time(), []
    motion: sym.Simulation | None = None
    for omega in np.linspace(*RANGE, STEPPED):
        motion = sym.simulate(
            compiled, {"Omega": float(omega)}, start=motion, settle=PERIODS, samples=3, tolerance=TOLERANCE
        )
        begin, end = (np.array([motion["q"][k], motion["q'"][k]]) for k in (0, -1))
        if np.abs(end - begin).max() < SETTLED:
            errors.append(float(np.abs(orbit(case.value, float(omega), 0.0, end)[0] - end).max()))
    worst = max(errors, default=0.0)
    outcome = Outcome.TRACED if len(errors) == STEPPED else Outcome.STOPPED
    message = (
        f"settled at {len(errors)} of {STEPPED} values in {PERIODS} periods, error {error(worst)} at most"
    )
    seconds = time.process_time() - clock
    return Row(
        value=case.value,
        way=case.way,
        name=case.name,
        outcome=outcome.value,
        detail=message,
        error=worst,
        seconds=seconds,
    )


def cases() -> list[Case]:
    """Return branches both ways, one by shooting, and time stepping, over the stiffness."""
    ways = {
        "up": partial(traced, RANGE[0], per.Collocation()),
        "down": partial(traced, RANGE[1], per.Collocation()),
        "up, shooting": partial(traced, RANGE[0], per.Shooting()),
        "up, time stepping": partial(traced, RANGE[0], per.Collocation()),
    }
    return [
        Case(
            value=stiffness,
            way=way,
            system=partial(system, stiffness),
            trace=trace,
            confirm=partial(exact, stiffness),
            instead=stepped if "stepping" in way else None,
        )
        for way, trace in ways.items()
        for stiffness in STIFFNESSES
        if "shooting" not in way or stiffness <= SHOT
    ]


STUDY = Study(
    key="stop",
    title="Grazing of a stop",
    quantity="stiffness of the stop",
    unit="of the spring's",
    cases=cases,
    quick=(1e4,),
)
