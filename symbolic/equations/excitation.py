"""The excitation of a model: its frequency, the orders of it that parts use, and their common period.

Parts speak of the angle theta = Omega t. With orders r_1, r_2, ... the excitation repeats after the smallest
common period of cos(r_k theta), which is 2 pi of the phase tau = g theta of the compiled system, g the
greatest common divisor of the orders: 1 where no part asks for any other order.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction

import casadi as ca

from symbolic.checks import refusal

Order = int | float | str | Fraction
"""Order of a harmonic: a positive rational number, perhaps as text, as "1/2"."""

MOST_PERIODS = 1000
"""Most periods of theta after which an excitation may repeat."""

HIGHEST_ORDER = 100_000
"""Most turns of a harmonic within a turn of theta, or within the common period."""

LONGEST_TEXT = 40
"""Most characters of an order written as text, and most places by which its exponent shifts the point."""

ROUNDED_RATIO = 1e-12
"""Relative difference from a rational number up to which a floating-point number stands for it."""


def order_of(value: Order) -> Fraction:
    """Return a positive rational order. Raises ValueError."""
    allowed = f'a positive rational number such as 2, 0.5 or "1/3", with a denominator up to {MOST_PERIODS}'
    try:
        exact = math.nan if isinstance(value, bool) else Fraction(_bounded(value))
    except (TypeError, ValueError, ZeroDivisionError, OverflowError):
        exact = math.nan
    if not isinstance(exact, Fraction) or exact <= 0:
        raise refusal("order", value, allowed)
    if exact > HIGHEST_ORDER:
        raise refusal("order", value, f"{allowed}, and at most {HIGHEST_ORDER}")
    found = exact.limit_denominator(MOST_PERIODS)
    if abs(found - exact) > ROUNDED_RATIO * exact:
        raise refusal("order", value, f"{allowed}: the excitation has no common period otherwise")
    return found


def _bounded(value: Order) -> Order:
    """The value, if it may be read: of a text its exponent, as a number it would be written out in digits."""
    if isinstance(value, str):
        exponent = value.lower().partition("e")[2]
        if len(value) > LONGEST_TEXT or (exponent and abs(int(exponent)) > LONGEST_TEXT):
            raise ValueError("it has too many digits")
    return value


def fundamental(orders: Iterable[Fraction]) -> Fraction:
    """Return the greatest common divisor of orders, 1 where there are none. Raises ValueError."""
    numbers = sorted(orders)
    if not numbers:
        return Fraction(1)
    below = math.lcm(*(number.denominator for number in numbers))
    found = Fraction(math.gcd(*(int(number * below) for number in numbers)), below)
    if found * MOST_PERIODS < 1:
        listed = ", ".join(str(number) for number in numbers)
        raise ValueError(
            f"the orders {listed} have no common period of at most {MOST_PERIODS} periods of the excitation; "
            f"choose orders of a smaller common denominator"
        )
    if numbers[-1] > HIGHEST_ORDER * found:
        raise ValueError(
            f"the order {numbers[-1]} turns {numbers[-1] / found} times in the common period of all orders; "
            f"it must turn at most {HIGHEST_ORDER} times"
        )
    return found


@dataclass
class Excitation:
    """Angle and harmonics as placeholders; `wave` and `theta` tell which orders a model needs.

    Parameters
    ----------
    angle : casadi.SX
        theta.
    pace : casadi.SX
        Placeholder of dtheta/dtau = 1/g.
    waves : dict
        sin(r theta) and cos(r theta) by order r: zero in the unexcited system.
    frequency : casadi.SX, optional
        Omega in rad/s, once a part has said it.
    """

    angle: ca.SX = field(default_factory=lambda: ca.SX.sym("theta"))
    pace: ca.SX = field(default_factory=lambda: ca.SX.sym("pace"))
    waves: dict[Fraction, tuple[ca.SX, ca.SX]] = field(default_factory=dict)
    repeated: set[Fraction] = field(default_factory=set)
    frequency: ca.SX | None = None

    def wave(self, order: Order = 1) -> tuple[ca.SX, ca.SX]:
        """Return sin(r theta) and cos(r theta). Raises ValueError."""
        r = order_of(order)
        if r not in self.waves:
            self.waves[r] = (ca.SX.sym(f"sin_{r}_theta"), ca.SX.sym(f"cos_{r}_theta"))
        return self.waves[r]

    def theta(self, order: Order = 1) -> ca.SX:
        """Return theta, for terms that repeat with cos(r theta). Raises ValueError."""
        self.repeated.add(order_of(order))
        return self.angle

    @property
    def fundamental(self) -> Fraction:
        """g of tau = g theta. Raises ValueError."""
        return fundamental({*self.waves, *self.repeated})

    @property
    def orders(self) -> tuple[Fraction, ...]:
        """Orders of the harmonics, lowest first."""
        return tuple(sorted(self.waves))

    @property
    def symbols(self) -> ca.SX:
        """sin(r theta) and cos(r theta) of all `orders` one after another, a column."""
        return ca.vertcat(ca.SX(0, 1), *(symbol for r in self.orders for symbol in self.waves[r]))

    def along(self, expression: ca.SX, symbols: ca.SX, rates: ca.SX) -> ca.SX:
        """Return the derivative in tau of an expression in symbols, of given rates, and the excitation."""
        arguments, found = [symbols, self.angle], [rates, self.pace]
        for order, (sine, cosine) in self.waves.items():
            arguments += [sine, cosine]
            found += [float(order) * self.pace * cosine, -float(order) * self.pace * sine]
        return ca.jtimes(expression, ca.vertcat(*arguments), ca.vertcat(*found))

    def values(self, phase: ca.SX) -> ca.SX:
        """Return what `symbols` are at a phase tau."""
        turns = [r / self.fundamental for r in self.orders]
        return ca.vertcat(ca.SX(0, 1), *(f(float(k) * phase) for k in turns for f in (ca.sin, ca.cos)))

    def timed(self, expression: ca.SX, phase: ca.SX) -> ca.SX:
        """Return an expression with tau/g for the angle."""
        pace = 1 / float(self.fundamental)
        return ca.substitute(ca.substitute(expression, self.angle, pace * phase), self.pace, ca.SX(pace))
