"""The kernels of a compiled model, called at N points at a time."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.equations.expressions import Expressions
from symbolic.equations.variables import SwitchInfo, Variable
from symbolic.interrupts import interruptible
from symbolic.kernels.choice import Kernels
from symbolic.kernels.second import Gradient, Symbols, contraction
from symbolic.system.generated import Generated


@dataclass(frozen=True)
class Linearisation:
    """Residual and derivatives at N points (n states, m unknowns, q free parameters).

    residual (N, n+m); d_rate, d_state (N, n+m, n); d_algebraic (N, n+m, m); d_phase (N, n+m);
    d_parameter (N, n+m, q). Rows n.. are the algebraic rows. Outputs are linearised in the same shapes.
    """

    residual: Array
    d_rate: Array
    d_state: Array
    d_algebraic: Array
    d_phase: Array
    d_parameter: Array


@dataclass(frozen=True, eq=False, repr=False)
class Evaluated:
    """Residual, outputs, switches and resets of a model, with their derivatives.

    Parameters
    ----------
    states, algebraics, parameters, outputs : tuple of Variable
        The n scaled states x, the m unknowns z, parameters p and outputs (SI).
    switches : tuple of SwitchInfo
        Functions that mark kinks in time.
    expressions : Expressions
        What the kernels are generated from.
    kernels : Kernels
        The back end.
    """

    states: tuple[Variable, ...]
    algebraics: tuple[Variable, ...]
    parameters: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    switches: tuple[SwitchInfo, ...]
    expressions: Expressions = field(repr=False)
    kernels: Kernels = Kernels.NUMPY

    @property
    def nominal(self) -> Array:
        """The parameters' nominal values, shape (parameters,)."""
        return np.array([p.value for p in self.parameters])

    def residual(self, rate: Array, state: Array, algebraic: Array, phase: Array, parameter: Array) -> Array:
        """Return the scaled residual R(x', x, z, tau, p).

        Parameters
        ----------
        rate, state : ndarray, shape (N, n)
            x' and x, scaled.
        algebraic : ndarray, shape (N, m)
            z.
        phase : ndarray, shape (N,)
            tau.
        parameter : ndarray, shape (p,)
            p in SI.

        Returns
        -------
        ndarray, shape (N, n+m)
            The algebraic rows come last.
        """
        result = np.zeros((len(phase), len(self.states) + len(self.algebraics)))
        with np.errstate(all="ignore"):
            self._generated.residual(rate, state, algebraic, phase, parameter, result)
        return result

    def linearise(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...] = (),
    ) -> Linearisation:
        """Return residual and derivatives; `free` are the indices of the parameters to differentiate in."""
        kernel = self._generated.derivatives("residual", free)
        rows = len(self.states) + len(self.algebraics)
        return self._linearised(kernel, rows, free, (rate, state, algebraic, phase, parameter))

    @property
    def jumps(self) -> tuple[int, ...]:
        """Indices of the switches at which the equations jump: see `periodic.system.Jumping`."""
        return self.expressions.sided.jumps

    def linearise_beside(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        side: Array,
        free: tuple[int, ...] = (),
    ) -> Linearisation:
        """Return residual and derivatives on given sides (N, jumps) of the jumps: 1, -1, or 0 as it is."""
        kernel = self._generated.derivatives("beside", free)
        rows = len(self.states) + len(self.algebraics)
        return self._linearised(kernel, rows, free, (rate, state, algebraic, phase, parameter, side))

    def output_gradient(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...] = (),
    ) -> Linearisation:
        """Return the outputs (SI) as `residual`, and their derivatives."""
        kernel = self._generated.derivatives("outputs", free)
        return self._linearised(kernel, len(self.outputs), free, (rate, state, algebraic, phase, parameter))

    @cached_property
    def curvature(self) -> Callable[..., Gradient]:
        """Contracted second derivatives of the residual: see `symbolic.kernels.second.contraction`."""
        e = self.expressions
        return contraction(
            Symbols(e.rate, e.state, e.algebraic, e.phase, e.parameter), e.residual, self.kernels
        )

    def move(self, algebraic: Array, increment: Array) -> Array:
        """Return where Newton increments take the unknowns, both of shape (N, m)."""
        result = np.zeros_like(algebraic)
        with np.errstate(all="ignore"):
            self._generated.move(algebraic, increment, result)
        return result

    def output(self, rate: Array, state: Array, algebraic: Array, phase: Array, parameter: Array) -> Array:
        """Return the outputs in SI units, shape (N, outputs)."""
        result = np.zeros((len(phase), len(self.outputs)))
        with np.errstate(all="ignore"):
            self._generated.output(rate, state, algebraic, phase, parameter, result)
        return result

    @cached_property
    @interruptible()
    def guards_depend(self) -> bool:
        """Whether switches depend on the sides of jumps, as where a joint slips does on its neighbours."""
        e = self.expressions
        return bool(ca.depends_on(e.guards, e.sided.side)) if self.jumps else False

    def switch(self, state: Array, phase: Array, parameter: Array, side: Array | None = None) -> Array:
        """Return the switch functions, shape (N, switches), on sides (N, jumps) of the jumps if given."""
        result = np.zeros((len(phase), len(self.switches)))
        with np.errstate(all="ignore"):
            if side is None or not self.guards_depend:
                self._generated.switch(state, phase, parameter, result)
            else:
                self._generated.guards(state, phase, parameter, side, result)
        return result

    def switch_gradient(
        self, state: Array, phase: Array, parameter: Array, side: Array | None = None
    ) -> tuple[Array, Array, Array]:
        """Return derivatives in state (N, switches, n), phase (N, switches), parameters (N, switches, p)."""
        count, k = len(phase), len(self.switches)
        d_state = np.zeros((count, k, len(self.states)))
        d_phase = np.zeros((count, k))
        d_parameter = np.zeros((count, k, len(self.parameters)))
        columns = _columns(d_state, d_phase, d_parameter)
        with np.errstate(all="ignore"):
            if side is None or not self.guards_depend:
                self._generated.switch_gradient(state, phase, parameter, *columns)
            else:
                self._generated.guards_gradient(state, phase, parameter, side, *columns)
        return d_state, d_phase, d_parameter

    @property
    def resets(self) -> tuple[int, ...]:
        """Indices of the switches whose fall to 0 is an impact: see `periodic.system.Resetting`."""
        return tuple(self.expressions.resets)

    def reset(self, switch: int, state: Array, phase: Array, parameter: Array) -> Array:
        """Return the states after the event of a switch, shape (N, n), from those before it."""
        result = np.zeros_like(state)
        with np.errstate(all="ignore"):
            self._generated.resets[switch](state, phase, parameter, result)
        return result

    def reset_gradient(
        self, switch: int, state: Array, phase: Array, parameter: Array
    ) -> tuple[Array, Array, Array]:
        """Return derivatives of `reset` in state (N, n, n), phase (N, n) and parameters (N, n, p)."""
        count, n = state.shape
        d_state, d_phase = np.zeros((count, n, n)), np.zeros((count, n))
        d_parameter = np.zeros((count, n, len(self.parameters)))
        kernel = self._generated.reset_gradients[switch]
        with np.errstate(all="ignore"):
            kernel(state, phase, parameter, *_columns(d_state, d_phase, d_parameter))
        return d_state, d_phase, d_parameter

    @interruptible()
    def rest(self, parameter: Array) -> tuple[Array, Array]:
        """Return scaled states (n,) and unknowns (m,) near which the unexcited system rests."""
        e = self.expressions
        state, algebraic = ca.Function("rest", [e.parameter], [e.rest_state, e.rest_algebraic])(parameter)
        return np.array(state).ravel(), np.array(algebraic).ravel()

    @cached_property
    def _generated(self) -> Generated:
        return Generated(self.expressions, self.kernels)

    def library(self, source: str) -> ctypes.CDLL | None:
        """Return the loaded library of a C source that serves every system, or None: NumPy is to do."""
        return self._generated.library(source)

    def address(self, kernel: str, free: tuple[int, ...] = ()) -> int | None:
        """Return where a compiled kernel is: see `periodic.system.Compiling`."""
        return self._generated.address(kernel, free)

    def _linearised(
        self, kernel: Callable[..., None], rows: int, free: tuple[int, ...], at: tuple[Array, ...]
    ) -> Linearisation:
        n, m = len(self.states), len(self.algebraics)
        shapes = [(rows,), (rows, n), (rows, n), (rows, m), (rows,), (rows, len(free))]
        arrays = [np.zeros((len(at[3]), *shape)) for shape in shapes]
        with np.errstate(all="ignore"):
            kernel(*at, *_columns(*arrays))
        return Linearisation(*arrays)


def _columns(*arrays: Array) -> list[Array]:
    """The arrays as a kernel writes them: it takes a last axis of one for a column."""
    return [a[:, :, 0] if a.ndim == 3 and a.shape[2] == 1 else a for a in arrays]
