"""Joints at several places of one beam, beside one-sided springs, condensed, against event-exact motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
import scipy
from reference.joints import Coulomb, Jointed, Slider, Stop
from reference.joints.judging import judged
from reference.joints.model import Joint

import periodic as per
import symbolic as sym
from periodic.system import HELD

RATIO, FORCE = 0.02, 0.02
Places = dict[str, sym.Coordinate]


def beam(elements: int) -> sym.Matrices:
    """A cantilever."""
    return sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=elements)


TIP, MIDDLE = beam(2).at["tip"], 0


def row(k: int, elements: int = 2) -> np.ndarray:
    """The row of a degree of freedom."""
    return np.eye(2 * elements)[k]


@dataclass(frozen=True, eq=False)
class Beam:
    """A beam, driven at its tip, with parts at its nodes, and what they are for the judge."""

    parts: Callable[[Places], list[sym.Part]]
    joints: list[Joint]
    elements: int = 2

    def compiled(self) -> sym.CompiledSystem:
        """The system of the places alone; the nodes but the tip are called 1, 2, ... from the clamp on."""
        given = beam(self.elements)
        nodes = {str(k + 1): 2 * k for k in range(self.elements - 1)}
        structure = sym.Structure(given, damping=RATIO, at=nodes)
        places = {name: structure[name] for name in ("tip", *nodes)}
        return sym.compile(
            sym.combine([structure, *self.parts(places), sym.HarmonicForce(places["tip"], FORCE, 2.2)])
        )

    @property
    def exact(self) -> Jointed:
        """M, C, K and the joints; damping is that of the modes."""
        given = beam(self.elements)
        mass, stiffness = np.asarray(given.M), np.asarray(given.K)
        squares, shapes = scipy.linalg.eigh(stiffness, mass)
        across = mass @ shapes
        damping = across @ np.diag(2 * RATIO * np.sqrt(squares)) @ across.T
        force = FORCE * row(given.at["tip"], self.elements)
        return Jointed(mass, damping, stiffness, force, self.joints, scale=0.01)

    def check(self, low: float, high: float, most: int | None = None) -> per.Branch:
        """Assert that points of a branch are right to 1e-8, and that it reaches its end, or `most` points."""
        system, exact = self.compiled(), self.exact
        control = None if most is None else per.ArclengthControl(max_points=most)
        branch = per.trace(system, "Omega", (low, high), tol=1e-9, control=control)

        def states(orbit: per.Orbit, tau: np.ndarray) -> np.ndarray:
            sliders = [k for k, state in enumerate(system.states) if state.name.startswith("z")]
            places = orbit.state(tau)[:, sliders] * [system.states[k].scale for k in sliders]
            return np.hstack([*per.motion(system, orbit, None, tau), places])

        assert branch.stop.reason is (per.Reason.BOUND if most is None else per.Reason.MAX_POINTS)
        for point in branch[:: max(1, len(branch) // 4)]:
            verdict = judged(exact, point, states)
            assert verdict.orbit < 1e-8 and verdict.multipliers < 1e-8 and verdict.stability
        return branch


@pytest.mark.long
def test_two_joints() -> None:
    """Assert a branch of two joints, one of which holds for a while."""
    joined = Beam(
        lambda at: [sym.CoulombFriction(at["tip"], 0.002), sym.CoulombFriction(at["1"], 0.002)],
        [Coulomb(row(TIP), 0.002), Coulomb(row(MIDDLE), 0.002)],
    )
    branch = joined.check(2.2, 2.21)
    assert any(event.modes for event in branch[0].orbit.mesh.events)


@pytest.mark.long
def test_slider_and_joint() -> None:
    """Assert a branch of an elastic slider without creep, and of a joint that stops as well."""
    joined = Beam(
        lambda at: [sym.Jenkins(at["tip"], 3.0, 0.003, creep=None), sym.CoulombFriction(at["1"], 0.004)],
        [Slider(row(TIP), 3.0, 0.003), Coulomb(row(MIDDLE), 0.004)],
    )
    assert len(joined.check(2.2, 2.205)[0].orbit.phases) == 8


@pytest.mark.long
def test_two_sliders() -> None:
    """Assert a branch of two elastic sliders without creep."""
    joined = Beam(
        lambda at: [
            sym.Jenkins(at["tip"], 3.0, 0.003, creep=None),
            sym.Jenkins(at["1"], 3.0, 0.002, creep=None),
        ],
        [Slider(row(TIP), 3.0, 0.003), Slider(row(MIDDLE), 3.0, 0.002)],
    )
    assert len(joined.check(2.2, 2.205)[0].orbit.phases) == 8


def test_three_joints() -> None:
    """Assert a branch of three joints at the nodes of a finer beam: two stick, once and three times."""
    limits = {"tip": 0.002, "1": 0.002, "2": 0.002}
    joints = [Coulomb(row(k, 3), 0.002) for k in (4, 0, 2)]
    joined = Beam(lambda at: [sym.CoulombFriction(at[k], limit) for k, limit in limits.items()], joints, 3)
    first = joined.check(2.2, 2.21, 1)[0].orbit
    assert sum(bool(event.modes) for event in first.mesh.events) == 8


@pytest.mark.parametrize(("place", "stops"), [("tip", 1), ("1", 2)])
def test_joint_beside_a_stop(place: str, stops: int) -> None:
    """Assert a branch of a joint at the tip and a one-sided spring beyond a gap, there or at the middle."""
    gap = {"tip": 0.005, "1": 0.0015}[place]
    joined = Beam(
        lambda at: [sym.CoulombFriction(at["tip"], 0.002), sym.OneSidedSpring(at[place], 20.0, gap)],
        [Coulomb(row(TIP), 0.002), Stop(row({"tip": TIP, "1": MIDDLE}[place]), 20.0, gap)],
    )
    first = joined.check(2.2, 2.21, 2)[0].orbit
    assert sum(bool(event.modes) for event in first.mesh.events) == stops


def test_held() -> None:
    """Assert that a joint which never slips is held in settling, and on the branch, where it came to rest."""
    joined = Beam(
        lambda at: [sym.CoulombFriction(at["tip"], 0.002), sym.CoulombFriction(at["1"], 0.5)],
        [Coulomb(row(TIP), 0.002), Coulomb(row(MIDDLE), 0.5)],
    )
    branch = joined.check(2.2, 2.21, 2)
    for point in branch:
        assert [mode for _, mode in point.orbit.mesh.modes] == [HELD]
        assert point.peak_to_peak("1") < 1e-10
