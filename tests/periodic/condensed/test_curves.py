"""Curves in two parameters, branches that leave others, derivatives: condensed, and of all states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from support.cantilevers import cantilever, cubic

import periodic as per
import symbolic as sym
from symbolic.equations.assembly import Assembly


@dataclass(frozen=True)
class Parametric(sym.Part):
    """Stiffness at a place that is modulated with the excitation's phase."""

    q: sym.Coordinate

    def contribute(self, assembly: Assembly) -> None:
        """Add the force, and the frequency of the excitation."""
        motion = assembly.motion(self.q)
        motion.force += 2 * assembly.parameter(1.0, "depth") * assembly.cosine * motion.position.symbol
        assembly.excite(assembly.parameter(7.0, "Omega", "rad/s"))


def beam(parts: Callable[[Any], sym.Model], damping: float, condense: bool) -> sym.CompiledSystem:
    """A cantilever of one element."""
    given = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=1)
    structure = sym.Structure(given, damping=damping)
    return sym.compile(structure + parts(structure["tip"]), condense=condense)


def parametric(damping: float, condense: bool) -> sym.CompiledSystem:
    """One whose stiffness at the tip is modulated."""
    return beam(lambda tip: sym.CubicSpring(tip, 30.0) + Parametric(tip), damping, condense)


def shaken(condense: bool) -> sym.CompiledSystem:
    """One that a damper of negative coefficient shakes, entrained by a force."""
    drive = (sym.parameter("c", -0.2), 1.0, 0.1)
    return beam(
        lambda tip: (
            sym.Damper(tip, drive[0]) + sym.CubicDamper(tip, drive[1]) + sym.HarmonicForce(tip, drive[2], 3.5)
        ),
        0.01,
        condense,
    )


def value(system: sym.CompiledSystem, point: per.Point, name: str) -> float:
    """A parameter of a point."""
    return per.Value(name)(system, point.orbit)


def curve(
    system: sym.CompiledSystem,
    start: per.Point,
    along: tuple[str, float],
    determined: dict[str, per.extend.Condition],
) -> float:
    """What is determined where a parameter has grown by a part of itself."""
    name, factor = along
    begin = value(system, start, name)
    at = factor * begin
    of = per.trace(system, name, (begin, 1.1 * at), guess=start.orbit, determined=determined, at=at, tol=1e-8)
    return value(system, of.labelled(per.Label.USER)[0], next(iter(determined)))


def fold(condense: bool) -> list[float]:
    """A fold, and where it is at another frequency."""
    system = cantilever(1, cubic, condense=condense)
    of = per.trace(system, "Omega", (3.0, 8.0), tol=1e-8, watch=per.Watch(stop={"LP": 1}))
    found = of.labelled(per.Label.FOLD)[0]
    return [found.parameter, curve(system, found, ("Omega", 1.02), {"F": per.FoldCondition()})]


def level(condense: bool) -> list[float]:
    """The force that keeps the peak to peak."""
    system = cantilever(1, cubic, condense=condense)
    start = per.trace(system, "Omega", (3.0, 3.05), tol=1e-8).points[-1]
    size = per.Level(per.PeakToPeak("tip"), start.peak_to_peak("tip"))
    return [curve(system, start, ("Omega", 1.02), {"F": size})]


def peak(condense: bool) -> list[float]:
    """The frequency of the largest amplitude."""
    system = cantilever(1, cubic, condense=condense, damping=0.05)
    of = per.trace(system, "Omega", (4.0, 4.5), tol=1e-8)
    start = max(of.points, key=lambda point: point.maximum["tip"])
    return [curve(system, start, ("F", 1.05), {"Omega": per.Peak(per.Amplitude("tip"))})]


def doubling(condense: bool) -> list[float]:
    """A doubling, where it is at another modulation, and an orbit of twice the period."""
    system = parametric(0.05, condense)
    found = per.trace(system, "Omega", (7.8, 8.5), tol=1e-8).labelled(per.Label.DOUBLING)[0]
    guess, at = per.doubled(system, found.orbit, "Omega"), found.parameter + 0.2
    of = per.trace(system, "Omega", (found.parameter, at + 0.1), guess=guess, at=at, tol=1e-8)
    size = of.labelled(per.Label.USER)[0].peak_to_peak("tip")
    return [found.parameter, curve(system, found, ("depth", 1.1), {"Omega": per.DoublingCondition()}), size]


def branching(condense: bool) -> list[float]:
    """A branch point, and an orbit of the branch that begins there."""
    system = parametric(0.01, condense)
    given = {"values": {"depth": 1.5}, "tol": 1e-8}
    found = per.trace(system, "Omega", (3.4, 3.8), **given).labelled(per.Label.BRANCH)[0]
    guess = per.branched(system, found.orbit, "Omega")
    of = per.trace(system, "Omega", (3.6, 3.8), guess=guess, at=3.75, tol=1e-8)
    return [found.parameter, of.labelled(per.Label.USER)[0].peak_to_peak("tip")]


def torus(condense: bool) -> list[float]:
    """A torus bifurcation, and where it is under another force."""
    system = shaken(condense)
    found = per.trace(system, "Omega", (3.15, 3.0), tol=1e-8).labelled(per.Label.TORUS)[0]
    return [found.parameter, curve(system, found, ("F", 1.1), {"Omega": per.TorusCondition()})]


def grazing(condense: bool) -> list[float]:
    """A grazing point, and the force at which it is at another frequency."""

    def stop(tip: Any) -> list[sym.Part]:
        return [sym.Stop(tip, sym.HertzLaw(3.0, 1.0), 0.05)]

    system = cantilever(1, stop, condense=condense, force=0.02)
    of = per.trace(system, "Omega", (3.2, 3.4), tol=1e-8, watch=per.Watch(stop={"GR": 1}))
    found = of.labelled(per.Label.GRAZING)[0]
    condition = {"F": per.GrazingCondition(system.switches[0].name)}
    return [found.parameter, curve(system, found, ("Omega", 1.01), condition)]


@pytest.mark.parametrize("found", [fold, level, peak, doubling, branching, torus, grazing])
def test_curves_and_branches_are_those_of_all_states(found: Callable[[bool], list[float]]) -> None:
    """Assert special points, curves through them and branches from them to 8 digits."""
    assert found(True) == pytest.approx(found(False), rel=1e-8)


def test_derivatives_are_those_of_all_states() -> None:
    """Assert the derivatives of size and multipliers in every parameter, to 8 digits."""
    functionals = {
        "size": per.Maximum("tip"),
        "modulus": per.Multiplier(0),
        "angle": per.Multiplier(0, "angle"),
    }
    both = []
    for condense in (True, False):
        system = cantilever(1, cubic, condense=condense)
        of = per.trace(system, "Omega", (3.1, 3.25), at=3.2, tol=1e-9)
        orbit = of.labelled(per.Label.USER)[0].orbit
        both.append(per.sensitivities(system, orbit, functionals))
    for name in functionals:
        assert both[0][name] == pytest.approx(both[1][name], rel=1e-8)


def dampers(tip: Any) -> sym.Model:
    """One of negative coefficient, held by a cubic one."""
    return sym.Damper(tip, sym.parameter("c", -0.1)) + sym.CubicDamper(tip, 1.0)


def test_derivatives_of_a_self_excited_orbit() -> None:
    """Assert the derivative of the frequency, which a phase condition determines, to 7 digits."""
    both = []
    for condense in (True, False):
        system = beam(dampers, 0.01, condense)
        of = _self_excited(system, condense)
        determined = {"omega": per.PhaseCondition()}
        wanted = {"omega": per.Value("omega"), "size": per.Maximum("tip")}
        both.append(per.sensitivities(system, of.points[-1].orbit, wanted, determined=determined))
    for name in ("omega", "size"):
        assert both[0][name] == pytest.approx(both[1][name], rel=1e-7)


def _self_excited(system: sym.CompiledSystem, condense: bool) -> per.Branch:
    phases = np.linspace(0, 2 * np.pi, 65)
    motion = {"tip": 0.08 * np.cos(phases), "tip'": -0.28 * np.sin(phases)}
    if not condense:
        motion |= {"slope1": 1.37 * motion["tip"], "slope1'": 1.37 * motion["tip'"]}
    guess = per.sampled(
        times=phases / 3.5,
        state=motion,
        algebraic={"force on tip": np.zeros(65)} if condense else None,
        parameter={"omega": 3.5, "c": -0.1},
        system=system,
    )
    determined = {"omega": per.PhaseCondition()}
    return per.trace(system, "c", (-0.1, -0.11), guess=guess, determined=determined, tol=1e-9)
