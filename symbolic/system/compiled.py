"""A compiled model: what it is made of, its linear part, its surfaces and its flow."""

from __future__ import annotations

import ctypes
import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from symbolic.arrays import Array
from symbolic.checks import numbers, one_of, refusal, typed
from symbolic.equations.surfaces import Surface
from symbolic.equations.tex.rows import equations
from symbolic.equations.variables import Variable
from symbolic.integration.ensembles.ensemble import Ensemble, code
from symbolic.integration.field import VectorField
from symbolic.integration.flow import Flow, Trajectory
from symbolic.integration.sensitivity import SensitiveFlow, Sensitivities
from symbolic.interrupts import interruptible
from symbolic.kernels import native
from symbolic.kernels.choice import Kernels
from symbolic.structures.linearpart import Held, LinearPart, Modes
from symbolic.structures.rowspart import RowsPart
from symbolic.system.angularfrequency import AngularFrequency
from symbolic.system.evaluated import Evaluated
from symbolic.system.kinds import releases, surfaces
from symbolic.system.overview import overview
from symbolic.system.written import Written, written
from symbolic.tables import listed

CONDENSED_FROM, STATES_PER_PLACE = 40, 20
"""A linear part is condensed unasked from so many states on, with a place in so many at the most."""

KINKED_FROM, KINKED_PER_PLACE = 12, 10
"""The same where motion has kinks, which excite modes far faster than the motion."""


@dataclass(frozen=True, eq=False, repr=False)
class CompiledSystem(Evaluated):
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

    def let_go(self) -> CompiledSystem:
        """Return the system without excitation, its vibration kept up: see `periodic.system.Releasable`.

        Raises
        ------
        ValueError
            For a system that was not compiled from a model.
        """
        recipe = getattr(self.recipe, "let_go", None)
        if recipe is None:
            raise ValueError(
                "the system was not compiled from a model, and has no masses; it must be for its modes"
            )
        found: CompiledSystem = recipe()
        return found

    @cached_property
    def slides(self) -> dict[int, tuple[int, int]]:
        """Of each jump along which motions can slide, and of sliders, the switches at which that ends."""
        return releases(self.expressions, len(self.switches))

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """What happens where the switches vanish; each of them belongs to one surface."""
        return surfaces(self.expressions, self.switches, [each.name for each in self.parameters])

    @cached_property
    def written(self) -> Written:
        """The equations as text: see `periodic.system.written`. Raises ValueError where there is none."""
        return written(self.expressions)

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

    def ensemble(self, parameter: Array, tolerance: float, largest: float) -> Ensemble | None:
        """Follow many motions at once: see `periodic.system.Ensembling`. None without a compiler."""
        found = self._motions
        return None if found is None else Ensemble(self, parameter, tolerance, largest, found)

    @cached_property
    @interruptible()
    def _motions(self) -> ctypes.CDLL | None:
        """The loaded library of the system's motions."""
        return None if self.kernels is Kernels.NUMPY else native.attempted(code(self))

    @cached_property
    def field(self) -> VectorField:
        """The rates, and the integrators along them."""
        return VectorField(self.expressions)

    @cached_property
    def _flow(self) -> SensitiveFlow:
        return SensitiveFlow(self, self.move)


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
