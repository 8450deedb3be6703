"""What loads a coordinate at rest: where parts with play begin the search for an equilibrium."""

from __future__ import annotations

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.variables import Coordinate


def steady_force(assembly: Assembly, coordinate: Coordinate) -> ca.SX:
    """Return the force on a coordinate, as laid so far, with all states zero and nothing excited."""
    symbols = [s for state in assembly.states for s in (state.symbol, state.derivative)]
    zeroed = ca.vertcat(*symbols, assembly.excitation.symbols, assembly.excitation.angle)
    return ca.substitute(assembly.motion(coordinate).force, zeroed, ca.SX.zeros(zeroed.size1()))
