"""A film of any law with squeeze, in series with the elastic contact.

    h = H(W) exp(-s (dh/dt)/u),

H(W) the steady thickness under the load that the film carries at this moment, u the entraining speed. With
H = h0 (W/Q)^(-1/beta) it is the squeeze film of `symbolic.parts.films.squeeze` with gamma u = s beta.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Value
from symbolic.parts.contact.pair import FilmPart, Loaded
from symbolic.parts.films.law import FilmLaw
from symbolic.parts.films.softplus import REST_XI, log_softplus, move_xi, softplus
from symbolic.parts.films.squeeze import LEVELS, describe
from symbolic.parts.films.thickness import entraining_speed


@dataclass(frozen=True)
class LubricantFilm(FilmPart):
    """Film of any law with squeeze, h = H(W) exp(-s (dh/dt)/u): one state h and one unknown xi.

    Parameters
    ----------
    pair : ContactPair
        The contact.
    law : FilmLaw
        H(W).
    speed : float or Parameter
        Speed of rotation in rad/s.
    radius : float or Parameter
        Radius of the discs in m; u = radius speed.
    squeeze : float or Parameter
        s, dimensionless and positive: 123 for point contacts (Mostofi 1981), 96.775 for lines.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), eqs. (5) and (6).
    """

    law: FilmLaw
    speed: Value
    radius: Value
    squeeze: Value = 123.0

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Rows: film law for xi, geometry for h. Returns W."""
        squeeze = assembly.parameter(self.squeeze, "squeeze")
        if not assembly.nominal(squeeze) > 0:
            raise ValueError(f"squeeze is {assembly.nominal(squeeze):g}; it must be a positive number")
        u = entraining_speed(assembly, self.speed, self.radius)
        h0 = self.law.thickness(assembly, contact.preload)
        h = assembly.state(contact.label("h"), "m", assembly.nominal(contact.delta0), h0)
        xi = assembly.algebraic(contact.label("xi"), ca.SX(REST_XI), move_xi)
        deflection = 1 + (h.symbol - h0 + contact.compression) / contact.delta0
        log_load = contact.law.log_load(log_softplus(xi))
        steady = self.law.thickness(assembly, contact.preload * ca.exp(log_load))
        squeezed = squeeze / u * assembly.omega * h.derivative
        assembly.algebraic_rows.append(ca.log(h.symbol) - ca.log(steady) + squeezed)
        assembly.differential_rows.append(softplus(xi) - deflection)
        describe(assembly, contact, h.symbol, xi)
        assembly.switch(f"{contact.name}: lift-off", deflection, -1, LEVELS)
        return contact.preload * ca.exp(log_load)
