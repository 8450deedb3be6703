"""The force of a short cavitated film about a journal: pressure acts where it is positive, over half of it.

With the film h = c (1 - x cos theta - y sin theta), (x, y) the displacement over the clearance c, Reynolds'
equation of a short bearing (length L, radius R) gives per unit of angle the pressure

    p = mu L^3/(2 h^3) (A cos(theta - theta_m)),   A e^{i theta_m} = (Omega y + 2 x') + i (2 y' - Omega x)

over c^2, positive within a quarter turn of theta_m. Its resultant comes from one integral J, differentiated
twice: with psi = theta - theta_m and (a, b) the displacement along and across theta_m,

    J = int dpsi/(1 - a cos psi - b sin psi) over (-pi/2, pi/2)
      = 2/D [atan((1 + a - b)/D) + atan((1 + a + b)/D)],   D^2 = 1 - a^2 - b^2,
    int cos^2 psi/(h/c)^3 = J_aa/2,   int cos psi sin psi/(h/c)^3 = J_ab/2.
"""

from __future__ import annotations

import casadi as ca

from symbolic.parts.rotors.radius import radius


def resultant(
    x: ca.SX, y: ca.SX, x_dot: ca.SX, y_dot: ca.SX, turn: ca.SX, pace: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """Return the force on the journal over mu R L^3/(2 c^2).

    x, y and their rates are over the clearance, turn is Omega; pace, in rad/s, is what speeds compare with.
    """
    along, across = turn * y + 2 * x_dot, 2 * y_dot - turn * x
    size = radius(along, across, pace)
    cosine, sine = along / size, across / size
    a, b = ca.SX.sym("a"), ca.SX.sym("b")
    root = ca.sqrt(1 - a**2 - b**2)
    integral = 2 / root * (ca.atan((1 + a - b) / root) + ca.atan((1 + a + b) / root))
    by_a = ca.jacobian(integral, a)
    both = ca.vertcat(ca.jacobian(by_a, a), ca.jacobian(by_a, b)) / 2
    place = ca.vertcat(x * cosine + y * sine, y * cosine - x * sine)
    radial, tangential = ca.vertsplit(ca.substitute(both, ca.vertcat(a, b), place))
    return (
        -size * (radial * cosine - tangential * sine),
        -size * (radial * sine + tangential * cosine),
    )
