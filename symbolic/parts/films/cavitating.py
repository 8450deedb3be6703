"""A squeeze film with a floor: it separates no faster than under a small load, and then a cavity opens.

    dh/dt = -(1/gamma) [ln max(W/Q, phi) + beta ln(h/h0)],   W = F(delta),   delta = delta0 + h - h0 + g

While W > phi Q this is the squeeze film of `symbolic.parts.films.squeeze`. Below it the film grows towards
h0 phi^(-1/beta) at a finite rate; where the surfaces part faster, delta < 0 and -delta is the width of a
cavity that carries no load. phi -> 0 gives the squeeze film back. The exponential law of Mehdigoli et al.
(1990), eq. (13), has no such floor: dh/dt grows without bound as W -> 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Value
from symbolic.parts.contact.pair import FilmPart, Loaded
from symbolic.parts.films.squeeze import constants
from symbolic.parts.films.thickness import ThicknessLaw


@dataclass(frozen=True)
class CavitatingFilm(FilmPart):
    """Squeeze film with the floor phi = `floor` on the relative load that drives it: one state h.

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
    floor : float or Parameter
        phi, between 0 and 1: ambient pressure over the footprint carries about 1e-4 of the paper's preloads.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), eq. (13), which has no floor.
    """

    law: ThicknessLaw
    speed: Value
    radius: Value
    beta: Value = 22.23
    squeeze: Value = 2734.3
    floor: Value = 1e-4

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Row: film law for h, explicit in dh/dt. Returns W."""
        beta, gamma, h0 = constants(self, assembly, contact)
        floor = assembly.parameter(self.floor, "floor")
        if not 0 < assembly.nominal(floor) < 1:
            raise ValueError(f"floor is {assembly.nominal(floor)}; it must lie between 0 and 1")
        h = assembly.state(contact.label("h"), "m", assembly.nominal(contact.delta0), h0)
        deflection = 1 + (h.symbol - h0 + contact.compression) / contact.delta0
        least = ca.exp(contact.law.log_deflection(ca.log(floor)))
        log_load = contact.law.log_load(ca.log(ca.fmax(deflection, least)))
        rate = gamma * assembly.omega * h.derivative
        assembly.differential_rows.append(log_load + beta * ca.log(h.symbol / h0) + rate)
        self._describe(assembly, contact, h.symbol, deflection)
        assembly.switch(f"{contact.name}: load = floor", deflection - least, 0)
        assembly.switch(f"{contact.name}: delta = 0", deflection, 0)
        return contact.preload * contact.law.load(deflection)

    def _describe(self, assembly: Assembly, contact: Loaded, h: ca.SX, deflection: ca.SX) -> None:
        assembly.output(contact.label("film"), "m", h)
        assembly.output(contact.label("deflection"), "m", contact.delta0 * ca.fmax(deflection, 0))
        assembly.output(contact.label("cavity"), "m", contact.delta0 * ca.fmax(-deflection, 0))
