"""The paper's third-order equation in h (eq. 17) is the three-state system, and what it refuses."""

import numpy as np
import pytest
from support.traces import RPM, disc_system, user_points

import periodic as per
import symbolic as sym
from symbolic.integration.flow import Flow
from symbolic.motion.explicit import rates
from symbolic.motion.linear import modes
from symbolic.scenes.errors import InputError
from symbolic.scenes.reading import load
from symbolic.system.compiled import with_values

THIRD, THREE = "third-order-810N", "vitrea79-810N"
SPEEDS = (200.0, 290.0, 360.0, 500.0)


def sorted_eigenvalues(scene: str, rpm: float) -> np.ndarray:
    """Return the eigenvalues at rest in an order that does not depend on the form."""
    found = modes(disc_system(scene), {"speed": rpm * RPM}).eigenvalues
    return found[np.lexsort((found.imag, found.real))]


@pytest.mark.parametrize("rpm", SPEEDS)
def test_eigenvalues(rpm: float) -> None:
    """Assert that small motion about rest is the same in both forms."""
    np.testing.assert_allclose(sorted_eigenvalues(THIRD, rpm), sorted_eigenvalues(THREE, rpm), rtol=1e-11)


def test_motion() -> None:
    """Assert that both forms go the same way from one state, without contact being lost."""
    third, three = disc_system(THIRD), disc_system(THREE)
    phase = np.linspace(0.0, 30.0, 61)
    parameter = with_values(third, {"speed": 360 * RPM})
    begin = np.array([third.rest(parameter)[0][0], 0.0, 0.0])
    paper = Flow(third, 1e-11).run(begin, np.zeros(0), parameter, phase)
    known = third.output(0 * paper.state, paper.state, paper.algebraic, phase, parameter)

    # x' from two samples of the same run close to the start.
    early = Flow(third, 1e-12).run(begin, np.zeros(0), parameter, np.array([0.0, 1e-3, 2e-3]))
    x = third.output(0 * early.state, early.state, early.algebraic, early.phase, parameter)[:, 0]
    slope = (-3 * x[0] + 4 * x[1] - x[2]) / 2e-3
    scale = three.states[0].scale
    start = np.array([x[0] / scale, slope / scale, begin[0]])
    values = with_values(three, {"speed": 360 * RPM})
    ours = Flow(three, 1e-11).run(start, three.rest(values)[1], values, phase)
    found = three.output(0 * ours.state, ours.state, ours.algebraic, phase, values)
    for output in range(4):
        np.testing.assert_allclose(known[:, output], found[:, output], atol=1e-6 * np.ptp(found[:, output]))


def test_orbits() -> None:
    """Assert that the periodic orbits and their multipliers are the same, down to where contact is lost."""
    at, ends = SPEEDS[1:3], (290 * RPM, 500 * RPM)
    branches = [
        per.trace(disc_system(s), "speed", ends, start=500 * RPM, at=[v * RPM for v in at], tol=1e-8)
        for s in (THIRD, THREE)
    ]
    assert [branch.stop.reason for branch in branches] == [per.Reason.BOUND] * 2
    (third,), (three,) = (user_points(branch, 360 * RPM) for branch in branches)
    for output in ("x", "film", "deflection", "load"):
        assert third.peak_to_peak(output) == pytest.approx(three.peak_to_peak(output), rel=1e-7)
        assert branches[0][-1].maximum[output] == pytest.approx(branches[1][-1].maximum[output], rel=1e-6)
    np.testing.assert_allclose(np.abs(third.multipliers[:2]), np.abs(three.multipliers[:2]), rtol=1e-6)


def test_trace_creeps_where_contact_is_lost() -> None:
    """Assert that the third-order form does not get through loss of contact in 40 points; 20 are enough."""
    few = per.ArclengthControl(max_points=40)
    ends = {}
    for scene in (THIRD, THREE):
        branch = per.trace(disc_system(scene), "speed", (265 * RPM, 320 * RPM), start=320 * RPM, control=few)
        ends[scene] = (branch.stop.reason, branch[-1].parameter / RPM)
    assert ends[THREE] == (per.Reason.BOUND, pytest.approx(265))
    assert ends[THIRD][0] is per.Reason.MAX_POINTS and 284 < ends[THIRD][1] < 290


def test_third_derivative_by_hand() -> None:
    """Assert h''' against the equation written out by hand, in SI units, at an arbitrary state.

    With delta' = -(delta/n)(beta h'/h + gamma h'') and so on, h''' follows from m X'' = 2 (W - Q).
    """
    system = disc_system(THIRD)
    named = {p.name: p.value for p in system.parameters}
    parameter, omega = system.nominal, 120 * named["speed"]
    q, n, beta, m = named["preload"], named["exponent"], named["beta"], named["mass"]
    gamma = named["squeeze"] / (named["radius"] * named["speed"])
    scale = system.states[0].scale
    h0 = system.rest(parameter)[0][0] * scale
    tau, h, h1, h2 = 0.7, 1.05 * h0, 3e-4, -0.8
    state = np.array([[h, h1 / omega, h2 / omega**2]]) / scale
    delta0 = (q / named["stiffness"]) ** (1 / n)
    load = q * (h / h0) ** -beta * np.exp(-gamma * h1)
    delta = delta0 * (load / q) ** (1 / n)
    rate = -(beta * h1 / h + gamma * h2) / n
    forcing = -named["amplitude"] * omega**2 * np.sin(tau)
    # X'' = h'' + w'' - delta'', delta'' = delta (rate^2 - (beta (h''/h - h'^2/h^2) + gamma h''')/n)
    curvature = (h2 + forcing - 2 * (load - q) / m) / delta - rate**2
    h3 = (-n * curvature - beta * (h2 / h - h1**2 / h**2)) / gamma
    found = rates(system)(state, np.array([tau]), parameter)[0] * scale
    np.testing.assert_allclose(found, [h1 / omega, h2 / omega**2, h3 / omega**3], rtol=1e-9)


def test_rates_need_a_system_without_unknowns() -> None:
    """Assert that explicit rates of a system with an algebraic unknown are refused by its name."""
    with pytest.raises(ValueError, match="algebraic unknowns xi"):
        rates(disc_system(THREE))


def test_dry_contact_is_refused() -> None:
    """Assert that a contact without squeeze film has no third-order form."""
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    dry = sym.Mass(x, 1.0) + sym.Preload(pair, 810.0) + sym.Hertz(pair, 28e9)
    with pytest.raises(ValueError, match="one contact with a squeeze film"):
        sym.compile(sym.films.ThirdOrder(dry))


def test_support_is_refused() -> None:
    """Assert that the scene says that a second coordinate cannot be had in this form."""
    changes = [("support.stiffness", "1e9"), ("support.damping", "0"), ("support.disc_share", "0.5")]
    with pytest.raises(InputError, match='support is given; film.law = "third-order" must have none'):
        load(THIRD, changes)


def test_damping_reaches_the_reduced_equation() -> None:
    """Assert that contact damping changes both forms alike: it acts on the eliminated coordinate."""
    changed = [disc_system(scene, 0.02) for scene in (THIRD, THREE)]
    one, other = (modes(system, {"speed": 360 * RPM}) for system in changed)
    assert one.damping_ratios[0] == pytest.approx(other.damping_ratios[0], rel=1e-10)
    assert one.damping_ratios[0] > modes(disc_system(THIRD), {"speed": 360 * RPM}).damping_ratios[0] + 0.01
