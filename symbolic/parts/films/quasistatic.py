"""The film without squeeze: its thickness follows the load."""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Value
from symbolic.parts.contact.pair import FilmPart, Loaded
from symbolic.parts.films.softplus import REST_XI, log_softplus, move_xi, softplus
from symbolic.parts.films.squeeze import describe
from symbolic.parts.films.thickness import ThicknessLaw

CONTACT_LOST = 1e-3
"""Deflection, relative to the steady one, that marks loss of contact under a film without squeeze."""


@dataclass(frozen=True)
class QuasistaticFilm(FilmPart):
    """Film without squeeze, h = h0 (W/Q)^(-1/beta): one unknown xi.

    Parameters
    ----------
    pair : ContactPair
        The contact.
    law : ThicknessLaw
        Steady thickness h0.
    beta : float or Parameter
        Exponent of the film's stiffness.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), eq. (13) with gamma = 0.
    """

    law: ThicknessLaw
    beta: Value = 22.23

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Row: geometry, s(xi) = 1 + (h(xi) - h0 + g)/delta0. Returns W."""
        beta = assembly.parameter(self.beta, "beta")
        h0 = self.law.thickness(assembly, contact, beta)
        xi = assembly.algebraic(contact.label("xi"), ca.SX(REST_XI), move_xi)
        log_load = contact.law.log_load(log_softplus(xi))
        h = h0 * ca.exp(-log_load / beta)
        gap = 1 + (contact.compression - h0) / contact.delta0
        assembly.algebraic_rows.append(softplus(xi) - gap - h / contact.delta0)
        describe(assembly, contact, h, xi)
        lifted = h0 * ca.exp(-contact.law.log_load(ca.SX(math.log(CONTACT_LOST))) / beta) / contact.delta0
        assembly.switch(f"{contact.name}: lift-off", gap + lifted - CONTACT_LOST, 0)
        return contact.preload * ca.exp(log_load)
