"""A rigid stop with restitution at the tip of a cantilever, against motion followed in closed form.

Beams of finite elements bounce on such a stop as one mass does: ever faster and lower, without number in
finite time, until the tip rests on it. The judge is `reference.contact`, which shares nothing with the
engine: modes of contact by matrix exponentials, events located to rounding, orbits in extended precision.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pytest
import scipy
from reference.closer import closer
from reference.contact import Contact, Element, Friction, Wall, periodic
from reference.judging import quiet

import periodic as per
import symbolic as sym
from periodic import Label

FORCE, GAP = 0.01, 0.03
STIFF = {"rayleigh": (0.05, 0.01)}
LIGHT = {"damping": 0.02}


@dataclass(frozen=True)
class Beam:
    """The beam: elements, restitution, limit of a joint with dry friction at its first node, damping."""

    elements: int
    restitution: float
    limit: float = 0.0
    light: bool = False

    @property
    def matrices(self) -> sym.Matrices:
        """Without damping."""
        return sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=self.elements)

    @cached_property
    def structure(self) -> sym.Structure:
        """With damping."""
        return sym.Structure(self.matrices, **(LIGHT if self.light else STIFF))  # type: ignore[arg-type]

    @cached_property
    def system(self) -> sym.CompiledSystem:
        """With the stop."""
        structure = self.structure
        tip, inner = structure["tip"], structure["w1"]
        parts: list[sym.Part] = [structure, sym.HarmonicForce(tip, FORCE, 3.0)]
        parts.append(sym.RigidStop(tip, gap=GAP, restitution=self.restitution))
        if self.limit:
            parts.append(sym.CoulombFriction(inner, self.limit))
        return sym.compile(sym.combine(parts))

    def linear(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """M, C, K."""
        mass, stiffness = np.asarray(self.matrices.M), np.asarray(self.matrices.K)
        if not self.light:
            a, b = STIFF["rayleigh"]
            return mass, a * mass + b * stiffness, stiffness
        squares, shapes = scipy.linalg.eigh(stiffness, mass)
        across = mass @ shapes
        return mass, across @ np.diag(2 * LIGHT["damping"] * np.sqrt(squares)) @ across.T, stiffness

    def exact(self) -> Contact:
        """The same for the judge."""
        mass, damping, stiffness = self.linear()
        n, inverse = len(mass), np.linalg.inv(mass)
        matrix = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -inverse @ damping]])
        tip = self.matrices.at["tip"]
        still, unit = np.zeros(n), inverse[:, tip]
        row, column, reset = np.zeros(2 * n + 3), np.zeros(2 * n + 3), np.eye(2 * n + 3)
        row[tip], row[2 * n], column[n : 2 * n] = -1.0, GAP, -unit
        reset[n : 2 * n, n + tip] -= (1 + self.restitution) * unit / unit[tip]
        elements: list[Element] = [Wall(row, reset, column)]
        if self.limit:
            inner = self.matrices.at["w1"]
            speed, drag = np.zeros(2 * n + 3), np.zeros(2 * n + 3)
            speed[n + inner], drag[n : 2 * n] = 1.0, -self.limit * inverse[:, inner]
            elements.append(Friction(speed, drag))
        return Contact(matrix, np.zeros(2 * n), np.concatenate([still, FORCE * unit]), elements)

    def simulated(self, omega: float) -> per.Orbit:
        """A guess of the orbit to which the motion settles."""
        motion = sym.simulate(self.system, {"Omega": omega}, settle=30, tolerance=1e-8)
        given = motion.phase, motion.state, motion.algebraic, motion.parameter
        return per.sampled(*given, system=self.system)

    def traced(self, low: float, high: float, start: float, **given: Any) -> per.Branch:
        """A branch from the motion at `start`."""
        guess = self.simulated(start)
        return per.trace(self.system, "Omega", (low, high), start=start, guess=guess, **given)

    def check(self, point: per.Point, *, orbit: float, multipliers: float) -> int:
        """Assert that an orbit is right to a part of its peak to peak, its multipliers' polynomial as well.

        Return the number of events in the judge's period.
        """
        exact, structure = self.exact(), self.structure
        names = [structure.freedom(k).name for k in range(structure.size)]
        tau, begin = quiet(exact, point.orbit, point.parameter, names)
        found = closer(exact, point.parameter, periodic(exact, point.parameter, begin, tau), tau)
        off = float(np.abs(found.start - begin).max()) / float(np.ptp(point.orbit.nodes, axis=0).max())
        apart = np.abs(np.poly(found.monodromy) - np.poly(point.multipliers)).max()
        assert off < orbit
        assert apart < multipliers
        return len(found.events)


def test_orbits_that_chatter_and_rest() -> None:
    """Assert orbits to 1e-11 and multipliers to 1e-10 where the tip bounces without number and rests."""
    beam = Beam(2, 0.6)
    branch = beam.traced(3.42, 3.5, 3.45, tol=1e-9)
    assert branch.stop.reason is per.Reason.BOUND
    for point in branch[::3]:
        assert beam.check(point, orbit=1e-11, multipliers=1e-10) > 18
        assert point.error.orbit < 1e-9


def test_four_elements() -> None:
    """Assert the same of a stiffer beam: of its 16 multipliers two turn about 0 with a modulus of 0.4276."""
    beam = Beam(4, 0.6)
    branch = beam.traced(3.44, 3.46, 3.45, tol=1e-8, control=per.ArclengthControl(max_points=1))
    assert abs(branch[0].multipliers[0]) == pytest.approx(0.4276350, abs=1e-7)
    for point in branch:
        beam.check(point, orbit=1e-10, multipliers=1e-9)


def test_few_impacts() -> None:
    """Assert orbits to 1e-10 and multipliers to 1e-9 on both sides of where a third impact begins.

    Beyond it they fall as its distance grows: they are known as well as to 1e-13 of that.
    """
    beam = Beam(2, 0.9, light=True)
    branch = beam.traced(3.497, 3.5, 3.4975, tol=1e-8, watch=per.Watch(peaks={}))
    (grazing,) = branch.labelled(Label.GRAZING)
    assert grazing.parameter == pytest.approx(3.4982075, abs=1e-7)
    assert {len(point.orbit.phases) for point in branch} == {2, 3}
    for point in branch:
        if distance := abs(point.parameter - grazing.parameter):
            known = 1e-13 * abs(point.multipliers[0]) / distance
            beam.check(point, orbit=1e-10, multipliers=max(1e-9, known))


def test_beside_a_joint() -> None:
    """Assert the same of a beam whose first node sticks and slips on the ground."""
    beam = Beam(2, 0.9, limit=0.002, light=True)
    branch = beam.traced(3.3995, 3.401, 3.4, tol=1e-8)
    assert branch.stop.reason is per.Reason.BOUND
    for point in branch[::2]:
        assert beam.check(point, orbit=1e-10, multipliers=1e-8) == len(point.orbit.phases)


@pytest.mark.parametrize("bounds", [(3.3, 3.352), (3.68, 3.75)])
def test_grazing(bounds: tuple[float, float]) -> None:
    """Assert that a branch from either end grazes the stop where the linear response is the gap."""
    beam, low = Beam(2, 0.6), bounds[0] < 3.5
    start, first = bounds[0] if low else bounds[1], per.Watch(stop={"GR": 1})
    branch = per.trace(beam.system, "Omega", bounds, start=start, watch=first)
    mass, damping, stiffness = beam.linear()
    tip = beam.matrices.at["tip"]

    def past(omega: float) -> float:
        dynamic = stiffness + 1j * omega * damping - omega**2 * mass
        return float(abs(FORCE * np.linalg.inv(dynamic)[tip, tip]) - GAP)

    grazing = scipy.optimize.brentq(past, *((3.3, 3.5) if low else (3.6, 3.8)), xtol=1e-14)
    assert branch.labelled(Label.GRAZING)[0].parameter == pytest.approx(grazing, rel=1e-9)


@pytest.mark.long
def test_through_chatter() -> None:
    """Assert that a branch from rest goes on through ever more impacts to orbits that rest."""
    beam = Beam(2, 0.6)
    branch = per.trace(beam.system, "Omega", (3.3, 3.45))
    assert branch.stop.reason is per.Reason.BOUND
    grazings = [point.parameter for point in branch.labelled(Label.GRAZING)]
    gaps = np.diff(grazings)[3:]
    assert gaps[1:] / gaps[:-1] == pytest.approx(0.6, abs=0.05)
    last = branch[-1]
    assert (0, 2) in {pair for event in last.orbit.mesh.events for pair in event.modes}
    beam.check(last, orbit=1e-9, multipliers=1e-9)


@pytest.mark.long
def test_through_resonance() -> None:
    """Assert that a branch goes from beyond the resonance to below it, and its upper fold.

    On the way the bounces of a second sequence, of which ever more follow each other, end in a rest. Orbits
    that rest are right to 1e-8, their multipliers to 1e-6: the tolerance is the standard one, 1e-7.
    """
    beam = Beam(2, 0.6)
    branch = per.trace(beam.system, "Omega", (3.0, 4.5), start=4.5)
    assert branch.stop.reason is per.Reason.BOUND
    assert branch[-1].parameter == 3.0
    folds = [point.parameter for point in branch.labelled(Label.FOLD)]
    assert folds[-1] == pytest.approx(3.76798047, abs=1e-7)
    resting = [p for p in branch if any(event.modes for event in p.orbit.mesh.events)]
    stable = [p for p in resting if p.stable and not p.label]
    assert len(stable) > 10
    for point in stable[::5]:
        beam.check(point, orbit=1e-8, multipliers=1e-6)


def test_large_structures_are_refused() -> None:
    """Assert the sentences about structures that cannot have all their states."""
    big = sym.Structure(sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=30), damping=0.02)
    tip = big["tip"]
    with pytest.raises(ValueError, match="has 60 degrees of freedom; beside a RigidStop.*craig_bampton"):
        sym.compile(big + sym.RigidStop(tip, GAP, 0.6) + sym.HarmonicForce(tip, FORCE, 3.0))
    mass, _, stiffness = Beam(2, 0.6).linear()
    spun = sym.Structure(lambda speed: mass, None, stiffness, at={"tip": 2})
    tip = spun["tip"]
    with pytest.raises(ValueError, match="functions of the speed; beside a RigidStop"):
        sym.compile(spun + sym.RigidStop(tip, GAP, 0.6) + sym.HarmonicForce(tip, FORCE, 3.0))
