"""The linear part of a condensed model: its answer to forces, against the matrices themselves."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import symbolic as sym
from periodic.system import linear_of

M = np.diag([2.0, 1.0, 3.0])
K = np.array([[9.0, -4.0, 0.0], [-4.0, 7.0, -3.0], [0.0, -3.0, 5.0]])
C = 0.02 * K + 0.1 * M + np.diag([0.0, 0.3, 0.0])
G = np.array([[0.0, 0.5, 0.0], [-0.5, 0.0, 0.2], [0.0, -0.2, 0.0]])
FORCE = {"a": 0, "b": 2}
OMEGA = 1.3


def compiled(*, scales: tuple[float, float] = (0.5, 0.2), turning: bool = False, extra: bool = False) -> Any:
    """Three masses with cubic springs at two places; a mass of another structure besides."""
    structure = sym.Structure(M, C, K, G=G if turning else None, at=FORCE, scale=scales[0])
    parts: list[sym.Part] = [
        structure,
        sym.CubicSpring(structure["a"], 1.0),
        sym.CubicSpring(structure["b"], 2.0),
    ]
    parts.append(sym.HarmonicForce(structure["a"], 0.3, OMEGA))
    if extra:
        other = sym.Structure(
            np.eye(1), 0.1 * np.eye(1), 4 * np.eye(1), at={"c": 0}, scale=scales[1], name="other"
        )
        parts += [other, sym.CubicSpring(other["c"], 1.0)]
    return sym.compile(sym.combine(parts))


def answer(modes: Any, s: complex) -> np.ndarray:
    """The states at places under forces exp(s tau), of modes that come with their conjugates."""
    both = [(modes.exponents, modes.inputs, modes.outputs)]
    both.append(tuple(np.conj(part) for part in both[0]))  # type: ignore[arg-type]
    found = sum(shown @ (driven / (s - values)[:, None]) for values, driven, shown in both) / 2
    return np.asarray(found + modes.direct + s * modes.direct_rate)


def flexibility(omega: float, s: complex, turning: bool = False) -> np.ndarray:
    """Displacements of the three masses under unit forces at the places a and b, exp(s tau)."""
    rate = s * omega
    damping = C + omega * G if turning else C
    found: np.ndarray = np.linalg.inv(rate**2 * M + rate * damping + K)[:, [0, 2]]
    return found


@pytest.mark.parametrize("s", [0.0, 0.7j, 2.1j, 0.3 + 1.2j])
@pytest.mark.parametrize("turning", [False, True])
@pytest.mark.parametrize("omega", [OMEGA, 0.6])
def test_answer_of_the_places(s: complex, turning: bool, omega: float) -> None:
    """Assert displacements and velocities at the places under forces there, in the scales of both."""
    system = compiled(turning=turning)
    part: Any = linear_of(system)
    parameter = np.array([omega if p.name == "Omega" else p.value for p in system.parameters])
    forces = [system.algebraics[k].scale for k in part.forces]
    names = [system.states[k].name for k in part.states]
    assert names == ["a", "a'", "b", "b'"] and part.velocities == (part.states[1], part.states[3])
    assert part.size == 6 and [structure.size for structure in part.structures] == [3]
    found = answer(part.modes(parameter), s)
    exact = flexibility(omega, s, turning)[[0, 2]] * forces / 0.5
    assert found[::2] == pytest.approx(exact, rel=1e-10)
    assert found[1::2] == pytest.approx(s * exact, rel=1e-10, abs=1e-12)


@pytest.mark.parametrize("turning", [False, True])
def test_answer_changes_with_the_speed(turning: bool) -> None:
    """Assert its derivative against differences, and that other parameters change nothing."""
    system, step, s = compiled(turning=turning), 1e-5, 0.9j
    part: Any = linear_of(system)
    index = [p.name for p in system.parameters].index("Omega")
    ends = [part.modes(system.nominal + way * np.eye(len(system.nominal))[index]) for way in (step, -step)]
    slope, at = part.slope(system.nominal, index), part.modes(system.nominal)
    for name in ("exponents", "inputs", "outputs", "direct", "direct_rate"):
        ahead, back = (getattr(end, name) for end in ends)
        scale = np.abs(getattr(at, name)).max(initial=1e-3)
        if name == "exponents" or not turning:
            assert getattr(slope, name) == pytest.approx((ahead - back) / (2 * step), abs=1e-7 * scale)
    moved = sum(
        slope.outputs @ (at.inputs / (s - at.exponents)[:, None])
        + at.outputs @ (slope.inputs / (s - at.exponents)[:, None])
        + at.outputs @ (at.inputs * slope.exponents[:, None] / ((s - at.exponents) ** 2)[:, None])
        for slope, at in ((slope, at), (conjugate(slope), conjugate(at)))
    )
    exact = (answer(ends[0], s) - answer(ends[1], s)) / (2 * step)
    assert moved / 2 == pytest.approx(exact, abs=1e-6 * np.abs(exact).max())
    assert all(part.slope(system.nominal, k) is None for k in range(len(system.nominal)) if k != index)


def conjugate(modes: Any) -> Any:
    """Their conjugates."""
    return SimpleNamespace(**{name: np.conj(value) for name, value in vars(modes).items()})


def test_structures_side_by_side() -> None:
    """Assert that none answers to forces on the other, and each in its own scale of length."""
    system = compiled(extra=True)
    part: Any = linear_of(system)
    assert [structure.size for structure in part.structures] == [3, 1] and part.size == 8
    forces, s = [system.algebraics[k].scale for k in part.forces], 0.7j
    found = answer(part.modes(system.nominal), s)
    exact = np.zeros((3, 3), dtype=complex)
    exact[:2, :2] = flexibility(OMEGA, s)[[0, 2]] / 0.5
    rate = s * OMEGA
    exact[2, 2] = 1 / (rate**2 + 0.1 * rate + 4) / 0.2
    assert found[::2] == pytest.approx(exact * forces, rel=1e-10, abs=1e-14)


@pytest.mark.parametrize("freedoms", [None, [1], [2, 0]])
def test_answer_of_other_degrees_of_freedom(freedoms: list[int] | None) -> None:
    """Assert displacement and velocity in SI of each that is asked for, of the structure that is named."""
    system, s = compiled(extra=True), 0.7j
    part: Any = linear_of(system)
    forces = np.array([system.algebraics[k].scale for k in part.forces])
    wanted = [0, 1, 2] if freedoms is None else freedoms
    found = answer(part.observed(system.nominal, freedoms, "structure"), s)
    exact = np.hstack([flexibility(OMEGA, s)[wanted] * forces[:2], np.zeros((len(wanted), 1))])
    assert found[::2] == pytest.approx(exact, rel=1e-10, abs=1e-14)
    assert found[1::2] == pytest.approx(s * OMEGA * exact, rel=1e-10, abs=1e-14)
    other = answer(part.observed(system.nominal, None, "other"), s)
    rate = s * OMEGA
    assert other[0, 2] == pytest.approx(forces[2] / (rate**2 + 0.1 * rate + 4), rel=1e-10)
    for name, said in ((None, "structure is None; it must be one of"), ("third", "structure is 'third'")):
        with pytest.raises(ValueError, match=said):
            part.observed(system.nominal, None, name)


def test_modes_of_many_speeds_are_not_all_kept() -> None:
    """Assert that they are computed once for a speed, and that of old ones none are kept for ever."""
    system = compiled(turning=True)
    part: Any = linear_of(system)
    index = [p.name for p in system.parameters].index("Omega")
    speeds = [system.nominal + 0.01 * k * np.eye(len(system.nominal))[index] for k in range(12)]
    first = part.modes(speeds[0])
    assert part.modes(speeds[0]) is first
    for speed in speeds:
        part.modes(speed)
    assert len(part._known) <= 9 and part.modes(speeds[0]) is not first


@pytest.mark.parametrize("rate", [1.0, -2.5])
def test_change_by_differences(rate: float) -> None:
    """Assert how the answer changes, as by the closed form, times the rate at which omega changes."""
    part = linear_of(compiled(turning=True))
    own: Any = part
    found, exact = own._difference(OMEGA, rate), own._product(OMEGA, rate, changes(own))
    step = 1e-6
    ends = [answer(own._at(OMEGA + way * step), 0.7j) for way in (1, -1)]
    for each in (found, exact):
        moved = [
            SimpleNamespace(
                **{
                    name: getattr(own._at(OMEGA), name) + way * step * getattr(each, name)
                    for name in ("exponents", "inputs", "outputs", "direct", "direct_rate")
                }
            )
            for way in (1, -1)
        ]
        one, other = (answer(modes, 0.7j) for modes in moved)
        expected = rate * (ends[0] - ends[1])
        assert one - other == pytest.approx(expected, abs=1e-4 * np.abs(expected).max())


def changes(part: Any) -> list[Any]:
    """How the modes of each structure change with the speed."""
    found = [structure.modal_slope(OMEGA) for structure in part.structures]
    assert None not in found
    return found
