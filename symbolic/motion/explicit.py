"""The rates x' = f(x, tau, p) of a system without algebraic unknowns, for explicit step-by-step methods."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from symbolic.arrays import Array
from symbolic.integration.rates import explicit_rates
from symbolic.interrupts import interruptible
from symbolic.kernels.kernel import batch, build, points, vector
from symbolic.system.compiled import CompiledSystem

Rates = Callable[[Array, Array, Array], Array]
"""(state (N, n), phase (N,), parameter (p,) or (p, N)) to dx/dtau (N, n), scaled.

A parameter array of N columns gives every point parameters of its own. Outside the domain of the equations
the result is not finite.
"""


@interruptible()
def rates(system: CompiledSystem) -> Rates:
    """Return the right-hand side of a system whose residual is linear in x'.

    Raises ValueError for a system with algebraic unknowns.
    """
    if system.algebraics:
        names = ", ".join(unknown.name for unknown in system.algebraics)
        raise ValueError(
            f"the system has the algebraic unknowns {names}; explicit rates need one without any"
        )
    e = system.expressions
    arguments = [batch(e.state, "state"), points(e.phase, "phase"), vector(e.parameter, "parameter")]
    kernel = build(arguments, [explicit_rates(e)], system.kernels)

    def evaluated(state: Array, phase: Array, parameter: Array) -> Array:
        result = np.zeros_like(state)
        with np.errstate(all="ignore"):
            kernel(state, phase, parameter, result)
        return result

    return evaluated
