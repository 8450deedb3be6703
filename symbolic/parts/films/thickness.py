"""Laws for the steady thickness h0 of the film under the preload Q.

A film knows its law only through h0: the law's own numbers enter nowhere else.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Value
from symbolic.parts.contact.pair import Loaded
from symbolic.parts.films.law import FilmLaw


class ThicknessLaw(Protocol):
    """A law for the steady film thickness."""

    def thickness(self, assembly: Assembly, contact: Loaded, beta: ca.SX) -> ca.SX:
        """Return h0.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.
        contact : Loaded
            The contact under its preload.
        beta : casadi.SX
            Exponent of the film's stiffness.

        Returns
        -------
        casadi.SX
            Steady thickness in m, an expression in the model's parameters.
        """
        ...


def entraining_speed(assembly: Assembly, speed: Value, radius: Value) -> ca.SX:
    """u = radius * speed in m/s."""
    return assembly.parameter(radius, "radius", "m") * assembly.parameter(speed, "speed", "rad/s")


@dataclass(frozen=True)
class GivenThickness:
    """h0 itself as a parameter of the model: the same at every speed.

    Parameters
    ----------
    h0 : float or Parameter
        Steady thickness in m.
    """

    h0: Value

    def thickness(self, assembly: Assembly, contact: Loaded, beta: ca.SX) -> ca.SX:
        """Return h0 in m."""
        return assembly.parameter(self.h0, "h0", "m")


@dataclass(frozen=True)
class SteadyThickness:
    """h0 = H(Q) of a film law: its thickness under the preload; the film's own law does the rest.

    Parameters
    ----------
    law : FilmLaw
        H(W).
    """

    law: FilmLaw

    def thickness(self, assembly: Assembly, contact: Loaded, beta: ca.SX) -> ca.SX:
        """Return h0 in m."""
        return self.law.thickness(assembly, contact.preload)


@dataclass(frozen=True)
class CalibratedThickness:
    """h0 = 3.85 um (u/1.92265)^0.625 (eta0/0.890)^0.625 (alpha/25.9e-9)^0.46 (Q/810)^(-1/beta).

    Exponents of Mostofi & Gohar's regression as used by Mehdigoli et al. (1990), fixed by the film that
    the paper prints at 360 rev/min, 810 N, Shell Vitrea 79.

    Parameters
    ----------
    speed : float or Parameter
        Speed of rotation in rad/s.
    radius : float or Parameter
        Radius of the discs in m; u = radius speed.
    viscosity : float or Parameter
        eta0 in Pa s.
    piezoviscosity : float or Parameter
        alpha in m^2/N.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), eq. (5).
    """

    speed: Value
    radius: Value
    viscosity: Value
    piezoviscosity: Value

    def thickness(self, assembly: Assembly, contact: Loaded, beta: ca.SX) -> ca.SX:
        """Return h0 in m."""
        u = entraining_speed(assembly, self.speed, self.radius)
        eta = assembly.parameter(self.viscosity, "viscosity", "Pa s")
        alpha = assembly.parameter(self.piezoviscosity, "piezoviscosity", "m^2/N")
        rolling = (u / 1.92265) ** 0.625 * (eta / 0.890) ** 0.625
        return 3.85e-6 * rolling * (alpha / 25.9e-9) ** 0.46 * (contact.preload / 810) ** (-1 / beta)
