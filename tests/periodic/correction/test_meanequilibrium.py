"""First orbits about a rest under loads: rotors in journal bearings, whose films bear none at the centre."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.condensed.condensedcollocation import mesh_method
from periodic.correction import meanequilibrium
from periodic.correction.meanequilibrium import _Balance, _balanced, resting
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import uniform
from periodic.orbit.scheme import Scheme
from periodic.system import LinearPart, System

CLEARANCE = 5e-5
FILM = {"viscosity": 0.02, "radius": 0.025, "length": 0.025, "clearance": CLEARANCE}
FEW = per.ArclengthControl(max_points=2)
WEIGHT = 206.0


def rotor(condense: bool, unbalance: float = 2e-5) -> sym.CompiledSystem:
    """Half a rotor: a disc of 16 kg on a shaft of 2e6 N/m whose journal of 5 kg runs in a film."""
    mass, stiffness = np.diag([16.0, 16.0, 5.0, 5.0]), 2e6 * np.kron([[1, -1], [-1, 1]], np.eye(2))
    places = {"disc": (0, 1), "journal": (2, 3)}
    structure = sym.Structure(mass, np.diag([40.0, 40.0, 0, 0]), stiffness, at=places, scale=CLEARANCE)
    (x, y), (u, v) = structure["disc"], structure["journal"]
    loads = sym.Unbalance(x, y, 16.0, unbalance) + sym.ConstantForce(v, -WEIGHT)
    return sym.compile(structure + sym.JournalBearing(u, v, **FILM) + loads, condense=condense)


@pytest.mark.parametrize("condense", [True, False])
def test_journal_rests_where_its_film_bears_the_weight(condense: bool) -> None:
    """Assert Ocvirk's load and attitude angle of the short bearing at the rest found, to 8 digits.

    W = mu R L^3 Omega/(4 c^2) e/(1-e^2)^2 sqrt(16 e^2 + pi^2 (1-e^2)), tan phi = pi sqrt(1-e^2)/(4 e).
    """
    system, Omega = rotor(condense), 100.0
    parameter = np.array([Omega if p.name == "speed" else p.value for p in system.parameters])
    found = mesh_method(system).resting(system, at_rest(system, uniform(Scheme(), 4), parameter))
    assert found is not None
    names = [state.name for state in system.states]
    u, v = (found.nodes[0, names.index(f"journal {k}")] for k in (1, 2))
    e = np.hypot(u, v)
    size = 0.02 * 0.025**4 * Omega / (4 * CLEARANCE**2)
    assert size * e / (1 - e**2) ** 2 * np.sqrt(16 * e**2 + np.pi**2 * (1 - e**2)) == pytest.approx(
        WEIGHT, rel=1e-8
    )
    assert u / -v == pytest.approx(np.pi * np.sqrt(1 - e**2) / (4 * e), rel=1e-8)


def test_what_rests_already_is_left() -> None:
    """Assert that a system whose parts rest under its loads has no other rest."""
    system = sym.compile(
        sym.Mass(x := sym.coordinate("x"), 1.0) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 1.0)
    )
    assert mesh_method(system).resting(system, at_rest(system, uniform(Scheme(), 4), system.nominal)) is None


def test_load_that_cannot_be_borne() -> None:
    """Assert that there is no rest where nothing holds a load."""
    system = sym.compile(
        sym.Mass(x := sym.coordinate("x"), 1.0) + sym.Damper(x, 1.0) + sym.ConstantForce(x, 1.0)
    )
    assert mesh_method(system).resting(system, at_rest(system, uniform(Scheme(), 4), system.nominal)) is None


def test_load_that_overflows() -> None:
    """Assert that there is no rest, and no warning, where a load is beyond all numbers."""

    def beyond(*at: np.ndarray) -> SimpleNamespace:
        line = system.linearise(*at)
        infinite = np.full_like(line.residual, np.inf)
        return SimpleNamespace(residual=infinite, d_state=line.d_state, d_algebraic=line.d_algebraic)

    system = rotor(condense=False)
    start = at_rest(system, uniform(Scheme(), 4), system.nominal)
    assert resting(system, start) is not None
    assert resting(cast(System, SimpleNamespace(states=system.states, linearise=beyond)), start) is None


def test_linear_part_without_rest() -> None:
    """Assert that there is no rest, where a mode has no stiffness or modes are not found."""

    def lost(parameter: object) -> None:
        raise ArithmeticError("modes cannot be followed")

    one = np.ones((1, 1))
    drifting = SimpleNamespace(direct=one, outputs=one, inputs=one, exponents=np.zeros(1, dtype=complex))
    system = rotor(condense=False)
    start = at_rest(system, uniform(Scheme(), 4), system.nominal)
    for modes in (lambda parameter: drifting, lost):
        part = SimpleNamespace(modes=modes, states=(0,), forces=(0,))
        assert resting(system, start, cast(LinearPart, part)) is None


def test_rotor_in_a_journal_bearing() -> None:
    """Assert its first orbit and multipliers by collocation, shooting and harmonics to 8 digits."""
    found = []
    harmonics = per.HarmonicBalance()
    for condense, method in ((True, None), (False, None), (False, per.Shooting()), (False, harmonics)):
        branch = per.trace(rotor(condense), "speed", (100.0, 101.0), tol=1e-9, method=method, control=FEW)
        assert len(branch) == 2
        times = np.linspace(0.0, 2 * np.pi / 100.0, 50)
        motion = [branch[0].orbit[name](times) for name in ("disc 1", "disc 2", "journal 1", "journal 2")]
        found.append((np.array(motion), branch[0].multipliers[:4]))
    for motion, multipliers in found[1:]:
        assert motion == pytest.approx(found[0][0], abs=1e-8 * np.ptp(motion[2]))
        assert multipliers == pytest.approx(found[0][1], rel=1e-8)


def test_springs_that_hold_a_structure_are_where_it_is_held() -> None:
    """Assert that places where parts but load the structure have forces that do not depend on its motion."""
    system = rotor(True)
    x = np.full((1, len(system.states)), 0.3)
    line = system.linearise(0 * x, x, np.zeros((1, len(system.algebraics))), np.zeros(1), system.nominal)
    forces = [k for k, row in enumerate(np.abs(line.d_state[0]).max(axis=1)) if row > 0]
    assert len(forces) == 2


def linear(line: dict[str, Any], states: int) -> System:
    """A system whose linearisation is given, per phase."""
    given = SimpleNamespace(**{name: np.asarray(value) for name, value in line.items()})
    each = [SimpleNamespace()] * states
    return cast(System, SimpleNamespace(states=each, linearise=lambda *_: given))


def test_mean_rows_beside_a_linear_part() -> None:
    """Assert x = S f in the rows of states that no equation holds, S = direct - Re outputs inputs/exponents.

    Of three states the first is held by an equation, 2 x0 - 3 f + 1 +- 1 over two phases; places are the
    others, of which x1 = S00 f0 and x2 = S10 f0, with the unknown f0 their force.
    """
    d_state = np.zeros((2, 4, 3))
    d_state[:, 0, 0] = 2.0
    d_algebraic = np.zeros((2, 4, 1))
    d_algebraic[:, 0, 0], d_algebraic[:, 3, 0] = -3.0, 1.0
    residual = np.array([[2.0, 9.0, 9.0, 5.0], [0.0, 9.0, 9.0, 7.0]])
    d_rate = np.zeros((2, 4, 3))
    line = {"residual": residual, "d_state": d_state, "d_algebraic": d_algebraic, "d_rate": d_rate}
    modes = SimpleNamespace(
        direct=np.array([[1.0], [2.0]]),
        outputs=np.array([[2.0 + 1j], [4.0]]),
        inputs=np.array([[3.0 + 0j]]),
        exponents=np.array([-1.0 + 0j]),
    )
    part = cast(LinearPart, SimpleNamespace(modes=lambda p: modes, states=(1, 2), forces=(0,)))
    balance = _Balance.of(linear(line, 3), np.zeros(1), part)
    assert balance.flexibility.tolist() == [[7.0], [14.0]]
    rows, jacobian = balance.rows(np.array([0.1, 0.2, 0.3, 0.4]))
    assert rows == pytest.approx([1.0, 0.2 - 7 * 0.4, 0.3 - 14 * 0.4, 6.0])
    exact = [[2.0, 0.0, 0.0, -3.0], [0.0, 1.0, 0.0, -7.0], [0.0, 0.0, 1.0, -14.0], [0.0, 0.0, 0.0, 1.0]]
    assert jacobian.tolist() == exact
    d_rate[:, 0, 0], d_state[:, 0, 0] = 1.0, 0.0  # a rate alone holds no less
    assert balance.rows(np.zeros(4))[0] == pytest.approx([1.0, 0.0, 0.0, 6.0])
    d_rate[:, 0, 0] = 0.0
    with pytest.raises(np.linalg.LinAlgError, match="a row of an own state is empty"):
        balance.rows(np.zeros(4))


@pytest.mark.parametrize(
    ("residual", "point", "balanced"),
    [
        ([0.0], [0.0], True),
        ([0.9e-9, -0.9e-9], [0.0], True),
        ([0.0, -1.1e-9], [0.0], False),
        ([2.9e-9], [1.0, -2.0], True),
        ([3.1e-9], [1.0, -2.0], False),
        ([], [], True),
    ],
)
def test_what_is_balanced(residual: list[float], point: list[float], balanced: bool) -> None:
    """Assert a residual below 1e-9 of the largest state or unknown, and of 1 more."""
    assert _balanced(np.array(residual), np.array(point)) is balanced


@pytest.mark.parametrize(("bears", "rests"), [(1.0, True), (0.3, True), (1e-3, True), (1e-5, False)])
def test_load_that_is_added_in_steps(bears: float, rests: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a step that fails is halved, one that succeeds doubled, down to 1e-4 of the load.

    Newton's method converges where no more than a part of the load is added at once.
    """
    missing, loads = np.array([8.0]), [0.0]

    def solved(balance: Any, point: Any, load: Any) -> Any:
        borne = 1.0 - float(load[0]) / 8.0
        if borne - loads[-1] > bears * (1 + 1e-12):
            return None
        loads.append(borne)
        return np.array([borne])

    monkeypatch.setattr(meanequilibrium, "_solved", solved)
    found = meanequilibrium._loaded(cast(_Balance, None), np.zeros(1), missing)
    assert (found is not None) is rests
    if found is not None:
        assert loads[-1] == 1.0 and found.tolist() == [1.0] and (np.diff(loads) > 0).all()
        first = 0.5 ** math.ceil(-math.log2(bears))
        assert loads[1] == first
