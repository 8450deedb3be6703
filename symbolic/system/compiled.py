"""A compiled model: residual, derivatives, outputs and switches at N points at a time, and its flow."""

from __future__ import annotations

import ctypes
import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.checks import numbers, one_of, refusal, typed
from symbolic.equations.expressions import Expressions
from symbolic.equations.surfaces import Surface, surfaces
from symbolic.equations.tex.rows import equations
from symbolic.equations.variables import SwitchInfo, Variable
from symbolic.integration.field import VectorField
from symbolic.integration.flow import Flow, Trajectory
from symbolic.integration.sensitivity import SensitiveFlow, Sensitivities
from symbolic.kernels.choice import Kernels
from symbolic.kernels.second import Gradient, Symbols, contraction
from symbolic.structures.linearpart import Held, LinearPart, Modes
from symbolic.structures.rowspart import RowsPart
from symbolic.system.angularfrequency import AngularFrequency
from symbolic.system.generated import Generated
from symbolic.system.overview import overview
from symbolic.tables import listed

CONDENSED_FROM, STATES_PER_PLACE = 40, 20
"""A linear part is condensed unasked from so many states on, with a place in so many at the most."""

KINKED_FROM, KINKED_PER_PLACE = 12, 10
"""The same where motion has kinks, which excite modes far faster than the motion."""


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
class CompiledSystem:
    """A model ready for `periodic`: see `periodic.system.System` for the protocol it fulfils.

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
    held : tuple of Held
        Places of condensed structures.
    part : RowsPart, optional
        The linear part of a model that was split.
    origin : CompiledSystem, optional
        That model.
    splitting : callable, optional
        What splits the system, or tells why it cannot.
    recipe : callable, optional
        What compiles it again: how it is pickled. CasADi's expressions and loaded libraries stay behind.
    sketch : tuple of dict
        How it looks: see `symbolic.sketch`.
    """

    states: tuple[Variable, ...]
    algebraics: tuple[Variable, ...]
    parameters: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    switches: tuple[SwitchInfo, ...]
    expressions: Expressions = field(repr=False)
    kernels: Kernels = Kernels.NUMPY
    held: tuple[Held, ...] = ()
    part: RowsPart | None = field(default=None, repr=False)
    origin: CompiledSystem | None = field(default=None, repr=False)
    splitting: Callable[[CompiledSystem], CompiledSystem] | None = field(default=None, repr=False)
    recipe: Callable[[], CompiledSystem] | None = field(default=None, repr=False)
    sketch: tuple[Mapping[str, object], ...] = field(default=(), repr=False)

    def __repr__(self) -> str:
        groups = {name: listed(v.name for v in some) for name, some in self._groups.items() if some}
        return f"CompiledSystem({'; '.join(f'{name} {names}' for name, names in groups.items())})"

    @property
    def _groups(self) -> dict[str, tuple[Variable, ...]]:
        return {
            "states": self.states,
            "unknowns": self.algebraics,
            "parameters": self.parameters,
            "outputs": self.outputs,
        }

    def _repr_html_(self) -> str:
        return overview(self.latex, self._groups, self.switches)

    @property
    def latex(self) -> str:
        """The equations of the model that was compiled, SI, as LaTeX; empty where none is known."""
        parts = getattr(self.recipe, "parts", None)
        return equations(parts) if parts else ""

    def __reduce__(self) -> tuple[Callable[[], CompiledSystem], tuple[()]]:
        if self.recipe is None:
            raise pickle.PicklingError(
                "system has no model to be compiled from again; it must come from symbolic.compile"
            )
        return self.recipe, ()

    @cached_property
    def _angular_frequency(self) -> AngularFrequency:
        return AngularFrequency(self.expressions, self.parameters)

    @property
    def frequency(self) -> tuple[str, ...]:
        """Names of the parameters whose product is omega (rad/s) but for a factor; () if it is none."""
        return self._angular_frequency.product[0]

    @property
    def frequency_factor(self) -> float:
        """What the product of the parameters `frequency` is multiplied by to be omega."""
        return self._angular_frequency.product[1]

    @property
    def frequency_held(self) -> dict[str, float]:
        """Values of other parameters that this factor depends on, by name."""
        return self._angular_frequency.product[2]

    def omega(self, parameter: Array) -> float:
        """Return the frequency of the excitation.

        Parameters
        ----------
        parameter : ndarray, shape (p,)
            p in SI.

        Returns
        -------
        float
            omega in rad/s.
        """
        return self._angular_frequency.omega(parameter)

    @cached_property
    def linear(self) -> LinearPart | RowsPart | None:
        """The linear part of a system that is split: condensed structures, or what was found."""
        if self.part is not None:
            return self.part
        return LinearPart(self.held, self.omega, self._angular_frequency.gradient) if self.held else None

    @property
    def whole(self) -> CompiledSystem:
        """The system that this one was found in; itself where that is none."""
        return self if self.origin is None else self.origin

    @property
    def kept(self) -> tuple[int, ...]:
        """Which of the whole system's states it has."""
        return tuple(range(len(self.states))) if self.part is None else self.part.places

    def everything(self, parameter: Array) -> Modes:
        """Return the linear part's modes with all states of the whole system as outputs."""
        if self.part is None:
            raise ValueError("the system was not found in the equations of another")
        return self.part.everything(parameter)

    def condensed(self, *, always: bool = False) -> CompiledSystem | None:
        """Return the system of the nonlinear places alone: see `periodic.system.Condensable`."""
        least, between = (
            (KINKED_FROM, KINKED_PER_PLACE) if self.switches else (CONDENSED_FROM, STATES_PER_PLACE)
        )
        if not always and len(self.states) < least:
            return None
        found = self._condensed
        if isinstance(found, CompiledSystem):
            return found if always or between * len(found.kept) <= len(self.states) else None
        if always:
            raise ValueError(f"condense is True, but {found}")
        return None

    @cached_property
    def _condensed(self) -> CompiledSystem | str:
        """The same, or why there is none."""
        if self.splitting is None:
            return "the system is condensed already"
        try:
            found = self.splitting(self)
            assert found.part is not None
            found.part.modes(self.nominal)
        except (ValueError, ArithmeticError) as error:
            return str(error)
        return found

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

    @property
    def slides(self) -> dict[int, tuple[int, int]]:
        """Of each jump along which motions can slide, and of sliders, the switches at which that ends."""
        switches = [k for k, *_ in self.expressions.sided.slides]
        first = len(self.switches) - 2 * len(switches) - len(self.expressions.resting)
        found = {k: (first + 2 * i, first + 2 * i + 1) for i, k in enumerate(switches)}
        found |= {k: held.releases for k, held in self.expressions.sliders.items()}
        return dict(sorted(found.items()))

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """What happens where the switches vanish; each of them belongs to one surface."""
        e = self.expressions
        own = (self.switches, self.resets, self.jumps, self.slides, e.sliders)
        leaves = {k: resting.leaves for k, resting in e.resting.items()}
        return surfaces(*own, self._places, e.relays, e.sided.alone, leaves)

    @property
    def _places(self) -> dict[int, tuple[int, tuple[float, ...]]]:
        """Of what may be held all along, the parameter that says where, and the weights of its deflection."""
        names = [parameter.name for parameter in self.parameters]
        return {k: (names.index(name), weights) for k, (name, weights) in self.expressions.places.items()}

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

    def motion(
        self,
        state: Array,
        algebraic: Array,
        parameter: Array,
        phase: Array,
        tolerance: float,
        modes: Sequence[int] | None = None,
    ) -> Trajectory:
        """Integrate, through impacts too: see `periodic.system.Moving`. Raises ArithmeticError."""
        earlier = None if modes is None else tuple(modes)
        return Flow(self, tolerance).run(state, algebraic, parameter, phase, earlier=earlier)

    @cached_property
    def field(self) -> VectorField:
        """The rates, and the integrators along them."""
        return VectorField(self.expressions)

    @cached_property
    def _flow(self) -> SensitiveFlow:
        return SensitiveFlow(self, self.move)

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


def with_values(system: CompiledSystem, values: Mapping[str, float]) -> Array:
    """Return the nominal parameter vector with some values (SI) replaced, by name. Raises ValueError."""
    typed("system", system, CompiledSystem, "a CompiledSystem, as symbolic.compile returns it")
    parameter = system.nominal
    names = [p.name for p in system.parameters]
    for name, value in numbers("values", values, "value").items():
        index = names.index(one_of("parameter", name, names))
        system.parameters[index].check(value)
        parameter[index] = value
    if not (omega := system.omega(parameter)) > 0:
        raise refusal("the frequency of the excitation in rad/s", omega, "greater than 0")
    return parameter
