"""The angular frequency omega = dtau/dt of the phase, as a function of a model's parameters."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.equations.expressions import Expressions
from symbolic.equations.variables import Variable
from symbolic.interrupts import interruptible


@dataclass(frozen=True, eq=False)
class AngularFrequency:
    """omega(p) in rad/s, d/dt = omega d/dtau, and the parameters that it is proportional to.

    Parameters
    ----------
    expressions : Expressions
        omega and the parameters p.
    parameters : sequence of Variable
        Their names and nominal values.
    """

    expressions: Expressions
    parameters: Sequence[Variable]

    @cached_property
    def _function(self) -> ca.Function:
        return ca.Function("frequency", [self.expressions.parameter], [self.expressions.frequency])

    @cached_property
    @interruptible()
    def _slope(self) -> ca.Function:
        e = self.expressions
        return ca.Function("slope", [e.parameter], [ca.jacobian(e.frequency, e.parameter)])

    @cached_property
    @interruptible()
    def _plain(self) -> tuple[float, Array] | None:
        """omega = a + b . p with its a and b, where it is so."""
        e, count = self.expressions, len(self.parameters)
        if any(ca.which_depends(e.frequency, e.parameter, 2, True)):
            return None
        none = np.zeros(count)
        return float(self._called(self._function, none)[0]), self._called(self._slope, none)

    @staticmethod
    @interruptible()
    def _called(function: ca.Function, parameter: Array) -> Array:
        return np.array(function(parameter)).ravel()

    def omega(self, parameter: Array) -> float:
        """Return omega at parameters (p,)."""
        if self._plain is None:
            return float(self._called(self._function, parameter)[0])
        begun, slope = self._plain
        used = np.flatnonzero(slope)
        return begun + float(slope[used] @ parameter[used])

    def gradient(self, parameter: Array) -> Array:
        """Return d omega / dp, shape (p,)."""
        if self._plain is not None:
            return self._plain[1].copy()
        return self._called(self._slope, parameter)

    @cached_property
    @interruptible()
    def product(self) -> tuple[tuple[str, ...], float, dict[str, float]]:
        """Parameters that omega is proportional to, the factor, and the nominal values of all others."""
        used = ca.jacobian(self.expressions.frequency, self.expressions.parameter).sparsity().get_col()
        there = np.linspace(0.7, 2.3, len(self.parameters))
        names = []
        for k in used:
            twice = np.where(np.arange(len(there)) == k, 2.0, 1.0) * there
            if math.isclose(self.omega(twice), 2 * self.omega(there), rel_tol=1e-13):
                names.append(k)
        unit = np.array([1.0 if k in names else p.value for k, p in enumerate(self.parameters)])
        held = {self.parameters[k].name: self.parameters[k].value for k in used if k not in names}
        factor = self.omega(unit) if names else 1.0
        return tuple(self.parameters[k].name for k in names), factor, held
