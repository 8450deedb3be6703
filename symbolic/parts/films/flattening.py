"""What a film leaves of a waviness that rolls through its contact: amplitude reduction.

Of the amplitude A_i of a wave of length lambda the film keeps A_d as a ripple of its own thickness; only the
rest, A_i - A_d, compresses the bodies:

    circular contact  A_d/A_i = 1/(1 + 0.15 n + 0.015 n^2),    n = (lambda/a) (M/L)^(1/2)
    line contact      A_d/A_i = 1/(1 + 0.125 n + 0.04 n^2),    n = (lambda/b) M^(3/4)/L^(1/2)

with Moes' groups M, L and the half-width a or b of Hertz' contact in the rolling direction.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Value
from symbolic.parts.contact.pair import ContactPair, junction_of
from symbolic.parts.films.line import line_moes
from symbolic.parts.films.regimes import moes
from symbolic.parts.films.regressions import Compliance, Rolling


class AmplitudeReduction(Protocol):
    """A law for the part of a waviness that stays in the film."""

    def ripple(self, assembly: Assembly, load: ca.SX, wavelength: ca.SX) -> ca.SX:
        """Return A_d/A_i.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.
        load : casadi.SX
            Steady load in N.
        wavelength : casadi.SX
            lambda in m.

        Returns
        -------
        casadi.SX
            Between 0 and 1.
        """
        ...


@dataclass(frozen=True)
class PointReduction(AmplitudeReduction):
    """A_d/A_i = 1/(1 + 0.15 n + 0.015 n^2), n = (lambda/a) (M/L)^(1/2): made for circular contacts.

    a is the half-width of Hertz' ellipse in the rolling direction (Hamrock and Brewe's approximation).

    Parameters
    ----------
    rolling : Rolling
        The bodies and their lubricant.

    References
    ----------
    .. [1] C. H. Venner, A. A. Lubrecht, Trans. ASME J. Tribol. 116 (1994) 186-192.
    .. [2] B. J. Hamrock, D. Brewe, Trans. ASME J. Lubr. Technol. 105 (1983) 171-177.
    """

    rolling: Rolling

    def ripple(self, assembly: Assembly, load: ca.SX, wavelength: ca.SX) -> ca.SX:
        """Return A_d/A_i."""
        groups = self.rolling.groups(assembly, load, Compliance.REDUCED)
        crown = assembly.parameter(self.rolling.crown, "crown_radius", "m")
        ratio = groups.length / crown
        reduced = groups.length / (1 + ratio)
        integral = 1.0003 + 0.5968 * ratio
        forced = 6 * integral * load * reduced * groups.compliance / (math.pi * ratio ** (-2 / math.pi))
        half_width = forced ** (1 / 3)
        log_m, log_l, _ = moes(self.rolling, assembly, load)
        n = wavelength / half_width * ca.exp((log_m - log_l) / 2)
        return 1 / (1 + 0.15 * n + 0.015 * n**2)


@dataclass(frozen=True)
class LineReduction(AmplitudeReduction):
    """A_d/A_i = 1/(1 + 0.125 n + 0.04 n^2), n = (lambda/b) M^(3/4)/L^(1/2), b = (8 W R/(pi E' l))^(1/2).

    Parameters
    ----------
    rolling : Rolling
        The bodies and their lubricant.
    length : float or Parameter
        Length l of the line in m.

    References
    ----------
    .. [1] C. H. Venner, F. Couhier, A. A. Lubrecht, J. A. Greenwood, Proc. 23rd Leeds-Lyon Symp. on Tribology
       (1997) 285-297.
    """

    rolling: Rolling
    length: Value

    def ripple(self, assembly: Assembly, load: ca.SX, wavelength: ca.SX) -> ca.SX:
        """Return A_d/A_i."""
        groups = self.rolling.groups(assembly, load, Compliance.REDUCED)
        line = assembly.parameter(self.length, "length", "m")
        half_width = ca.sqrt(8 * load * groups.length * groups.compliance / (math.pi * line))
        log_m, log_l = line_moes(self.rolling, self.length, assembly, load)
        n = wavelength / half_width * ca.exp(0.75 * log_m - 0.5 * log_l)
        return 1 / (1 + 0.125 * n + 0.04 * n**2)


@dataclass(frozen=True)
class FlattenedWaviness(Part):
    """Takes from the waviness of a contact the part A_d that the film keeps: A_i - A_d compresses.

    Parameters
    ----------
    pair : ContactPair
        The contact, with its waviness and preload.
    law : AmplitudeReduction
        A_d/A_i.
    radius : float or Parameter
        Radius of the wavy disc in m.
    waves : float or Parameter
        Waves around it; lambda = 2 pi radius/waves.
    """

    pair: ContactPair
    law: AmplitudeReduction
    radius: Value
    waves: Value

    def contribute(self, assembly: Assembly) -> None:
        """Set the reduction."""
        wavelength = 2 * math.pi * assembly.parameter(self.radius, "radius", "m")
        wavelength /= assembly.parameter(self.waves, "waves")
        junction_of(assembly, self.pair).ripple = lambda load: self.law.ripple(assembly, load, wavelength)
