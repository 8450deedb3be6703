"""The squeeze film in the form that explicit methods step: its deflection is taken from geometry."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.parts.contact.pair import Loaded
from symbolic.parts.films.squeeze import SqueezeFilm, constants


@dataclass(frozen=True)
class ExplicitSqueezeFilm(SqueezeFilm):
    """The film W = Q (h/h0)^(-beta) exp(-gamma dh/dt) without an algebraic unknown.

    delta = delta0 + h - h0 + g is put into gamma dh/dt = -beta ln(h/h0) - ln(W/Q). Not a number where
    delta <= 0: no solution goes there, but a step that is too long does.

    Parameters
    ----------
    pair : ContactPair
        The contact.
    law : ThicknessLaw
        Steady thickness h0.
    speed : float or Parameter
        Speed of rotation in rad/s.
    radius : float or Parameter
        Radius of the discs in m.
    beta : float or Parameter
        Exponent of the film's stiffness.
    squeeze : float or Parameter
        gamma u, dimensionless.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), section 5.
    """

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Row: the film law for h. Returns W."""
        beta, gamma, h0 = constants(self, assembly, contact)
        h = assembly.state(contact.label("h"), "m", assembly.nominal(contact.delta0), h0)
        relative = 1 + (h.symbol - h0 + contact.compression) / contact.delta0
        log_load = contact.law.log_load(ca.log(relative))
        squeeze = gamma * assembly.omega * h.derivative
        assembly.differential_rows.append(log_load + beta * ca.log(h.symbol / h0) + squeeze)
        assembly.output(contact.label("film"), "m", h.symbol)
        assembly.output(contact.label("deflection"), "m", contact.delta0 * relative)
        return contact.preload * ca.exp(log_load)
