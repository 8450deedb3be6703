"""Tori: invariance at angles that the equations do not hold, numbers known otherwise, what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from support.kept import kept

import periodic as per
import symbolic as sym
from periodic.system import index_of
from periodic.tori.born import first, start
from periodic.tori.family import family_of
from periodic.tori.invariance import Unknowns

pytestmark = pytest.mark.usefixtures("users_kernels")


@kept
def branch() -> per.Branch:
    """The rotor with internal damping through its torus bifurcation."""
    return per.trace(sym.scene("jeffcott-internal-damping"), "n", (1.2, 2.2), start=1.2)


@kept
def whirl() -> per.Torus:
    """Its torus at n = 2."""
    return per.torus(sym.scene("jeffcott-internal-damping"), branch().labelled("NS")[0], "n", 2.0, tol=1e-10)


def test_rotor_with_internal_damping() -> None:
    """Assert rotation number and radius of the section, known to ten digits from another computation."""
    x, y = whirl().section("x"), whirl().section("y")
    assert whirl().parameters["n"] == pytest.approx(2.0, rel=1e-12)
    assert whirl().rotation_number == pytest.approx(0.501205988590, rel=1e-9)
    radius = np.sqrt(np.mean((x - x.mean()) ** 2 + (y - y.mean()) ** 2))
    assert radius == pytest.approx(0.8059788101, rel=1e-8)
    assert whirl().tail < 1e-8 and whirl().residual < 1e-10


@pytest.mark.parametrize("angle", [0.05, 1.3, 4.0])
def test_integration_stays_on_the_torus(angle: float) -> None:
    """Assert that 20 periods from an angle between those of the equations end where the rotation says."""
    found, rotor = whirl(), sym.scene("jeffcott-internal-damping")
    begin = found.states_at(np.array([angle]))[0]
    phases = np.array([0.0, 20 * found.period])
    flow = rotor.flow(begin, np.zeros(0), found.parameter, phases, (), 1e-12)
    expected = found.states_at(np.array([angle + 20 * found.rotation]))[0]
    assert flow.state[-1] == pytest.approx(expected, abs=1e-6)


def test_velocity_is_in_SI() -> None:
    """Assert dx/dt = n dx/dtau."""
    states = [q.name for q in whirl().layout.states]
    assert whirl().section("x'") == pytest.approx(2.0 * whirl().states[:, states.index("x'")], rel=1e-12)


def test_family_goes_on_the_way_it_has_come() -> None:
    """Assert the length of two steps, foreseen to second order by one tangent, to third by both."""
    system, born = sym.scene("jeffcott-internal-damping"), branch().labelled("NS")[0]
    family, off = family_of(system, index_of(system, "n"), 1e-8), []
    weights = np.concatenate([np.full(11 * len(system.states), 1 / 11), [1.0, 1.0]])
    now, tangent = start(family, *first(system, born, 11))
    unknowns = Unknowns(family.equations, now).of
    assert weights @ tangent**2 == pytest.approx(1)
    for length in (0.1, 0.05):
        found = family.corrected(now, tangent, length)
        assert found is not None
        way = unknowns(found[0]) - unknowns(now)
        assert weights @ (tangent * way) == pytest.approx(length, rel=1e-9)
        assert weights @ found[1] ** 2 == pytest.approx(1)
        middle = (tangent + found[1] / (weights @ (tangent * found[1]))) / 2
        off.append([np.sqrt(weights @ (way - length * each) ** 2) for each in (tangent, middle)])
    assert off[0][0] < 0.01 and 2.5 < off[0][0] / off[1][0] < 6
    assert off[0][1] < 0.001 and 5 < off[0][1] / off[1][1] < 12


def test_what_is_no_torus_is_refused() -> None:
    """Assert one sentence for each."""
    rotor, born = sym.scene("jeffcott-internal-damping"), branch().labelled("NS")[0]
    with pytest.raises(
        ValueError, match=r"^point is Point\(1.2, EP stable\); it must be a point NS of a branch$"
    ):
        per.torus(rotor, branch()[0], "n", 2.0)
    with pytest.raises(ValueError, match="^angles is 40; it must be odd$"):
        per.torus(rotor, born, "n", 2.0, angles=40)
    with pytest.raises(per.TorusError, match="^the family of tori was followed to n = .* only, not to 1.5"):
        per.torus(rotor, born, "n", 1.5, angles=11, max_steps=2)
    with pytest.raises(ValueError, match="^section is 'z'; it must be one of x, x', y, y'$"):
        whirl().section("z")
