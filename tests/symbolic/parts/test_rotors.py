"""The forces of rotors' parts against formulae that others print."""

from __future__ import annotations

import math

import casadi as ca
import numpy as np
import pytest

import periodic as per
import symbolic as sym
from symbolic.parts.rotors.shortfilm import resultant

PI2 = math.pi**2


def film(x: float, y: float, x_dot: float = 0.0, y_dot: float = 0.0, turn: float = 1.0) -> np.ndarray:
    """The force over mu R L^3/(2 c^2)."""
    force = resultant(*(ca.SX(v) for v in (x, y, x_dot, y_dot, turn)), ca.SX(1))
    return np.array([float(ca.evalf(f)) for f in force])


@pytest.mark.parametrize("e", [0.1, 0.5, 0.9])
def test_ocvirk(e: float) -> None:
    """Assert the static half-Sommerfeld force of a short bearing, to rounding."""
    expected = [-2 * e**2 / (1 - e**2) ** 2, math.pi * e / (2 * (1 - e**2) ** 1.5)]
    assert film(e, 0.0) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("e", [0.1, 0.5, 0.9])
def test_pure_squeeze(e: float) -> None:
    """Assert the force of a journal that moves outwards without turning, by quadrature."""
    psi, weight = np.polynomial.legendre.leggauss(400)
    psi, weight = psi * math.pi / 2, weight * math.pi / 2
    expected = -2 * weight @ (np.cos(psi) ** 2 / (1 - e * np.cos(psi)) ** 3)
    assert film(e, 0.0, 1.0, 0.0, 0.0) == pytest.approx([expected, 0.0], rel=1e-12, abs=1e-12)


def test_film_turns_with_its_journal() -> None:
    """Assert that turning place and velocity turns the force."""
    turn = np.array([[math.cos(1.1), -math.sin(1.1)], [math.sin(1.1), math.cos(1.1)]])
    place, rate = np.array([0.3, -0.4]), np.array([0.2, 0.7])
    assert film(*(turn @ place), *(turn @ rate)) == pytest.approx(turn @ film(*place, *rate), rel=1e-12)


def coefficients(e: float) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and damping of a short bearing over f/c and f/(c Omega), u across the load f, v along it.

    Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines (2010), eq. (5.86).
    """
    s = math.sqrt(1 - e**2)
    h0 = (PI2 * (1 - e**2) + 16 * e**2) ** -1.5
    a = [
        [4 * (PI2 * (2 - e**2) + 16 * e**2), math.pi * (PI2 * (1 - e**2) ** 2 - 16 * e**4) / (e * s)],
        [
            -math.pi * (PI2 * (1 - e**2) * (1 + 2 * e**2) + 32 * e**2 * (1 + e**2)) / (e * s),
            4 * (PI2 * (1 + 2 * e**2) + 32 * e**2 * (1 + e**2) / (1 - e**2)),
        ],
    ]
    cross = -8 * (PI2 * (1 + 2 * e**2) - 16 * e**2)
    b = [
        [2 * math.pi * s * (PI2 * (1 + 2 * e**2) - 16 * e**2) / e, cross],
        [cross, 2 * math.pi * (PI2 * (1 - e**2) ** 2 + 48 * e**2) / (e * s)],
    ]
    return h0 * np.array(a), h0 * np.array(b)


@pytest.mark.parametrize("e", [0.2, 0.5, 0.8])
def test_stiffness_and_damping(e: float) -> None:
    """Assert the printed coefficients of small motion, to rounding."""
    symbols = [ca.SX.sym(name) for name in ("x", "y", "x_dot", "y_dot")]
    force = ca.vertcat(*resultant(*symbols, ca.SX(1), ca.SX(1)))
    jacobian = ca.Function(
        "jacobian", [ca.vertcat(*symbols)], [force, ca.jacobian(force, ca.vertcat(*symbols))]
    )
    at, by = (np.array(v) for v in jacobian([e, 0, 0, 0]))
    size = np.linalg.norm(at)
    along = -at.ravel() / size  # the load that the film carries
    axes = np.array([[along[1], -along[0]], along])  # u across, v along, the shaft turning from u to v
    stiffness, damping = (-axes @ part @ axes.T / size for part in (by[:, :2], by[:, 2:]))
    printed = coefficients(e)
    assert stiffness == pytest.approx(printed[0], rel=1e-12)
    assert damping == pytest.approx(printed[1], rel=1e-12)


def test_eccentricity_is_over_the_clearance() -> None:
    """Assert the output of a film at displacements (3, 4) and (-1, 0) of ten, and at the centre."""
    x, y = sym.coordinates("x", 2)
    film = sym.JournalBearing(x, y, viscosity=0.02, radius=0.1, length=0.1, clearance=10.0)
    system = sym.compile(film + sym.Mass(x, 1.0) + sym.Mass(y, 1.0))
    states = np.array([[3.0, 0.0, 4.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]])
    states = states / [state.scale for state in system.states]
    none = np.zeros((3, 0))
    found = system.output(0 * states, states, none, np.zeros(3), system.nominal)
    at = [output.name for output in system.outputs].index("eccentricity")
    assert found[:, at] == pytest.approx([0.5, 0.1, 0.0], abs=1e-12)


def test_internal_damping_destabilises_where_it_should() -> None:
    """Assert the closed-form threshold of a shaft with c_i = c_e/3: Omega = (1 + c_e/c_i) sqrt(k/m)."""
    x, y = sym.coordinates("x", 2)
    speed = sym.parameter("speed", 1.0, "rad/s")
    parts = [part for q in (x, y) for part in (sym.Mass(q, 2.0), sym.Spring(q, 8.0), sym.Damper(q, 0.3))]
    model = sym.combine([*parts, sym.InternalDamping(x, y, 0.1, speed)])
    system = sym.compile(model)
    growth = [sym.modes(system, {"speed": 8.0 * part}).eigenvalues.real.max() for part in (0.999, 1.001)]
    assert growth[0] < 0 < growth[1]


def test_unbalance_turns_from_x_to_y() -> None:
    """Assert the circular orbit of an unbalanced rotor, in closed form, its heavy side at an angle."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    speed, m, k, c, e, phi = sym.parameter("speed", 1.3), 2.0, 8.0, 0.3, 0.05, 0.7
    parts = [part for q in (x, y) for part in (sym.Mass(q, m), sym.Spring(q, k), sym.Damper(q, c))]
    system = sym.compile(sym.combine([*parts, sym.Unbalance(x, y, m, e, speed, phi)]))
    orbit = per.trace(system, "speed", (1.3, 1.4), start=1.3)[0].orbit
    w = 1.3
    exact = m * e * w**2 * np.exp(1j * phi) / (k - m * w**2 + 1j * c * w)
    tau = np.linspace(0, 2 * np.pi, 9)
    turning = exact * np.exp(1j * tau)
    assert orbit.state(tau)[:, 0] == pytest.approx(turning.real, abs=1e-12)
    assert orbit.state(tau)[:, 2] == pytest.approx(turning.imag, abs=1e-12)


def test_gyroscopic_split() -> None:
    """Assert the natural frequencies of a spinning disc: w^2 -+ (J/I) Omega w - k/I = 0."""
    a, b = sym.coordinate("a", unit="rad"), sym.coordinate("b", unit="rad")
    parts = [part for q in (a, b) for part in (sym.Mass(q, 1.0), sym.Spring(q, 4.0))]
    system = sym.compile(sym.combine([*parts, sym.GyroscopicMoment(a, b, 2.0, sym.parameter("speed", 1.5))]))
    found = np.sort(sym.modes(system).frequencies)
    expected = [math.sqrt(1.5**2 + 4) - 1.5, math.sqrt(1.5**2 + 4) + 1.5]
    assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (lambda x, y: sym.Rub(x, y, 1.0, 0.0), "clearance of the stator is 0"),
        (lambda x, y: sym.InternalDamping(x, y, -1.0), "internal damping c is -1"),
        (lambda x, y: sym.JournalBearing(x, y, 0.0, 1.0, 1.0, 1.0), "viscosity is 0"),
        (lambda x, y: sym.Jenkins(x, 0.0, 1.0), "stiffness of a slider is 0"),
        (lambda x, y: sym.Iwan(x, 1.0, ()), "limits is"),
        (lambda x, y: sym.TanhFriction(x, 1.0, 0.0), "speed v0 is 0"),
    ],
)
def test_bad_numbers(make, named: str) -> None:  # type: ignore[no-untyped-def]
    """Assert one sentence that names field and value."""
    with pytest.raises(ValueError, match=named):
        make(*sym.coordinates("x", 2))
