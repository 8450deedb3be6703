"""Joints at several places of one beam, condensed, against event-exact motion of all its states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from reference.joints import Coulomb, Jointed, Slider
from reference.joints.judging import judged
from reference.joints.model import Joint

import periodic as per
import symbolic as sym

RATIO, FORCE = 0.02, 0.02
BEAM = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=2)
TIP, MIDDLE = BEAM.at["tip"], 0


def row(k: int) -> np.ndarray:
    """The row of a degree of freedom."""
    return np.eye(len(np.asarray(BEAM.M)))[k]


@dataclass(frozen=True, eq=False)
class Beam:
    """The beam, driven at its tip, with parts at its tip and its middle, and what they are for the judge."""

    parts: Callable[[sym.Coordinate, sym.Coordinate], list[sym.Part]]
    joints: list[Joint]

    def compiled(self) -> sym.CompiledSystem:
        """The system of the places alone."""
        structure = sym.Structure(BEAM, damping=RATIO, at={"middle": MIDDLE})
        parts = self.parts(structure["tip"], structure["middle"])
        return sym.compile(sym.combine([structure, *parts, sym.HarmonicForce(structure["tip"], FORCE, 2.2)]))

    @property
    def exact(self) -> Jointed:
        """M, C, K and the joints; damping is that of the modes."""
        mass, stiffness = np.asarray(BEAM.M), np.asarray(BEAM.K)
        squares, shapes = scipy.linalg.eigh(stiffness, mass)
        across = mass @ shapes
        damping = across @ np.diag(2 * RATIO * np.sqrt(squares)) @ across.T
        return Jointed(mass, damping, stiffness, FORCE * row(TIP), self.joints, scale=0.01)

    def check(self, low: float, high: float) -> per.Branch:
        """Assert that points of a branch are right to 1e-8, and that it reaches its end."""
        system, exact = self.compiled(), self.exact
        branch = per.trace(system, "Omega", (low, high), tol=1e-9)

        def states(orbit: per.Orbit, tau: np.ndarray) -> np.ndarray:
            sliders = [k for k, state in enumerate(system.states) if state.name.startswith("z")]
            places = orbit.state(tau)[:, sliders] * [system.states[k].scale for k in sliders]
            return np.hstack([*per.motion(system, orbit, None, tau), places])

        assert branch.stop.reason is per.Reason.BOUND
        for point in branch[:: max(1, len(branch) // 4)]:
            verdict = judged(exact, point, states)
            assert verdict.orbit < 1e-8 and verdict.multipliers < 1e-8 and verdict.stability
        return branch


def test_two_joints() -> None:
    """Assert a branch of two joints, one of which holds for a while."""
    beam = Beam(
        lambda tip, middle: [sym.CoulombFriction(tip, 0.002), sym.CoulombFriction(middle, 0.002)],
        [Coulomb(row(TIP), 0.002), Coulomb(row(MIDDLE), 0.002)],
    )
    branch = beam.check(2.2, 2.21)
    assert any(event.modes for event in branch[0].orbit.mesh.events)


def test_slider_and_joint() -> None:
    """Assert a branch of an elastic slider without creep, and of a joint that stops as well."""
    beam = Beam(
        lambda tip, middle: [sym.Jenkins(tip, 3.0, 0.003, creep=None), sym.CoulombFriction(middle, 0.004)],
        [Slider(row(TIP), 3.0, 0.003), Coulomb(row(MIDDLE), 0.004)],
    )
    assert len(beam.check(2.2, 2.205)[0].orbit.phases) == 8


def test_two_sliders() -> None:
    """Assert a branch of two elastic sliders without creep."""
    beam = Beam(
        lambda tip, middle: [
            sym.Jenkins(tip, 3.0, 0.003, creep=None),
            sym.Jenkins(middle, 3.0, 0.002, creep=None),
        ],
        [Slider(row(TIP), 3.0, 0.003), Slider(row(MIDDLE), 3.0, 0.002)],
    )
    assert len(beam.check(2.2, 2.205)[0].orbit.phases) == 8
