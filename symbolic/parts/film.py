"""Lubricant films in series with a Hertz contact.

Film relative to its steady state (Mehdigoli et al. 1990, eq. 13): W = Q (h/h0)^(-beta) exp(-gamma dh/dt),
gamma = squeeze / u, u the entraining speed. With the deflection delta/delta0 = s(xi) = ln(1 + e^xi) and
W = Q s^n both s (in contact) and ln s (out of contact) are mild in the algebraic unknown xi.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import casadi as ca

from symbolic.assembly import Assembly
from symbolic.model import Part
from symbolic.parts.contact import ContactPair, Loaded, junction_of
from symbolic.parts.thickness import ThicknessLaw, entraining_speed
from symbolic.variables import Value

REST_XI = math.log(math.e - 1)
"""xi at rest, where s(xi) = 1."""

LEAST_LEFT = 0.1
"""Part of the deflection that one Newton step leaves, as long as the step is taken in the deflection."""

EMPTY = -27.0
"""xi below which the deflection (1e-12 of the steady one) no longer matters to geometry."""

LOST = 1e-3
"""Deflection, relative to the steady one, that marks loss of contact under a film without squeeze."""

LEVELS = tuple(10 ** (-k / 2) for k in range(6, 21))
"""Deflections, relative to the steady one, that mark loss of contact: 10^-1.5 down to 10^-10.

The squeeze film keeps delta positive, many orders below delta0 where contact is lost deeply: the kink
sharpens and moves to ever smaller delta as the speed falls.
"""


def softplus(xi: ca.SX) -> ca.SX:
    """s = ln(1 + e^xi), without overflow."""
    return ca.log1p(ca.exp(ca.fmin(xi, 40))) + ca.fmax(xi - 40, 0)


def log_softplus(xi: ca.SX) -> ca.SX:
    """ln s = ln ln(1 + e^xi), without underflow: it tends to xi where e^xi vanishes."""
    middle = ca.fmax(ca.fmin(xi, 40), -30)
    far = ca.log1p(ca.fmax(xi - 40, 0) / 40)
    return ca.log(ca.log1p(ca.exp(middle))) + ca.fmin(xi + 30, 0) + far


def move_xi(xi: ca.SX, increment: ca.SX) -> ca.SX:
    """Where a Newton increment takes xi: linear in s = softplus(xi) where that stays positive.

    Geometry is linear in s, the film law in ln s. A rise by Newton's tangent in xi overshoots geometry
    exponentially; a fall that would empty the contact is taken in xi, by no more than 10 at a time. Below
    EMPTY, where geometry no longer notices s, xi moves freely.
    """
    s = softplus(xi)
    change = increment / (1 + ca.exp(-ca.fmax(xi, -30)) * ca.exp(-ca.fmin(xi + 30, 0))) / s
    kept = ca.log1p(ca.fmax(change, LEAST_LEFT - 1)) + ca.log(s)
    linear_in_s = _inverse_log_softplus(kept)
    fall = xi + ca.fmax(ca.fmin(increment, math.log(LEAST_LEFT)), -10)
    moved = ca.if_else(change > LEAST_LEFT - 1, linear_in_s, fall)
    free = ca.fmin(xi + increment, EMPTY)
    return ca.if_else(xi < EMPTY, ca.if_else(increment > 0, ca.fmax(moved, free), free), moved)


def _inverse_log_softplus(y: ca.SX) -> ca.SX:
    """xi with ln s(xi) = y: ln(expm1(e^y)) without overflow or underflow."""
    s = ca.exp(ca.fmin(y, 700))
    small = y + ca.log(ca.expm1(ca.fmax(ca.fmin(s, 1), 1e-12)) / ca.fmax(ca.fmin(s, 1), 1e-12))
    large = s + ca.log(-ca.expm1(-ca.fmax(s, 1)))
    return ca.if_else(s > 1, large, small)


class Squeezed(Protocol):
    """A film with squeeze: the numbers of W = Q (h/h0)^(-beta) exp(-gamma dh/dt)."""

    @property
    def law(self) -> ThicknessLaw: ...
    @property
    def speed(self) -> Value: ...
    @property
    def radius(self) -> Value: ...
    @property
    def beta(self) -> Value: ...
    @property
    def squeeze(self) -> Value: ...


def constants(film: Squeezed, assembly: Assembly, contact: Loaded) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Return beta, gamma = squeeze/u (s/m) and h0 (m) of a film."""
    beta = assembly.parameter(film.beta, "beta")
    u = entraining_speed(assembly, film.speed, film.radius)
    gamma = assembly.parameter(film.squeeze, "squeeze") / u
    return beta, gamma, film.law.thickness(assembly, contact, beta)


@dataclass(frozen=True)
class SqueezeFilm(Part):
    """W = Q (h/h0)^(-beta) exp(-gamma dh/dt), gamma = squeeze / u: one state h and one unknown xi.

    squeeze (dimensionless) is 2734.3 in Mehdigoli et al. (1990); speed in rad/s and radius in m give u.
    """

    pair: ContactPair
    law: ThicknessLaw
    speed: Value
    radius: Value
    beta: Value = 22.23
    squeeze: Value = 2734.3

    def contribute(self, assembly: Assembly) -> None:
        """Put this film into the contact."""
        junction_of(assembly, self.pair).film = self

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Rows: film law (its xi-derivative never vanishes) for xi, geometry for h. Returns W."""
        beta, gamma, h0 = constants(self, assembly, contact)
        h = assembly.state(contact.label("h"), "m", assembly.nominal(contact.delta0), h0)
        xi = assembly.algebraic(contact.label("xi"), ca.SX(REST_XI), move_xi)
        deflection = 1 + (h.symbol - h0 + contact.compression) / contact.delta0
        log_load = contact.exponent * log_softplus(xi)
        squeeze = gamma * assembly.omega * h.derivative
        assembly.algebraic_rows.append(log_load + beta * ca.log(h.symbol / h0) + squeeze)
        assembly.differential_rows.append(softplus(xi) - deflection)
        _describe(assembly, contact, h.symbol, xi)
        assembly.switch(f"{contact.name}: lift-off", deflection, -1, LEVELS)
        return contact.preload * ca.exp(log_load)


@dataclass(frozen=True)
class QuasistaticFilm(Part):
    """The film without squeeze (gamma = 0): h = h0 (W/Q)^(-1/beta) follows the load; one unknown xi."""

    pair: ContactPair
    law: ThicknessLaw
    beta: Value = 22.23

    def contribute(self, assembly: Assembly) -> None:
        """Put this film into the contact."""
        junction_of(assembly, self.pair).film = self

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Row: geometry, s(xi) = 1 + (h(xi) - h0 + g)/delta0. Returns W."""
        beta = assembly.parameter(self.beta, "beta")
        h0 = self.law.thickness(assembly, contact, beta)
        xi = assembly.algebraic(contact.label("xi"), ca.SX(REST_XI), move_xi)
        log_load = contact.exponent * log_softplus(xi)
        h = h0 * ca.exp(-log_load / beta)
        gap = 1 + (contact.compression - h0) / contact.delta0
        assembly.algebraic_rows.append(softplus(xi) - gap - h / contact.delta0)
        _describe(assembly, contact, h, xi)
        lifted = h0 * LOST ** (-contact.exponent / beta) / contact.delta0
        assembly.switch(f"{contact.name}: lift-off", gap + lifted - LOST, 0)
        return contact.preload * ca.exp(log_load)


def _describe(assembly: Assembly, contact: Loaded, h: ca.SX, xi: ca.SX) -> None:
    """Add the outputs of a lubricated contact."""
    assembly.output(contact.label("film"), "m", h)
    assembly.output(contact.label("deflection"), "m", contact.delta0 * softplus(xi))
