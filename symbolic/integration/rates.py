"""The differential-algebraic equations as an explicit ODE.

Rows without any derivative are constraints. Differentiated once in tau they give, with the other rows, a
linear system for the rates of states and unknowns alike,

    M(y) y' = b(y, tau, p),   y = (x, z),

an explicit ODE that keeps the constraints constant. Where contact is lost a constraint hardly depends on its
unknown and the ODE would be stiff without bound: its derivative in the unknown is raised by SENSITIVITY, so
that the unknown relaxes to its quasi-steady value within that time.
"""

from __future__ import annotations

import casadi as ca

from symbolic.equations.expressions import Expressions

SENSITIVITY = 1e-8
"""Added to the derivative, which is positive, of each constraint in its unknown."""


def constraint_rows(e: Expressions) -> list[int]:
    """Return the indices of the rows without any derivative."""
    pattern = ca.jacobian(e.residual, e.rate)
    return [i for i in range(e.residual.size1()) if pattern[i, :].nnz() == 0]


def explicit_rates(e: Expressions, sensitivity: float = SENSITIVITY) -> ca.SX:
    """Return (x', z') as an expression in states, unknowns, phase and parameters.

    Raises ValueError for a condensed system, and for rows that are not linear in x'.
    """
    if any(e.residual[i].is_zero() for i in range(e.residual.size1())):
        raise ValueError("the system's linear part is condensed; time integration needs condense=False")
    constraints, rate = constraint_rows(e), ca.SX.sym("algebraic_rate", e.algebraic.size1())
    rows = []
    for i in range(e.residual.size1()):
        row = e.residual[i]
        if i in constraints:
            row = (
                ca.jtimes(row, e.state, e.rate)
                + ca.jtimes(row, e.algebraic, rate)
                + ca.jacobian(row, e.phase)
            )
            row += sensitivity * rate[constraints.index(i)]
        rows.append(row)
    rates, stacked = ca.vertcat(e.rate, rate), ca.vertcat(*rows)
    if ca.depends_on(ca.jacobian(stacked, rates), rates):
        raise ValueError("the rows of the system are not linear in its rates; time integration needs them so")
    rest = ca.substitute(stacked, rates, ca.SX.zeros(rates.size1()))
    return ca.solve(ca.jacobian(stacked, rates), -rest)


def ode(e: Expressions) -> dict[str, ca.SX]:
    """Return the ODE of y = (x, z) as CasADi's integrators take it."""
    return {"x": ca.vertcat(e.state, e.algebraic), "t": e.phase, "p": e.parameter, "ode": explicit_rates(e)}
