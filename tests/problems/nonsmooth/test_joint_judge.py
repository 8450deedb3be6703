"""The judge of systems with joints, judged: closed forms, other integrators, differences of its own map."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from reference.contact import Contact, Friction
from reference.contact import Stop as ElasticStop
from reference.contact import periodic as of_contact
from reference.joints.judging import judged
from reference.joints.model import Coulomb, Cubic, Jointed, Slider, Stop
from reference.joints.period import Follower, peak_to_peak, periodic, settled
from reference.joints.series import ORDER, first_below
from scipy.integrate import solve_ivp
from support.drawn.jointcases import JointCase, compiled
from support.drawn.joints import Attached, beam, joint_model

import periodic as per

Array = NDArray[np.float64]
ONE, TWO = np.eye(1), np.eye(2)
DAMPING = np.array([[0.1, -0.05], [-0.05, 0.1]])
STIFFNESS = np.array([[2.0, -1.0], [-1.0, 2.0]])


def oscillator(*joints: Any, damping: float = 0.0, force: float = 1.0, cubic: float = 0.0) -> Jointed:
    """A unit mass on a unit spring."""
    springs = [Cubic(ONE[0], cubic)] if cubic else []
    return Jointed(ONE, damping * ONE, ONE, np.array([force]), joints, springs)


def mixed(*cubics: Cubic) -> Jointed:
    """Two masses with joints of each kind, two of them on one mass, one between both."""
    joints = [
        Coulomb(TWO[0], 0.2),
        Coulomb(TWO[0] - TWO[1], 0.15),
        Slider(TWO[1], 3.0, 0.1),
        Slider(TWO[0], 2.0, 0.2),
        Stop(TWO[1], 50.0, 0.4),
    ]
    return Jointed(TWO, DAMPING, STIFFNESS, np.array([1.0, 0.0]), joints, cubics)


@pytest.mark.parametrize(("Omega", "limit"), [(0.8, 0.2), (1.3, 0.3), (2.5, 0.1)])
def test_oscillator_of_den_hartog(Omega: float, limit: float) -> None:
    """Assert the amplitude of an undamped oscillator with friction that does not stick, in closed form.

    x0^2 = V^2 - (F/f)^2 H^2, V = 1/(1 - r^2), H = sin(pi/r)/(r (1 + cos(pi/r))) (Trans. ASME 53 (1931) 107).
    """
    follower = Follower(oscillator(Coulomb(ONE[0], limit)), Omega)
    found = periodic(follower, settled(follower, np.array([0.3, 0.0]), 300, close=1e-8))
    V, angle = 1 / (1 - Omega**2), np.pi / Omega
    H = np.sin(angle) / (Omega * (1 + np.cos(angle)))
    expected = 2 * np.sqrt(V**2 - (limit * H) ** 2)
    assert peak_to_peak(follower, found.start) == pytest.approx(expected, rel=1e-11)
    assert len(found.events) == 2


def test_joints_of_coulomb_beside_a_stop() -> None:
    """Assert orbit, events and multipliers against closed forms of another hand."""
    zero = np.zeros(2)
    joints = [Coulomb(TWO[0], 0.3), Coulomb(TWO[0] - TWO[1], 0.25), Stop(TWO[1], 50.0, 0.4)]
    system = Jointed(TWO, DAMPING, STIFFNESS, np.array([1.0, 0.0]), joints)
    matrix = np.block([[np.zeros((2, 2)), TWO], [-STIFFNESS, -DAMPING]])
    tail = np.zeros(3)
    elements = [
        *(
            Friction(np.concatenate([zero, j.row, tail]), np.concatenate([zero, -j.limit * j.row, tail]))
            for j in joints
            if isinstance(j, Coulomb)
        ),
        ElasticStop(np.array([0, 1, 0, 0, -0.4, 0, 0]), np.array([0, 0, 0, -50.0, 0, 0, 0])),
    ]
    contact = Contact(matrix, np.zeros(4), np.array([0.0, 0, 1, 0]), elements)
    for Omega in (0.8, 0.9, 1.6):
        follower = Follower(system, Omega)
        found = periodic(follower, settled(follower, np.zeros(4), 60, 1.0, close=1e-9), 1.0)
        other = of_contact(contact, Omega, found.start, 1.0)
        assert found.start == pytest.approx(other.start, abs=1e-11)
        assert found.monodromy == pytest.approx(other.monodromy, abs=1e-9)
        assert [e.phase for e in found.events] == pytest.approx([e[1] for e in other.events], abs=1e-9)


def slider_by_dop853(Omega: float, k: float, limit: float, start: Array) -> Array:
    """A period of the oscillator with an exact slider, from event to event."""
    t, y, side, span = 0.0, start, 0, 2 * np.pi / Omega
    while t < span:

        def rates(t: float, y: Array, side: int = side) -> list[float]:
            force = np.cos(Omega * t) - 0.1 * y[1] - y[0] - k * (y[0] - y[2])
            return [y[1], force, y[1] if side else 0.0]

        def changes(t: float, y: Array, side: int = side, begun: float = t) -> float:
            if t - begun < 1e-6:
                return 1.0
            return float(side * y[1]) if side else limit - abs(k * (y[0] - y[2]))

        changes.terminal, changes.direction = True, -1.0  # type: ignore[attr-defined]
        tight = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14, "max_step": 0.05}
        found = solve_ivp(rates, (t, span), y, events=changes, **tight)
        t, y = float(found.t[-1]), found.y[:, -1]
        side = 0 if side else int(np.sign(y[0] - y[2]))
    return np.asarray(y)


def test_slider_between_events() -> None:
    """Assert a period of an exact slider against DOP853 restarted at its events."""
    system = oscillator(Slider(ONE[0], 2.0, 0.3), damping=0.1)
    follower = Follower(system, 0.9)
    found = periodic(follower, settled(follower, np.zeros(3), 100, 0.0, close=1e-9))
    shifted = found.start.copy()
    shifted[:2] += 1e-3
    shifted = follower.period(shifted).start
    if found.begun == (0,):
        expected = slider_by_dop853(0.9, 2.0, 0.3, shifted)
        assert follower.period(shifted).end == pytest.approx(expected, abs=1e-10)
    assert len(found.events) == 4


def test_friction_is_a_rigid_slider() -> None:
    """Assert that sliders tend to Coulomb's friction in proportion to their flexibility."""
    limit = Follower(oscillator(Coulomb(ONE[0], 0.3), damping=0.1), 0.5)
    exact = periodic(limit, settled(limit, np.zeros(2), 100, close=1e-9))
    assert any(0 in mode for mode in exact.modes)
    off = []
    for k in (1e3, 1e4):
        follower = Follower(oscillator(Slider(ONE[0], k, 0.3), damping=0.1), 0.5)
        found = periodic(follower, settled(follower, np.zeros(3), 100, close=1e-9))
        difference = peak_to_peak(follower, found.start) - peak_to_peak(limit, exact.start)
        off.append(float(np.abs(difference).max()))
    assert off[0] < 2e-3
    assert off[0] / off[1] == pytest.approx(10, rel=0.1)


def test_cubic_spring_against_another_integrator() -> None:
    """Assert a period of Duffing's oscillator against DOP853; and a cubic spring of no stiffness is none."""
    follower = Follower(oscillator(damping=0.1, cubic=1.0), 1.2)
    found = periodic(follower, np.array([0.3, 0.1]))

    def rates(t: float, y: Array) -> list[float]:
        return [y[1], np.cos(1.2 * t) - 0.1 * y[1] - y[0] - y[0] ** 3]

    end = solve_ivp(rates, (0, 2 * np.pi / 1.2), found.start, method="DOP853", rtol=1e-13, atol=1e-14)
    assert found.start == pytest.approx(end.y[:, -1], abs=1e-11)
    assert np.prod(found.multipliers) == pytest.approx(np.exp(-0.2 * np.pi / 1.2), rel=1e-10)
    plain, curved = Follower(mixed(), 0.9), Follower(mixed(Cubic(TWO[0], 0.0)), 0.9)
    start = settled(plain, np.zeros(6), 5)
    one, other = plain.period(start), curved.period(start)
    assert one.end == pytest.approx(other.end, abs=1e-12)
    assert one.monodromy == pytest.approx(other.monodromy, abs=1e-10)
    assert [e.after for e in one.events] == [e.after for e in other.events]


def assert_monodromy(follower: Follower, phase: float) -> None:
    """Assert the monodromy matrix against differences of the map, to 1e-6."""
    size = follower.system.states
    found = periodic(follower, settled(follower, np.zeros(size), 20, phase), phase)
    differences = np.zeros((size, size))
    for j, direction in enumerate(np.eye(size)):
        step = 1e-7 * direction
        ends = [follower.period(found.start + side * step, phase, varied=False).end for side in (1, -1)]
        differences[:, j] = (ends[0] - ends[1]) / 2e-7
    assert found.monodromy == pytest.approx(differences, abs=1e-6)
    assert np.abs(found.end - found.start).max() < 1e-12


@pytest.mark.parametrize("cubics", [(), (Cubic(TWO[0] - TWO[1], 0.5),)], ids=["linear", "cubic"])
@pytest.mark.parametrize("phase", [0.0, 2.0])
def test_monodromy(cubics: tuple[Cubic, ...], phase: float) -> None:
    """Assert the monodromy matrix of joints of each kind, from two modes."""
    assert_monodromy(Follower(mixed(*cubics), 0.9), phase)


@pytest.mark.parametrize("Omega", [0.5, 0.6, 0.7])
def test_monodromy_where_several_joints_change_at_once(Omega: float) -> None:
    """Assert the monodromy matrix where one joint that comes to rest lets go another."""
    joints = [Coulomb(TWO[0], 0.3), Coulomb(TWO[0] - TWO[1], 0.25), Stop(TWO[1], 50.0, 0.4)]
    follower = Follower(Jointed(TWO, DAMPING, STIFFNESS, np.array([1.0, 0.0]), joints), Omega)
    assert_monodromy(follower, 1.0)
    found = periodic(follower, settled(follower, np.zeros(4), 20, 1.0), 1.0)
    assert any(np.count_nonzero(np.subtract(e.before, e.after)) == 2 for e in found.events)


def test_joints_on_one_mass_turn_together() -> None:
    """Assert that friction and a slider on one mass come to rest in one event."""
    follower = Follower(mixed(), 0.9)
    found = periodic(follower, settled(follower, np.zeros(6), 60))
    turns = [e for e in found.events if e.joint == 0]
    assert all(e.before[3] in (0, e.before[0]) and e.after[3] == 0 for e in turns)
    assert any(e.before[3] for e in turns)


def test_one_joint_that_sticks_frees_another() -> None:
    """Assert that where a joint comes to rest one that stuck may at once do so no longer.

    A mass rests on the ground; the other ceases to slide on it, and what it was braked by turns round.
    """
    joints = [Coulomb(TWO[0], 1.0), Coulomb(TWO[1] - TWO[0], 0.95)]
    system = Jointed(np.diag([1.0, 20.0]), 0 * TWO, TWO, np.zeros(2), joints)
    found = Follower(system, 0.5).period(np.array([-0.6, -0.85, 0.0, -0.1]))
    assert (found.begun, found.events[0].after) == ((0, -1), (1, 0))


def test_held_joint_leaves_a_multiplier_of_one() -> None:
    """Assert that a slider that never slips stays where it is put, and that Newton leaves it there."""
    follower = Follower(oscillator(Slider(ONE[0], 1.0, 50.0), damping=0.2), 0.9)
    found = periodic(follower, np.array([0.0, 0.0, 0.25]))
    assert found.never_slip(follower.system) == [0]
    assert found.multipliers[0] == pytest.approx(1, abs=1e-12)
    assert np.abs(found.end - found.start).max() < 1e-12
    other = periodic(follower, np.array([0.0, 0.0, -5.0]))
    assert abs(other.start[2] - found.start[2]) > 1
    sizes = [peak_to_peak(follower, orbit.start) for orbit in (found, other)]
    assert sizes[0] == pytest.approx(sizes[1], rel=1e-10)


@pytest.mark.parametrize("depth", [1e-6, 1e-10, 0.0, -1e-6])
def test_first_zero(depth: float) -> None:
    """Assert that a fall is found however short it is, and none where there is none."""
    polynomial = np.zeros(ORDER)
    polynomial[:3] = 0.3**2 - depth, -0.6, 1.0  # (x - 0.3)^2 - depth
    found = first_below(polynomial, 1e-14)
    if depth > 0:
        assert found == pytest.approx(0.3 - np.sqrt(depth), abs=1e-8)
    else:
        assert found is None


def test_points_of_a_beam_are_judged() -> None:
    """Assert orbits and multipliers of a condensed beam with friction at its tip."""
    body = beam(np.random.default_rng(1), 0)
    tip = len(body.places) - 1
    friction = Attached(kind="coulomb", i=tip, to=None, limits=(0.2,))
    model = replace(body, attached=(friction,), forced=tip, bounds=(2.8, 2.85))
    case = JointCase(compiled(model), model.record(), model.bounds, 2.8, model)
    branch = per.trace(
        case.system, "Omega", (2.8, 2.85), tol=1e-6, control=per.ArclengthControl(max_points=3)
    )
    for point in (branch[0], branch[-1]):
        verdict = judged(case.exact, point, case.states)
        assert verdict.wrong(point, 1e-6) == ""
        assert len(verdict.found.events) >= 2


def test_models_are_drawn() -> None:
    """Assert that a model has two to eight joints, one of friction, and that its numbers are sound."""
    kinds, counts = set(), set()
    for seed in range(100, 200):
        model = joint_model(seed)
        joints = [a for a in model.attached if a.kind != "cubic"]
        kinds |= {a.kind for a in model.attached}
        counts.add(len(joints))
        assert joints[0].kind != "stop"
        assert np.linalg.eigvalsh(model.stiffness)[0] > 0
        assert all(limit > 1e-6 for a in joints for limit in a.limits)
        assert model.bounds[0] < model.bounds[1]
        assert model.told == joint_model(seed).told
    assert kinds == {"coulomb", "jenkins", "iwan", "stop", "cubic"}
    assert counts == set(range(2, 9))
