"""Regressions of elastohydrodynamic film thickness.

They use the groups of Mehdigoli et al. (1990), eq. (6), with a compliance E_x:

    U* = eta0 u E_x / R_x,   G* = alpha / E_x,   W* = Q E_x / R_x^2,   e_p* = 1.03 (R_y/R_x)^0.64   (eq. 2)
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Value
from symbolic.parts.contact.pair import Loaded
from symbolic.parts.films.thickness import entraining_speed

STEEL_MODULUS, STEEL_POISSON = 207e9, 0.3
"""Young's modulus (Pa) and Poisson's ratio of steel; the paper gives neither."""

CROWN_RADIUS = 0.102
"""Radius in m to which one disc is crowned (Mehdigoli et al. 1990, section 2.1)."""


class Compliance(Enum):
    """E_x as a multiple of (1 - nu^2)/E for two bodies of one material.

    ONE_BODY is how the paper's list of symbols reads, (1 - nu^2)/(pi E) (its print is poor); TWO_BODY sums
    it over both discs, as Hertz theory does; REDUCED is 1/E' of Hamrock & Dowson.
    """

    ONE_BODY = 1 / math.pi
    TWO_BODY = 2 / math.pi
    REDUCED = 1.0


@dataclass(frozen=True)
class Groups:
    """Logarithms of U*, G* and W*, the reduced radius R_x in m, E_x in 1/Pa and the ellipticity e_p*."""

    log_u: ca.SX
    log_g: ca.SX
    log_w: ca.SX
    length: ca.SX
    compliance: ca.SX
    ellipticity: ca.SX


@dataclass(frozen=True)
class Rolling:
    """Two equal steel discs, one of them crowned, and their lubricant: what the regressions need.

    Parameters
    ----------
    speed : float or Parameter
        Speed of rotation in rad/s.
    radius : float or Parameter
        Radius of the discs in m; R_x = radius/2.
    viscosity : float or Parameter
        eta0 in Pa s.
    piezoviscosity : float or Parameter
        alpha in m^2/N.
    crown : float or Parameter
        Radius R_y of the crown in m.
    modulus : float or Parameter
        Young's modulus in Pa.
    poisson : float or Parameter
        Poisson's ratio.
    """

    speed: Value
    radius: Value
    viscosity: Value
    piezoviscosity: Value
    crown: Value = CROWN_RADIUS
    modulus: Value = STEEL_MODULUS
    poisson: Value = STEEL_POISSON

    def reduced_radius(self, assembly: Assembly) -> ca.SX:
        """Return R_x in m.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.

        Returns
        -------
        casadi.SX
            Half the radius of the discs.
        """
        return assembly.parameter(self.radius, "radius", "m") / 2

    def groups(self, assembly: Assembly, load: ca.SX, compliance: Compliance) -> Groups:
        """Return the dimensionless groups under a load.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.
        load : casadi.SX
            Q in N.
        compliance : Compliance
            Which compliance the groups use.

        Returns
        -------
        Groups
            U*, G*, W*, and what goes with them.
        """
        u = entraining_speed(assembly, self.speed, self.radius)
        eta = assembly.parameter(self.viscosity, "viscosity", "Pa s")
        alpha = assembly.parameter(self.piezoviscosity, "piezoviscosity", "m^2/N")
        crown = assembly.parameter(self.crown, "crown_radius", "m")
        modulus = assembly.parameter(self.modulus, "modulus", "Pa")
        e_x = compliance.value * (1 - assembly.parameter(self.poisson, "poisson") ** 2) / modulus
        r_x = self.reduced_radius(assembly)
        return Groups(
            log_u=ca.log(eta * u * e_x / r_x),
            log_g=ca.log(alpha / e_x),
            log_w=ca.log(load * e_x / r_x**2),
            length=r_x,
            compliance=e_x,
            ellipticity=1.03 * (crown / r_x) ** 0.64,
        )


@dataclass(frozen=True)
class RegressionThickness:
    """h0 = R_x 0.112 U*^0.625 G*^0.46 W*^-0.045 exp(0.076 e_p*), the paper's regression without squeeze.

    Legible in the copy that we have: 0.112, G's 0.46, W's 0.045, 123 (squeeze) and 0.076. Assumed: U's
    exponent, of which only "0.", a 5 and perhaps an 8 or a 5 can be made out; 0.625 is what the exponent
    13.9 in the paper's K gives over beta = 22.23.

    Parameters
    ----------
    rolling : Rolling
        Discs and lubricant.
    compliance : Compliance
        Which compliance the groups use.
    speed_exponent : float or Parameter
        U*'s exponent.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), eqs. (5) and (6).
    """

    rolling: Rolling
    compliance: Compliance = Compliance.ONE_BODY
    speed_exponent: Value = 0.625

    def thickness(self, assembly: Assembly, contact: Loaded, beta: ca.SX) -> ca.SX:
        """Return h0 in m."""
        g = self.rolling.groups(assembly, contact.preload, self.compliance)
        exponent = assembly.parameter(self.speed_exponent, "speed_exponent")
        powers = exponent * g.log_u + 0.46 * g.log_g - 0.045 * g.log_w
        return g.length * 0.112 * ca.exp(powers + 0.076 * g.ellipticity)


@dataclass(frozen=True)
class ConstantThickness:
    """h0 = (K/Q)^(1/beta), with K as the paper prints it.

        K = 0.112^beta U*^13.9 G*^10.2 R_x^(beta + 2) exp(54.85 + 1.6 e_p*) / E_x

    Assumed: the last digit of G's exponent (10.2 is 0.46 beta), and that "fl + 2" is the exponent
    beta + 2 of R_x, without which K has not the unit N m^beta. exp(54.85) has no counterpart in eq. (5).

    Parameters
    ----------
    rolling : Rolling
        Discs and lubricant.
    compliance : Compliance
        Which compliance the groups use.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), under eq. (13).
    """

    rolling: Rolling
    compliance: Compliance = Compliance.ONE_BODY

    def thickness(self, assembly: Assembly, contact: Loaded, beta: ca.SX) -> ca.SX:
        """Return h0 in m."""
        g = self.rolling.groups(assembly, contact.preload, self.compliance)
        log_k = beta * ca.log(0.112) + 13.9 * g.log_u + 10.2 * g.log_g + (beta + 2) * ca.log(g.length)
        log_k += 54.85 + 1.6 * g.ellipticity - ca.log(g.compliance)
        return ca.exp((log_k - ca.log(contact.preload)) / beta)


@dataclass(frozen=True)
class HamrockDowsonThickness:
    """h0 = R_x 3.63 U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68 k)), the minimum film of a fully flooded contact.

    The groups use E_x = 1/E' = (1 - nu^2)/E; k is the ellipticity e_p*.

    Parameters
    ----------
    rolling : Rolling
        Discs and lubricant.

    References
    ----------
    Hamrock & Dowson, Trans. ASME J. Lubr. Technol. 99 (1977) 264-276, doi:10.1115/1.3453074.
    """

    rolling: Rolling

    def thickness(self, assembly: Assembly, contact: Loaded, beta: ca.SX) -> ca.SX:
        """Return h0 in m."""
        g = self.rolling.groups(assembly, contact.preload, Compliance.REDUCED)
        powers = ca.exp(0.68 * g.log_u + 0.49 * g.log_g - 0.073 * g.log_w)
        return g.length * 3.63 * powers * (1 - ca.exp(-0.68 * g.ellipticity))
