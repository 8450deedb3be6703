"""Films of line contacts: rollers, cylinders, gear teeth."""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Value
from symbolic.parts.films.law import FilmLaw
from symbolic.parts.films.regressions import Compliance, Rolling


@dataclass(frozen=True)
class LineFilm(FilmLaw):
    """Central film of an elastohydrodynamic line contact, h = 3.06 R U^0.69 G^0.56 W'^-0.10.

    U = eta0 u/(E' R), G = alpha E', W' = W/(E' R l), u the mean speed of the surfaces. The crown of
    `rolling` does not matter here.

    Parameters
    ----------
    rolling : Rolling
        The bodies and their lubricant.
    length : float or Parameter
        Length l of the line in m.

    References
    ----------
    .. [1] D. Dowson, S. Toyoda, Proc. 5th Leeds-Lyon Symp. on Tribology (1979) 60-65.
    """

    rolling: Rolling
    length: Value

    def thickness(self, assembly: Assembly, load: ca.SX) -> ca.SX:
        """Return h in m."""
        log_u, log_g, log_w = line_groups(self.rolling, self.length, assembly, load)
        powers = ca.exp(0.69 * log_u + 0.56 * log_g - 0.10 * log_w)
        return self.rolling.reduced_radius(assembly) * 3.06 * powers


def line_groups(
    rolling: Rolling, length: Value, assembly: Assembly, load: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Return ln U, ln G and ln W' of a line contact under a load in N."""
    groups = rolling.groups(assembly, load, Compliance.REDUCED)
    line = assembly.parameter(length, "length", "m")
    return groups.log_u, groups.log_g, groups.log_w + ca.log(groups.length / line)


def line_moes(rolling: Rolling, length: Value, assembly: Assembly, load: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Return ln M and ln L of a line contact: M = W' U^(-1/2), L = G U^(1/4), U with u1 + u2."""
    log_u, log_g, log_w = line_groups(rolling, length, assembly, load)
    log_u += math.log(2)
    return log_w - log_u / 2, log_g + log_u / 4
