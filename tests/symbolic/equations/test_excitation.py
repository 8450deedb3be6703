"""Orders of the excitation, their common period, and the response to several of them."""

import math
from fractions import Fraction

import numpy as np
import pytest
from numpy.typing import NDArray

import periodic as per
import symbolic as sym
from symbolic.equations.excitation import Order, fundamental, order_of

Array = NDArray[np.float64]
M, C, K = 1.3, 0.2, 2.1
X = sym.coordinate("x")


def oscillator(*forces: sym.Part) -> sym.CompiledSystem:
    """A linear oscillator under forces."""
    parts = [sym.Mass(X, M), sym.Damper(X, C), sym.Spring(X, K), *forces]
    return sym.compile(sym.combine(parts))


def exact(forces: list[tuple[float, float, float]], omega: float, t: Array) -> Array:
    """The response to sum F cos(r omega t + phi), forces as (F, r, phi)."""
    answers = [
        F * np.exp(1j * (r * omega * t + phi)) / (K - M * (r * omega) ** 2 + 1j * C * r * omega)
        for F, r, phi in forces
    ]
    return np.sum(answers, axis=0).real


@pytest.mark.parametrize(
    ("orders", "common"),
    [
        ((), 1),
        ((1,), 1),
        ((2,), 2),
        ((1, 2, 3), 1),
        ((2, 3), 1),
        (("1/2", 1), "1/2"),
        (("2/3", "1/2"), "1/6"),
    ],
)
def test_fundamental(orders: tuple[Order, ...], common: Order) -> None:
    """Assert that the common order is the greatest common divisor."""
    assert fundamental(map(order_of, orders)) == Fraction(common)


@pytest.mark.parametrize("order", [0, -1, math.nan, math.inf, "a", True, math.sqrt(2), 3.084615, "1/0"])
def test_order_refused(order: Order) -> None:
    """Assert that an order without a common period with Omega is refused in one sentence."""
    with pytest.raises(ValueError, match="^order is .*; it must be a positive rational number"):
        oscillator(sym.HarmonicForce(X, 1.0, 0.9, order=order))


def test_orders_without_a_common_period() -> None:
    """Assert that orders whose common period is longer than 1000 periods are refused."""
    forces = [sym.HarmonicForce(X, 1.0, 0.9, order=order) for order in ("1/999", "1/1000")]
    with pytest.raises(ValueError, match="the orders 1/1000, 1/999 have no common period"):
        oscillator(*forces)


@pytest.mark.parametrize(
    "forces",
    [
        [(1.0, 1.0, 0.7)],
        [(1.0, 2.0, 0.0)],
        [(1.0, 1.0, 0.0), (0.4, 2.0, 0.3), (0.3, 3.0, -1.0)],
        [(1.0, 1.0, 0.0), (0.5, 0.5, 0.2)],
        [(1.0, 2 / 3, 0.0), (0.5, 0.5, 0.2)],
    ],
)
def test_response_to_several_orders(forces: list[tuple[float, float, float]]) -> None:
    """Assert that orbit and linear response are the closed form to 9 digits, Omega as before."""
    omega = 0.8
    system = oscillator(*(sym.HarmonicForce(X, F, omega, order=r, phase=phi) for F, r, phi in forces))
    branch = per.trace(system, "Omega", (omega, 1.0), tol=1e-11, start=omega)
    common = float(fundamental(order_of(r) for _, r, _ in forces))
    t = np.linspace(0, 2 * math.pi / (common * omega), 200_001)
    swing = np.ptp(exact(forces, omega, t))
    assert branch[0].peak_to_peak("x") == pytest.approx(swing, rel=1e-9)
    assert sym.response(system, "Omega", [omega]).peak_to_peak("x")[0] == pytest.approx(swing, rel=1e-9)
    assert branch[0].orbit.omega == pytest.approx(common * omega, rel=1e-14)
    # Multipliers are those of the smallest common period.
    decay = math.exp(-C / (2 * M) * t[-1])
    assert abs(branch[0].multipliers[0]) == pytest.approx(decay, rel=1e-12)


def test_static_load() -> None:
    """Assert that a constant force moves the rest and not the multipliers."""
    system = oscillator(sym.ConstantForce(X, 0.5), sym.HarmonicForce(X, 1.0, 0.8))
    rest = sym.modes(system)
    assert rest.state[0] == pytest.approx(0.5 / K, rel=1e-14)


def test_start_of_a_coordinate_chooses_the_rest() -> None:
    """Assert that of two equilibria that near the start is found: -x + x^3 = 0."""
    for start in (-0.9, 1.2):
        x = sym.coordinate("x", start=start)
        parts = sym.Mass(x, 1.0) + sym.Spring(x, -1.0) + sym.CubicSpring(x, 1.0) + sym.Damper(x, 0.1)
        assert sym.modes(sym.compile(parts)).state[0] == pytest.approx(math.copysign(1, start), rel=1e-12)


@pytest.mark.parametrize("order", [100_001, "1e6", 1e300, 10**400])
def test_orders_that_are_too_high(order: Order) -> None:
    """Assert that a harmonic turns at most 100000 times within a turn of Omega."""
    with pytest.raises(ValueError, match="^order is .*; it must be .*, and at most 100000$"):
        order_of(order)


def test_harmonics_of_a_long_common_period() -> None:
    """Assert the same within the common period of all orders, and that the highest is taken."""
    assert fundamental([Fraction(1), Fraction(100_000)]) == 1
    with pytest.raises(ValueError, match="^the order 100000 turns 200000 times in the common period of all"):
        fundamental([Fraction(1, 2), Fraction(100_000)])


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("omega", [0.0, -1.0])
def test_frequency_that_is_not_positive(count: int, omega: float) -> None:
    """Assert that a model of one coordinate or two is refused whose frequency is nominally 0 or less."""
    x = sym.coordinates("x", count)
    parts = [part for q in x for part in (sym.Mass(q, 1.0), sym.Spring(q, 1.0))]
    said = f"^the frequency of the excitation is {omega} rad/s; its nominal value must be greater than 0$"
    with pytest.raises(ValueError, match=said):
        sym.compile(sym.combine([*parts, sym.HarmonicForce(x[0], 1.0, omega)]))


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("1/3", Fraction(1, 3)),
        ("0." + "5".ljust(38, "0"), Fraction(1, 2)),
        ("2e0", Fraction(2)),
        ("500E-3", Fraction(1, 2)),
        ("0." + "0" * 33 + "5e34", Fraction(5)),
        ("100000", Fraction(100_000)),
    ],
)
def test_orders_as_text(text: str, found: Fraction) -> None:
    """Assert numbers of up to 40 characters, whose exponent may be as large."""
    assert len(text) <= 40 and order_of(text) == found


@pytest.mark.parametrize(
    "text", ["0." + "5".ljust(39, "0"), "1e41", "1e-41", "1e999999999999", "2e", "", "0", "-1"]
)
def test_orders_as_text_that_are_refused(text: str) -> None:
    """Assert the sentence for longer ones, larger exponents, and what is no positive number."""
    with pytest.raises(
        ValueError, match="^order is .*; it must be a positive rational number such as 2, 0.5 or"
    ):
        order_of(text)
    with pytest.raises(ValueError, match="and at most 100000$"):
        order_of("100001")
    with pytest.raises(ValueError, match="and at most 100000$"):
        order_of("1e40")


@pytest.mark.parametrize(
    ("value", "found"),
    [(1 / 3, Fraction(1, 3)), (0.1 + 0.2, Fraction(3, 10)), (999 / 1000, Fraction(999, 1000))],
)
def test_orders_that_are_rounded(value: float, found: Fraction) -> None:
    """Assert the rational number that a floating-point one stands for."""
    assert order_of(value) == found
    with pytest.raises(ValueError, match="the excitation has no common period otherwise$"):
        order_of(value * (1 + 1e-11))
