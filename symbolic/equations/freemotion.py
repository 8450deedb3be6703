"""A model let go: no excitation, and a negative damping of its inertia that keeps its free vibration up.

With M the mass matrix, each equation of motion M q'' + ... = f has the force xi M q' besides (Krack 2015,
extended periodic motion): free vibrations of a damped model are periodic at one xi = 2 D omega for each
amplitude, D the damping ratio.
"""

from __future__ import annotations

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.excitation import Excitation, Order
from symbolic.equations.variables import Parameter

DAMPING = "modal damping"
"""Name of the parameter xi (1/s)."""

SIZE = "modal amplitude"
"""Name of the parameter that a condition may compare an amplitude with; no equation has it."""

KINETIC = "twice the kinetic energy"
"""Name of the output q' M q' (J): times xi it is the power that xi puts in, and the model dissipates."""


class Silence(Excitation):
    """An excitation of no amplitude: its harmonics are zero, and its angle stands still."""

    def wave(self, order: Order = 1) -> tuple[ca.SX, ca.SX]:
        """Return zeros."""
        return ca.SX(0), ca.SX(0)

    def theta(self, order: Order = 1) -> ca.SX:
        """Return zero."""
        return ca.SX(0)


def let_go(assembly: Assembly) -> None:
    """Add xi M q' to the forces of a model whose parts have all spoken, and twice the kinetic energy.

    M is all that multiplies accelerations: with q'' - xi q' in place of q'' each row has xi M q' besides.

    Parameters
    ----------
    assembly : Assembly
        The workbench of the model.

    Raises
    ------
    ValueError
        For a model with parameters of these names.
    """
    for name in (DAMPING, SIZE):
        if name in assembly.parameters:
            raise ValueError(
                f"parameter {name!r} has the name that free vibrations need; it must have another"
            )
    if not assembly.motions:
        raise ValueError("the model has no coordinates with masses; it must have some for its modes")
    xi = assembly.parameter(Parameter(DAMPING, 0.0, "1/s"), DAMPING, "1/s")
    assembly.parameter(Parameter(SIZE, 0.0), SIZE)
    motions = list(assembly.motions.values())
    rates = ca.vertcat(ca.SX(0, 1), *(motion.velocity.derivative for motion in motions))
    speeds = ca.vertcat(ca.SX(0, 1), *(motion.velocity.symbol for motion in motions))
    later, twice = rates - xi / assembly.omega * speeds, ca.SX(0)
    for motion in motions:
        own = xi * assembly.omega * motion.mass * motion.velocity.symbol
        coupled = ca.substitute(motion.force, rates, later) - motion.force
        motion.force += own + coupled
        twice += assembly.omega * motion.velocity.symbol * ca.jacobian(own + coupled, xi)
    assembly.output(KINETIC, "J", twice)
