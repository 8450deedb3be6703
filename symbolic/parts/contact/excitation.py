"""Corrugations of a surface, which excite a contact."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Value
from symbolic.parts.contact.pair import ContactPair, junction_of


@dataclass(frozen=True)
class Waviness(Part):
    """Corrugation a sin(tau) of one surface, tau = waves speed t.

    Parameters
    ----------
    pair : ContactPair
        The contact.
    amplitude : float or Parameter
        a in m.
    waves : float or Parameter
        Number of waves around the disc.
    speed : float or Parameter
        Speed of rotation in rad/s.
    """

    pair: ContactPair
    amplitude: Value
    waves: Value
    speed: Value

    def contribute(self, assembly: Assembly) -> None:
        """Add the profile and set the frequency of the excitation."""
        amplitude = assembly.parameter(self.amplitude, "amplitude", "m")
        waves = assembly.parameter(self.waves, "waves")
        assembly.excite(waves * assembly.parameter(self.speed, "speed", "rad/s"))
        junction = junction_of(assembly, self.pair)
        junction.profile += amplitude * assembly.sine
        junction.wave = (amplitude, round(assembly.nominal(waves)))


@dataclass(frozen=True)
class RampedWaviness(Part):
    """Corrugation a sin(tau) from tau0 on, tau = waves speed t; before it the ramp B exp(rate t).

    Height and slope are continuous: B exp(rate t0) = a sin(tau0) and tan(tau0) = omega/rate, so that
    tau0 = atan(omega/rate).

    Parameters
    ----------
    pair : ContactPair
        The contact.
    amplitude : float or Parameter
        a in m.
    waves : float or Parameter
        Number of waves around the disc.
    speed : float or Parameter
        Speed of rotation in rad/s.
    rate : float or Parameter
        Rate of the ramp in 1/s.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), section 5, eqs. (18) and (19), with rate = 1/s.
    """

    pair: ContactPair
    amplitude: Value
    waves: Value
    speed: Value
    rate: Value = 1.0

    def contribute(self, assembly: Assembly) -> None:
        """Add the profile and set the frequency of the excitation."""
        amplitude = assembly.parameter(self.amplitude, "amplitude", "m")
        waves = assembly.parameter(self.waves, "waves")
        omega = waves * assembly.parameter(self.speed, "speed", "rad/s")
        rate = assembly.parameter(self.rate, "ramp_rate", "1/s")
        assembly.excite(omega)
        joint = ca.atan(omega / rate)
        since = assembly.phase - joint
        ramp = ca.sin(joint) * ca.exp(ca.fmin(since, 0) * rate / omega)
        junction_of(assembly, self.pair).profile += amplitude * ca.if_else(since < 0, ramp, assembly.sine)
