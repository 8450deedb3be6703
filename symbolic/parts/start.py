"""What a step-by-step calculation of the wavy disc starts from, and the film in the form that it steps.

Mehdigoli et al. (1990), section 5: before the sinusoid the surface rises as an exponential, joined to it with
equal height and slope. The film's deflection is taken from geometry, so that the equations are explicit.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.assembly import Assembly
from symbolic.model import Part
from symbolic.parts.contact import ContactPair, Loaded, junction_of
from symbolic.parts.film import SqueezeFilm, constants
from symbolic.variables import Value


@dataclass(frozen=True)
class RampedWaviness(Part):
    """Corrugation a sin(tau) from tau0 on, tau = omega t; before it the ramp B exp(rate t) of section 5.

    Height and slope are continuous: B exp(rate t0) = a sin(tau0) and tan(tau0) = omega/rate (eqs. 18, 19; the
    paper has rate = 1/s), so tau0 = atan(omega/rate). a in m, speed in rad/s, rate in 1/s.
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


@dataclass(frozen=True)
class ExplicitSqueezeFilm(SqueezeFilm):
    """The film W = Q (h/h0)^(-beta) exp(-gamma dh/dt) without an algebraic unknown.

    delta/delta0 = 1 + (h - h0 + g)/delta0 is put into gamma dh/dt = -beta ln(h/h0) - n ln(delta/delta0).
    Not a number where delta <= 0: no solution goes there, but a step that is too long does.
    """

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Row: the film law for h. Returns W."""
        beta, gamma, h0 = constants(self, assembly, contact)
        h = assembly.state(contact.label("h"), "m", assembly.nominal(contact.delta0), h0)
        relative = 1 + (h.symbol - h0 + contact.compression) / contact.delta0
        log_load = contact.exponent * ca.log(relative)
        squeeze = gamma * assembly.omega * h.derivative
        assembly.differential_rows.append(log_load + beta * ca.log(h.symbol / h0) + squeeze)
        assembly.output(contact.label("film"), "m", h.symbol)
        assembly.output(contact.label("deflection"), "m", contact.delta0 * relative)
        return contact.preload * ca.exp(log_load)
