"""The squeeze film: a film relative to its steady state, in series with the elastic contact.

W = Q (h/h0)^(-beta) exp(-gamma dh/dt), gamma = squeeze / u, u the entraining speed (Mehdigoli et al. 1990,
eq. 13); h0 is the steady thickness under the preload Q.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Value
from symbolic.parts.contact.pair import FilmPart, Loaded
from symbolic.parts.films.softplus import REST_XI, log_softplus, move_xi, softplus
from symbolic.parts.films.thickness import ThicknessLaw, entraining_speed

LEVELS = tuple(10 ** (-k / 2) for k in range(6, 21))
"""Deflections, relative to the steady one, that mark loss of contact: 10^-1.5 down to 10^-10.

The squeeze film keeps delta positive, many orders below delta0 where contact is lost deeply: the kink
sharpens and moves to ever smaller delta as the speed falls.
"""


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
class SqueezeFilm(FilmPart):
    """Film with squeeze, W = Q (h/h0)^(-beta) exp(-gamma dh/dt): one state h and one unknown xi.

    Parameters
    ----------
    pair : ContactPair
        The contact.
    law : ThicknessLaw
        Steady thickness h0.
    speed : float or Parameter
        Speed of rotation in rad/s.
    radius : float or Parameter
        Radius of the discs in m; u = radius speed.
    beta : float or Parameter
        Exponent of the film's stiffness.
    squeeze : float or Parameter
        gamma u, dimensionless.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), eq. (13).
    """

    law: ThicknessLaw
    speed: Value
    radius: Value
    beta: Value = 22.23
    squeeze: Value = 2734.3

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Rows: film law (its xi-derivative never vanishes) for xi, geometry for h. Returns W."""
        beta, gamma, h0 = constants(self, assembly, contact)
        h = assembly.state(contact.label("h"), "m", assembly.nominal(contact.delta0), h0)
        xi = assembly.algebraic(contact.label("xi"), ca.SX(REST_XI), move_xi)
        deflection = 1 + (h.symbol - h0 + contact.compression) / contact.delta0
        log_load = contact.law.log_load(log_softplus(xi))
        squeeze = gamma * assembly.omega * h.derivative
        assembly.algebraic_rows.append(log_load + beta * ca.log(h.symbol / h0) + squeeze)
        assembly.differential_rows.append(softplus(xi) - deflection)
        describe(assembly, contact, h.symbol, xi)
        assembly.switch(f"{contact.name}: lift-off", deflection, -1, LEVELS)
        return contact.preload * ca.exp(log_load)


def describe(assembly: Assembly, contact: Loaded, h: ca.SX, xi: ca.SX) -> None:
    """Add the outputs of a lubricated contact."""
    assembly.output(contact.label("film"), "m", h)
    assembly.output(contact.label("deflection"), "m", contact.delta0 * softplus(xi))
