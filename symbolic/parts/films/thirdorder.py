"""A contact with a squeeze film as one differential equation of the third order in the film thickness h.

Mehdigoli et al. (1990) eliminate everything but h (their eq. 17). The film law gives the deflection as a
function of h and h' = dh/dtau, geometry then the displacement,

    F(delta(h, h')) = Q (h/h0)^(-beta) exp(-gamma omega h'),
    X(h, h', tau) = delta0 + h - h0 + w(tau) - delta(h, h'),

and two derivatives of X along the motion put into mu omega^2 X'' = W - Q (mu the reduced mass of the discs)
leave h''' as the highest derivative. CasADi takes the derivatives; the paper's functions psi_1 to psi_4 are
what they come to.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Model, Part
from symbolic.equations.terms import Motion, State
from symbolic.equations.variables import Coordinate
from symbolic.parts.contact.pair import Junction, Loaded
from symbolic.parts.films.squeeze import LEVELS, SqueezeFilm, constants

REFUSED = "the third-order form is of one coordinate and one contact with a squeeze film"


@dataclass(frozen=True)
class ThirdOrder(Part):
    """A model of one coordinate and one contact with a SqueezeFilm, with h, h', h'' as its only states.

    The coefficient of h''' is gamma W/F'(delta): it vanishes where contact is lost. Compiling any other model
    raises ValueError.

    Parameters
    ----------
    model : Model
        Inertia, preload, law, waviness and SqueezeFilm.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), eq. (17).
    """

    model: Model

    def contribute(self, assembly: Assembly) -> None:
        """Let the parts say what they have to say, then eliminate the coordinate."""
        inner = Assembly(assembly.excitation, assembly.numbers, assembly.sketch, assembly.omega)
        inner.lay(self.model.parts)
        coordinate, junction, film = _sole(inner)
        reduced = _Reduced(film, [])
        junction.film = reduced
        inner.close()
        assembly.states.extend(reduced.states)
        _eliminate(assembly, inner, coordinate, reduced)


@dataclass
class _Reduced:
    """The film whose load is a function of h and h'; `geometry` vanishes where X fits it."""

    film: SqueezeFilm
    states: list[State]
    geometry: ca.SX | None = None

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Add h, h', h'' and the outputs. Returns W."""
        film = self.film
        beta, gamma, h0 = constants(film, assembly, contact)
        scale, zero, name = assembly.nominal(contact.delta0), ca.SX(0), contact.label("h")
        self.states = [
            assembly.state(name + "'" * order, "m", scale, zero if order else h0) for order in range(3)
        ]
        h, rate = self.states[0].symbol, self.states[1].symbol
        log_load = -beta * ca.log(h / h0) - gamma * assembly.omega * rate
        relative = ca.exp(contact.law.log_deflection(log_load))
        self.geometry = contact.delta0 * (1 - relative) + h - h0 + contact.compression
        assembly.output(contact.label("film"), "m", h)
        assembly.output(contact.label("deflection"), "m", contact.delta0 * relative)
        assembly.switch(f"{contact.name}: lift-off", relative, -1, LEVELS)
        return contact.preload * ca.exp(log_load)


def _sole(inner: Assembly) -> tuple[Coordinate, Junction, SqueezeFilm]:
    """Return the coordinate, the contact and its film. Raises ValueError unless there is just one of each."""
    if len(inner.motions) != 1 or len(inner.joints) != 1 or len(inner.states) != 2:
        raise ValueError(REFUSED)
    (coordinate,), (junction,) = inner.motions, inner.joints.values()
    if not isinstance(junction, Junction) or type(junction.film) is not SqueezeFilm:
        raise ValueError(REFUSED)
    if junction.pair.coordinates != (coordinate,):
        raise ValueError(REFUSED)
    return coordinate, junction, junction.film


def _eliminate(assembly: Assembly, inner: Assembly, coordinate: Coordinate, reduced: _Reduced) -> None:
    """Add the rows h' , h'' and eq. (17), and the outputs, with X and its derivatives put in."""
    motion: Motion = inner.motions[coordinate]
    position, velocity = motion.position.symbol, motion.velocity.symbol
    assert reduced.geometry is not None
    # Geometry reads (what is left without X) - X = 0.
    displacement = ca.substitute(reduced.geometry, position, ca.SX(0))
    speed = _along(inner, reduced.states, displacement)
    acceleration = _along(inner, reduced.states, speed)

    def reduced_to_h(expression: ca.SX) -> ca.SX:
        return ca.substitute(expression, ca.vertcat(position, velocity), ca.vertcat(displacement, speed))

    inertia = motion.mass * inner.omega**2
    row = inertia * acceleration - reduced_to_h(motion.force)
    scale = reduced.states[0].scale
    for lower, higher in zip(reduced.states, reduced.states[1:], strict=False):
        assembly.differential_rows.append((lower.derivative - higher.symbol) / scale)
    assembly.differential_rows.append(row / (inner.nominal(inertia) * scale))
    assembly.output(coordinate.name, coordinate.unit, displacement)
    for variable, expression in inner.outputs:
        assembly.output(variable.name, variable.unit, reduced_to_h(expression))
    for info, expression in inner.switches:
        assembly.switch(info.name, expression, info.direction, info.levels)
    assembly.smooth.extend(inner.smooth)


def _along(inner: Assembly, states: list[State], expression: ca.SX) -> ca.SX:
    """Return the total derivative d/dtau of an expression in h, h', h'' and the phase."""
    symbols = [state.symbol for state in states]
    rates = [state.symbol for state in states[1:]] + [states[-1].derivative]
    return inner.excitation.along(expression, ca.vertcat(*symbols), ca.vertcat(*rates))
