"""A model becomes a System: scaled residual, exact derivatives and outputs, evaluated in batch.

Residual rows, with x the scaled states, z the algebraic unknowns and ' = d/dtau:

    q_i' - v_i = 0,    m omega^2 v_i' - sum of forces = 0,    rows of the parts' own states,    0 = g
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from symbolic.assembly import Assembly
from symbolic.choice import Kernels, chosen, shared
from symbolic.kernel import Argument, batch, build, points, vector
from symbolic.model import Model, Part
from symbolic.parts.contact import Junction
from symbolic.second import Gradient, Symbols, contraction
from symbolic.sensitivity import SensitiveFlow, Sensitivities
from symbolic.variables import SwitchInfo, Variable

Array = NDArray[np.float64]


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


@dataclass(frozen=True)
class Expressions:
    """The scaled symbolic system: what the kernels are generated from.

    `waved` are residual and outputs in terms of the symbols `waves` (sin tau, cos tau) of the excitation.
    """

    rate: ca.SX
    state: ca.SX
    algebraic: ca.SX
    phase: ca.SX
    parameter: ca.SX
    residual: ca.SX
    unexcited: ca.SX
    waves: ca.SX
    waved: ca.SX
    frequency: ca.SX
    outputs: ca.SX
    switches: ca.SX
    rest_state: ca.SX
    rest_algebraic: ca.SX
    increment: ca.SX
    moved: ca.SX


@dataclass(frozen=True, eq=False)
class CompiledSystem:
    """A model ready for `periodic`: see `periodic.system.System` for the protocol it fulfils."""

    states: tuple[Variable, ...]
    algebraics: tuple[Variable, ...]
    parameters: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    switches: tuple[SwitchInfo, ...]
    expressions: Expressions = field(repr=False)
    kernels: Kernels = Kernels.NUMPY
    _jacobians: dict[tuple[int, ...], Callable[..., None]] = field(default_factory=dict, repr=False)
    _gradients: dict[tuple[int, ...], Callable[..., None]] = field(default_factory=dict, repr=False)
    _libraries: dict[str, ctypes.CDLL | None] = field(default_factory=dict, repr=False)

    @property
    def nominal(self) -> Array:
        """The parameters' nominal values, shape (parameters,)."""
        return np.array([p.value for p in self.parameters])

    def residual(self, rate: Array, state: Array, algebraic: Array, phase: Array, parameter: Array) -> Array:
        """Return the scaled residual, shape (N, n+m)."""
        result = np.zeros((len(phase), len(self.states) + len(self.algebraics)))
        with np.errstate(all="ignore"):
            self._residual_kernel(rate, state, algebraic, phase, parameter, result)
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
        kernel = self._derivatives(self._jacobians, self.expressions.residual, free)
        rows = len(self.states) + len(self.algebraics)
        return self._linearised(kernel, rows, free, (rate, state, algebraic, phase, parameter))

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
        kernel = self._derivatives(self._gradients, self.expressions.outputs, free)
        return self._linearised(kernel, len(self.outputs), free, (rate, state, algebraic, phase, parameter))

    @cached_property
    def curvature(self) -> Callable[..., Gradient]:
        """Contracted second derivatives of the residual: see `symbolic.second.contraction`."""
        e = self.expressions
        return contraction(
            Symbols(e.rate, e.state, e.algebraic, e.phase, e.parameter), e.residual, self.kernels
        )

    def move(self, algebraic: Array, increment: Array) -> Array:
        """Return where Newton increments take the unknowns, both of shape (N, m)."""
        result = np.zeros_like(algebraic)
        with np.errstate(all="ignore"):
            self._move_kernel(algebraic, increment, result)
        return result

    def output(self, rate: Array, state: Array, algebraic: Array, phase: Array, parameter: Array) -> Array:
        """Return the outputs in SI units, shape (N, outputs)."""
        result = np.zeros((len(phase), len(self.outputs)))
        with np.errstate(all="ignore"):
            self._output_kernel(rate, state, algebraic, phase, parameter, result)
        return result

    def switch(self, state: Array, phase: Array, parameter: Array) -> Array:
        """Return the switch functions, shape (N, switches)."""
        result = np.zeros((len(phase), len(self.switches)))
        with np.errstate(all="ignore"):
            self._switch_kernel(state, phase, parameter, result)
        return result

    def switch_gradient(self, state: Array, phase: Array, parameter: Array) -> tuple[Array, Array, Array]:
        """Return derivatives in state (N, switches, n), phase (N, switches), parameters (N, switches, p)."""
        count, k = len(phase), len(self.switches)
        d_state = np.zeros((count, k, len(self.states)))
        d_phase = np.zeros((count, k))
        d_parameter = np.zeros((count, k, len(self.parameters)))
        with np.errstate(all="ignore"):
            self._switch_gradient_kernel(state, phase, parameter, *_columns(d_state, d_phase, d_parameter))
        return d_state, d_phase, d_parameter

    def flow(
        self,
        state: Array,
        algebraic: Array,
        parameter: Array,
        phase: Array,
        free: tuple[int, ...],
        tolerance: float,
    ) -> Sensitivities:
        """Integrate with sensitivities: see `periodic.system.Flowing`. Raises ArithmeticError."""
        return self._flow.run(state, algebraic, parameter, phase, free, tolerance)

    @cached_property
    def _flow(self) -> SensitiveFlow:
        return SensitiveFlow(self)

    def rest(self, parameter: Array) -> tuple[Array, Array]:
        """Return scaled states (n,) and unknowns (m,) near which the unexcited system rests."""
        e = self.expressions
        state, algebraic = ca.Function("rest", [e.parameter], [e.rest_state, e.rest_algebraic])(parameter)
        return np.array(state).ravel(), np.array(algebraic).ravel()

    @cached_property
    def _arguments(self) -> list[Argument]:
        e = self.expressions
        return [
            batch(e.rate, "rate"),
            batch(e.state, "state"),
            batch(e.algebraic, "algebraic"),
            points(e.phase, "phase"),
            vector(e.parameter, "parameter"),
        ]

    def library(self, source: str) -> ctypes.CDLL | None:
        """Return the loaded library of a C source that serves every system, or None: NumPy is to do."""
        if source not in self._libraries:
            self._libraries[source] = shared(source, self.kernels)
        return self._libraries[source]

    def _build(self, arguments: list[Argument], results: list[ca.SX]) -> Callable[..., None]:
        return build(arguments, results, self.kernels)

    @cached_property
    def _residual_kernel(self) -> Callable[..., None]:
        return self._build(self._arguments, [self.expressions.residual])

    @cached_property
    def _move_kernel(self) -> Callable[..., None]:
        e = self.expressions
        return self._build([batch(e.algebraic, "algebraic"), batch(e.increment, "increment")], [e.moved])

    @cached_property
    def _output_kernel(self) -> Callable[..., None]:
        return self._build(self._arguments, [self.expressions.outputs])

    @cached_property
    def _switch_kernel(self) -> Callable[..., None]:
        _, state, _, phase, parameter = self._arguments
        return self._build([state, phase, parameter], [self.expressions.switches])

    @cached_property
    def _switch_gradient_kernel(self) -> Callable[..., None]:
        _, state, _, phase, parameter = self._arguments
        e = self.expressions
        gradients = [ca.jacobian(e.switches, v) for v in (e.state, e.phase, e.parameter)]
        return self._build([state, phase, parameter], gradients)

    def _derivatives(
        self, known: dict[tuple[int, ...], Callable[..., None]], rows: ca.SX, free: tuple[int, ...]
    ) -> Callable[..., None]:
        """The kernel of some rows and their derivatives, made once for each choice of free parameters."""
        if free not in known:
            e = self.expressions
            chosen = ca.vertcat(ca.SX(0, 1), *[e.parameter[i] for i in free])
            variables = (e.rate, e.state, e.algebraic, e.phase, chosen)
            known[free] = self._build(self._arguments, [rows, *(ca.jacobian(rows, v) for v in variables)])
        return known[free]

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


def compile(model: Model | Part, kernels: Kernels | str | None = None) -> CompiledSystem:  # noqa: A001
    """Return the System of a model, evaluated by the back end `kernels`: see `symbolic.choice`.

    "auto" takes C where there is a compiler and it pays, "numpy" needs none, "c" compiles at once. None is
    the environment's ORBITRACE_KERNELS, or else "auto".

    Raises ValueError, in one sentence, for a model that lacks a part, defines a parameter twice or leaves
    a coordinate without mass, and for an unknown back end; symbolic.native.CompilerError for "c" without a
    working compiler.
    """
    assembly, back_end = Assembly(), chosen(kernels)
    for part in model.parts if isinstance(model, Model) else (model,):
        part.contribute(assembly)
    for junction in assembly.junctions.values():
        assert isinstance(junction, Junction)
        junction.close(assembly)
    return _system(assembly, back_end)


def _motion_rows(assembly: Assembly) -> list[ca.SX]:
    rows: list[ca.SX] = []
    for coordinate, motion in assembly.motions.items():
        inertia = motion.mass * assembly.omega**2
        if motion.mass.is_zero() or not assembly.nominal(motion.mass) > 0:
            raise ValueError(f"coordinate {coordinate.name!r} has no mass; add a Mass on it")
        _check_frequency(assembly)
        scale = assembly.nominal(inertia) * motion.position.scale
        rows.append((motion.position.derivative - motion.velocity.symbol) / motion.position.scale)
        rows.append((inertia * motion.velocity.derivative - motion.force) / scale)
    return rows


def _check_frequency(assembly: Assembly) -> None:
    """Refuse a nominal omega that is not positive; a model without excitation gets omega as a parameter."""
    omega = assembly.nominal(assembly.omega)
    if not 0 < omega < math.inf:
        raise ValueError(
            f"the frequency of the excitation is {omega} rad/s; its nominal value must be greater than 0"
        )


def _system(assembly: Assembly, kernels: Kernels) -> CompiledSystem:
    positions = [motion.position for motion in assembly.motions.values()]
    outputs = [(Variable(x.name, x.unit), x.symbol) for x in positions] + assembly.outputs
    rows = _motion_rows(assembly) + assembly.differential_rows + assembly.algebraic_rows
    _check_frequency(assembly)
    states = assembly.states
    rate, state = ca.SX.sym("rate", len(states)), ca.SX.sym("state", len(states))
    scales = ca.vertcat(*[s.scale for s in states])
    parameters = tuple(assembly.parameters.values())
    packed = ca.SX.sym("parameter", len(parameters))
    unknown = ca.SX.sym("algebraic", len(assembly.unknowns))
    increment = ca.SX.sym("increment", len(assembly.unknowns))

    waves = ca.vertcat(assembly.sine, assembly.cosine)
    circular = ca.vertcat(ca.sin(assembly.phase), ca.cos(assembly.phase))

    def scaled(expressions: list[ca.SX], waved: ca.SX = circular) -> ca.SX:
        stacked = assembly.with_frequency(ca.vertcat(ca.SX(0, 1), *expressions))
        stacked = ca.substitute(stacked, waves, waved)
        old = [s.derivative for s in states] + [s.symbol for s in states]
        old += [u.symbol for u in assembly.unknowns] + [p.symbol for p in parameters]
        new = ca.vertcat(rate * scales, state * scales, unknown, packed)
        return ca.substitute(stacked, ca.vertcat(*old), new)

    expressions = Expressions(
        rate=rate,
        state=state,
        algebraic=unknown,
        phase=assembly.phase,
        parameter=packed,
        residual=scaled(rows),
        unexcited=scaled(rows, ca.SX.zeros(2)),
        waves=waves,
        waved=scaled([*rows, *(expression for _, expression in outputs)], waves),
        frequency=scaled([assembly.omega]),
        outputs=scaled([expression for _, expression in outputs]),
        switches=scaled([expression for _, expression in assembly.switches]),
        rest_state=scaled([s.rest / s.scale for s in states]),
        rest_algebraic=scaled([u.rest for u in assembly.unknowns]),
        increment=increment,
        moved=ca.substitute(
            scaled([u.moved for u in assembly.unknowns]),
            ca.vertcat(*[u.increment for u in assembly.unknowns]),
            increment,
        ),
    )
    return CompiledSystem(
        states=tuple(Variable(s.name, s.unit, s.scale) for s in states),
        algebraics=tuple(Variable(u.name) for u in assembly.unknowns),
        parameters=tuple(Variable(p.name, p.unit, 1.0, p.value) for p in parameters),
        outputs=tuple(variable for variable, _ in outputs),
        switches=tuple(info for info, _ in assembly.switches),
        expressions=expressions,
        kernels=kernels,
    )
