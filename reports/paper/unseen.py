"""What the paper could not see: whole branches, loss of contact, damping along them, doubled orbits."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

import periodic
from periodic import Label, Point
from reports.pages.section import Section, Tell
from reports.paper import unseen_figures, unseen_text
from reports.paper.contact import LOST, lost_from, preload_of
from reports.paper.doubled import KNOCKED, SCENE, doubled, knocked, small, speeds
from reports.paper.equivalent import exponents, ratio
from reports.paper.scenes import LUBRICATED, branch, system
from reports.paper.stiffness import WAVES
from reports.view import MICRO, RPM
from symbolic.linear import modes

AT = (360.0, 288.0, 260.0, 245.0)
"""Speeds of the labelled orbits, rev/min, beside the upper fold."""


@cache
def labelled() -> dict[str, Point]:
    """Return six orbits along the branch of oil A at 810 N, by letter."""
    found = branch(SCENE, at=AT)

    def at(speed: float) -> list[Point]:
        return [p for p in found.labelled(Label.USER) if abs(p.parameter / RPM - speed) < 1e-9]

    upper, middle, lower = at(245.0)
    fold = found.labelled(Label.FOLD)[0]
    return dict(zip("ABCDEF", (*at(360.0), *at(288.0), *at(260.0), fold, middle, lower), strict=True))


def along(point: Point, count: int = 2001) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return phases over one excitation period and the outputs there (SI), shape (count, outputs)."""
    tau = np.linspace(0, 2 * np.pi, count)
    return tau, periodic.outputs(system(SCENE), point.orbit, tau)


def return_phase(point: Point) -> float:
    """Return the phase (rad) in which the load rises from LOST of the preload to the preload itself.

    Of the rise that follows the least load; the orbit must lose contact. To 3e-4 rad.
    """
    tau, values = along(point, 20001)
    load = values[:-1, [output.name for output in system(SCENE).outputs].index("load")]
    load = np.roll(load, -int(np.argmin(load))) / preload_of(SCENE)
    risen = int(np.argmax(load >= 1))
    left = int(np.flatnonzero(load[:risen] < LOST)[-1])
    return float((risen - left) * tau[1])


def damping(name: str) -> list[tuple[float, float]]:
    """Return x peak to peak (m) of the orbits from 500 rev/min down, and the damping ratio of each.

    It is that of small free motion about the orbit, mu = exp(lambda T), zeta = -Re(lambda)/|lambda|, with the
    imaginary part continued from the linear one. It ends where the multipliers become real or unstable.
    """
    rest = modes(system(name), {"speed": 500 * RPM})
    found = exponents(branch(name), rest, lambda point: 2 * np.pi / (WAVES * point.parameter))
    return [(point.peak_to_peak("x"), ratio(value)) for point, value in found]


def numbers() -> dict[str, float]:
    """Return the section's key numbers."""
    found: dict[str, float] = {}
    for name in LUBRICATED:
        for k, fold in enumerate(branch(name).labelled(Label.FOLD), 1):
            found[f"{name} fold {k} rpm"] = fold.parameter / RPM
            found[f"{name} fold {k} x um"] = fold.peak_to_peak("x") / MICRO
        found[f"{name} contact lost below rpm"] = lost_from(name)
        for k, speed in enumerate(speeds(small(name), Label.DOUBLING), 1):
            found[f"{name} doubling {k} rpm"] = speed
    (fold_speed,) = speeds(doubled(), Label.FOLD)
    x = knocked().state[:, 0] * system(SCENE).states[0].scale
    return found | {
        "load back within rad": max(return_phase(labelled()[letter]) for letter in "CDE"),
        "doubled orbits fold rpm": fold_speed,
        f"doubled orbit at {KNOCKED:g} rpm x um": doubled()[0].peak_to_peak("x") / MICRO,
        f"simulated motion at {KNOCKED:g} rpm x um": float(np.ptp(x)) / MICRO,
        f"small orbit at {KNOCKED:g} rpm x um": branch(SCENE)[0].peak_to_peak("x") / MICRO,
    }


def section(tell: Tell) -> Section:
    """Return the section."""
    tell("traces of the four discs")
    for name in LUBRICATED:
        branch(name)
    tell("orbits of two periods")
    found = numbers()
    tell("orbits along the branch")
    orbits = {letter: (point, *along(point)) for letter, point in labelled().items()}
    names = [output.name for output in system(SCENE).outputs]
    figures = {
        "unseen-branches": unseen_figures.branches({name: branch(name) for name in LUBRICATED}),
        "unseen-orbits": unseen_figures.orbits(branch(SCENE, at=AT), orbits, names),
        "unseen-damping": unseen_figures.damping({name: damping(name) for name in LUBRICATED}),
        "unseen-doubled": unseen_figures.doubled(small(), doubled(), branch(SCENE)),
        "unseen-doubled-motion": unseen_figures.motion(_doubled_motion(), names),
    }
    return Section(
        title="What the paper could not see",
        text=unseen_text.text(found, {k: v[0] for k, v in orbits.items()}, damping(SCENE)),
        numbers=found,
        figures=figures,
    )


def _doubled_motion() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    tau = np.linspace(0, 4 * np.pi, 2001)
    return tau, periodic.outputs(system(SCENE), doubled()[0].orbit, tau)
