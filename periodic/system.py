"""The whole boundary between the engine and a model: what `periodic` asks of a system.

    R(x', x, z, tau, p) = 0,   ' = d/dtau

n differential rows and m algebraic rows, n states x and m unknowns z, N points at a time; x and z are
scaled to order one. A forced system has period 2 pi in tau. Any object with these members will do; a
hand-written NumPy class is as good as a compiled model.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import Protocol, cast

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


class VariableLike(Protocol):
    """Name, unit, SI value of one internal unit, and (parameters) the nominal value."""

    @property
    def name(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def scale(self) -> float: ...
    @property
    def value(self) -> float: ...


class Checked(VariableLike, Protocol):
    """A parameter that may not have every value."""

    def check(self, value: float) -> None:
        """Refuse a value (SI). Raises ValueError, in one sentence."""


def check_value(parameter: VariableLike, value: float) -> None:
    """Refuse a value (SI) that a parameter may not have. Raises ValueError."""
    if hasattr(parameter, "check"):
        cast(Checked, parameter).check(value)


class SwitchLike(Protocol):
    """A function s(x, tau, p) that has a kink in time where it passes one of its `levels`.

    direction -1: only a falling passage is a kink, +1 a rising one, 0 both. Levels fall; each marks the
    same kink more sharply than the one before, as long as s goes that far below it.
    """

    @property
    def name(self) -> str: ...
    @property
    def direction(self) -> int: ...
    @property
    def levels(self) -> tuple[float, ...]: ...


class LinearisationLike(Protocol):
    """Residual (N, n+m) and its derivatives; the m algebraic rows come last."""

    @property
    def residual(self) -> Array: ...
    @property
    def d_rate(self) -> Array: ...
    @property
    def d_state(self) -> Array: ...
    @property
    def d_algebraic(self) -> Array: ...
    @property
    def d_phase(self) -> Array: ...
    @property
    def d_parameter(self) -> Array: ...


class System(Protocol):
    """The equations R(x', x, z, tau, p) = 0 of a model, its outputs and its switches.

    Shapes: rate, state (N, n); algebraic (N, m); phase (N,); parameter (p,).
    """

    @property
    def states(self) -> Sequence[VariableLike]:
        """The n states x."""

    @property
    def algebraics(self) -> Sequence[VariableLike]:
        """The m algebraic unknowns z."""

    @property
    def parameters(self) -> Sequence[VariableLike]:
        """The parameters p."""

    @property
    def outputs(self) -> Sequence[VariableLike]:
        """The outputs, as `output` gives them."""

    @property
    def switches(self) -> Sequence[SwitchLike]:
        """The switches, as `switch` gives them."""

    @property
    def nominal(self) -> Array:
        """Nominal parameter values, shape (p,)."""

    def linearise(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...] = (),
    ) -> LinearisationLike:
        """Return the residual R(x', x, z, tau, p) and its derivatives.

        Parameters
        ----------
        rate, state : ndarray, shape (N, n)
            dx/dtau and x, scaled.
        algebraic : ndarray, shape (N, m)
            Unknowns z, scaled.
        phase : ndarray, shape (N,)
            tau in rad.
        parameter : ndarray, shape (p,)
            Parameters in SI units.
        free : tuple of int
            Indices of the parameters to differentiate in: d_parameter has one column for each.

        Returns
        -------
        LinearisationLike
            Residual (N, n+m) and its derivatives: d_phase (N, n+m), the others (N, n+m, columns).
        """

    def move(self, algebraic: Array, increment: Array) -> Array:
        """Return where Newton increments take the unknowns: their sum, or a better-behaved way to it.

        Parameters
        ----------
        algebraic, increment : ndarray, shape (N, m)
            Unknowns and their increments, scaled.

        Returns
        -------
        ndarray, shape (N, m)
            The new unknowns.
        """

    def output(self, rate: Array, state: Array, algebraic: Array, phase: Array, parameter: Array) -> Array:
        """Return the outputs.

        Parameters
        ----------
        rate, state, algebraic, phase, parameter : ndarray
            As in `linearise`.

        Returns
        -------
        ndarray, shape (N, outputs)
            Outputs in SI units.
        """

    def switch(self, state: Array, phase: Array, parameter: Array) -> Array:
        """Return the switch functions s(x, tau, p).

        Parameters
        ----------
        state, phase, parameter : ndarray
            As in `linearise`.

        Returns
        -------
        ndarray, shape (N, switches)
            Their values, in the units of their levels.
        """

    def switch_gradient(self, state: Array, phase: Array, parameter: Array) -> tuple[Array, Array, Array]:
        """Return the derivatives of the switch functions.

        Parameters
        ----------
        state, phase, parameter : ndarray
            As in `linearise`.

        Returns
        -------
        d_state : ndarray, shape (N, switches, n)
            In the states.
        d_phase : ndarray, shape (N, switches)
            In tau.
        d_parameter : ndarray, shape (N, switches, p)
            In all parameters.
        """

    def rest(self, parameter: Array) -> tuple[Array, Array]:
        """Return the rest from which the search for a first orbit starts.

        Parameters
        ----------
        parameter : ndarray, shape (p,)
            Parameters in SI units.

        Returns
        -------
        state : ndarray, shape (n,)
            States, scaled.
        algebraic : ndarray, shape (m,)
            Unknowns, scaled.
        """


class GradientLike(Protocol):
    """A gradient at N points: rate, state (N, n), algebraic (N, m), phase (N,), parameter (N, p)."""

    @property
    def rate(self) -> Array: ...
    @property
    def state(self) -> Array: ...
    @property
    def algebraic(self) -> Array: ...
    @property
    def phase(self) -> Array: ...
    @property
    def parameter(self) -> Array: ...


class Differentiable(System, Protocol):
    """A system with derivatives of its outputs and second derivatives: asked for by curves of special points.

    `curvature` gives gradients of w . (R_x' v_x' + R_x v_x + R_z v_z + R_p v_p), at fixed weights w (N, n+m)
    and directions v; v_p has shape (p,).
    """

    def output_gradient(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...] = (),
    ) -> LinearisationLike:
        """Outputs in SI units as `residual`, and their derivatives."""

    @property
    def curvature(self) -> Callable[..., GradientLike]:
        """(x', x, z, tau, p, w, v_x', v_x, v_z, v_p) -> gradient."""


def differentiable(system: System) -> Differentiable:
    """Return the system as one with second derivatives. Raises ValueError if it has none."""
    missing = [n for n in ("output_gradient", "curvature") if not hasattr(system, n)]
    if missing:
        raise ValueError(
            f"system is a {type(system).__name__} without {', '.join(missing)}; this needs a Differentiable "
            f"one (symbolic.compile makes one of a model)"
        )
    return cast(Differentiable, system)


class FlowLike(Protocol):
    """A trajectory at K phases: state (K, n), algebraic (K, m), and their derivatives in the first state and
    then in the free parameters, state_gradient (K, n, n+q), algebraic_gradient (K, m, n+q).
    """

    @property
    def state(self) -> Array: ...
    @property
    def algebraic(self) -> Array: ...
    @property
    def state_gradient(self) -> Array: ...
    @property
    def algebraic_gradient(self) -> Array: ...


class Flowing(System, Protocol):
    """A system that can also integrate itself in time, which shooting needs."""

    def flow(
        self,
        state: Array,
        algebraic: Array,
        parameter: Array,
        phase: Array,
        free: tuple[int, ...],
        tolerance: float,
    ) -> FlowLike:
        """Integrate from `state` (n,) at phase[0] to all of `phase` (K,), which rises.

        algebraic (m,) is a guess of the unknowns at phase[0]; `free` are the parameters to differentiate in;
        tolerance is relative and absolute. Raises ArithmeticError where the integration fails.
        """


class TrajectoryLike(Protocol):
    """A trajectory at K phases, phase (K,): state (K, n), algebraic (K, m)."""

    @property
    def phase(self) -> Array: ...
    @property
    def state(self) -> Array: ...
    @property
    def algebraic(self) -> Array: ...


class Moving(System, Protocol):
    """A system that can be followed in time, through impacts too."""

    def motion(
        self, state: Array, algebraic: Array, parameter: Array, phase: Array, tolerance: float
    ) -> TrajectoryLike:
        """Integrate from `state` (n,) at phase[0] to all of `phase` (K,), which rises.

        algebraic (m,) is a guess of the unknowns at phase[0]; tolerance is relative and absolute. The
        trajectory has two points of one phase at each impact, with the states before and after it. Raises
        ArithmeticError where the integration fails.
        """


class Resetting(System, Protocol):
    """A system with impacts: the state is mapped, x+ = r(x-, tau, p), where some switches pass their level.

    Of these switches the level is 0 and the direction -1 or 1. Between events they keep to the side that they
    come from; r leads back to it.
    """

    @property
    def resets(self) -> Sequence[int]:
        """Indices of these switches."""

    def reset(self, switch: int, state: Array, phase: Array, parameter: Array) -> Array:
        """Return the states after the event.

        Parameters
        ----------
        switch : int
            Index of the switch.
        state : ndarray, shape (N, n)
            x-, before the event.
        phase, parameter : ndarray
            As in `linearise`.

        Returns
        -------
        ndarray, shape (N, n)
            x+, scaled.
        """

    def reset_gradient(
        self, switch: int, state: Array, phase: Array, parameter: Array
    ) -> tuple[Array, Array, Array]:
        """Return the derivatives of `reset`.

        Parameters
        ----------
        switch, state, phase, parameter
            As in `reset`.

        Returns
        -------
        d_state : ndarray, shape (N, n, n)
            In the states before the event.
        d_phase : ndarray, shape (N, n)
            In tau.
        d_parameter : ndarray, shape (N, n, p)
            In all parameters.
        """


class Jumping(System, Protocol):
    """A system whose equations jump where some of its switches vanish, as dry friction does.

    Their level is 0 and their direction 0. It may have `slides` too: of those jumps along which a motion can
    slide (stick, for friction) the indices of two further switches: ds/dtau by the equations of its positive
    side, and by those of its negative side. It slides where the first is negative and the second positive;
    a rise of the first ends that with a positive switch s, a fall of the second with a negative one.
    """

    @property
    def jumps(self) -> Sequence[int]:
        """Indices of these switches."""

    def linearise_beside(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        side: Array,
        free: tuple[int, ...] = (),
    ) -> LinearisationLike:
        """Return what `linearise` does, on given sides of the jumps.

        Parameters
        ----------
        rate, state, algebraic, phase, parameter, free
            As in `linearise`.
        side : ndarray, shape (N, jumps)
            1 for the equations of a positive switch, -1 for those of a negative one, continued beyond its
            zero; 0 where the state decides; 2 for those of sliding.

        Returns
        -------
        LinearisationLike
            Residual and its derivatives.
        """


def jumps_of(system: System) -> tuple[int, ...]:
    """Return the indices of the switches at which the equations jump; none of most systems."""
    return tuple(getattr(system, "jumps", ()))


def slides_of(system: System) -> dict[int, tuple[int, int]]:
    """Return the switches of both releases of each jump along which motions can slide."""
    return dict(getattr(system, "slides", {}))


def resets_of(system: System) -> tuple[int, ...]:
    """Return the indices of the switches at which the state is mapped; none of most systems."""
    return tuple(getattr(system, "resets", ()))


class Compiling(System, Protocol):
    """A system with a C compiler, which then serves the engine too: its small systems are solved in C."""

    def library(self, source: str) -> ctypes.CDLL | None:
        """The loaded library of a C source, the same one each time; None where NumPy is to do."""

    def address(self, kernel: str, free: tuple[int, ...] = ()) -> int | None:
        """The address of linearise (in the parameters `free`), move, switch, switch_gradient or output in C.

        Each is a function of the number of points, then of arguments and results in order, as contiguous
        arrays; of the results structural nonzeros alone are written. None where NumPy is to do. A system
        that has `library` may be without it.
        """


class Timed(System, Protocol):
    """A system that tells how its phase runs in time, d/dt = Omega d/dtau."""

    @property
    def frequency(self) -> Sequence[str]:
        """Names of the parameters whose product is the angular frequency Omega (rad/s).

        A system may have `frequency_factor` too, by which that product is then multiplied, and
        `frequency_held`, values by name of other parameters on which that factor depends: it is right at
        these alone.
        """


class ModesLike(Protocol):
    """Modes: dz/dtau = exponents z + inputs f, x = Re outputs z + direct f + direct_rate df/dtau.

    J modes, k forces f, s states x: exponents (J,), inputs (J, k), outputs (s, J), complex; one of each
    conjugate pair stands for both. direct, direct_rate (s, k). All scaled.
    """

    @property
    def exponents(self) -> Complex: ...
    @property
    def inputs(self) -> Complex: ...
    @property
    def outputs(self) -> Complex: ...
    @property
    def direct(self) -> Array: ...
    @property
    def direct_rate(self) -> Array: ...


class LinearPart(Protocol):
    """The linear part of a system that is split, x_L = L f: any number of states behind a few places.

    `states` are the indices of the states that it gives, `forces` those of the unknowns that act on it. The
    system's own rows say nothing of these states: as many of its n differential rows are empty. `velocities`
    are those of them in which all modes are heard.
    """

    @property
    def states(self) -> tuple[int, ...]: ...
    @property
    def velocities(self) -> tuple[int, ...]: ...
    @property
    def forces(self) -> tuple[int, ...]: ...
    @property
    def size(self) -> int:
        """Number of its states."""

    def modes(self, parameter: Array) -> ModesLike:
        """Its modes at parameters (p,). Raises ArithmeticError where they do not span its motion."""

    def slope(self, parameter: Array, index: int) -> ModesLike | None:
        """Their derivative in a parameter; None where they do not depend on it."""

    def observed(self, parameter: Array, freedoms: Sequence[int] | None, structure: str | None) -> ModesLike:
        """Its modes with displacement and velocity (SI) of degrees of freedom (None: all) as `outputs`."""


class Split(System, Protocol):
    """A system whose linear part is given by its modes."""

    @property
    def linear(self) -> LinearPart | None:
        """The linear part; None of a system that is not split."""


class Within(Split, Protocol):
    """A split system that was found in the equations of another: its states are some of that one's."""

    @property
    def whole(self) -> System:
        """The other system, with all states."""

    @property
    def kept(self) -> tuple[int, ...]:
        """Which of the whole system's states it has. Of the unknowns it has these first, then its forces."""

    def everything(self, parameter: Array) -> ModesLike:
        """The modes with all states of the whole system as outputs."""


class Condensable(System, Protocol):
    """A system whose linear part may be found in its equations."""

    def condensed(self, *, always: bool = False) -> Within | None:
        """Return the system of its nonlinear places alone, None where that does not pay.

        With `always` also where it does not pay. Raises ValueError then, in one sentence, where it cannot be.
        """


def linear_of(system: System) -> LinearPart | None:
    """Return the linear part of a system that is split, None of any other."""
    return cast(Split, system).linear if hasattr(system, "linear") else None


def frequency_of(system: System) -> tuple[str, ...]:
    """Return the names of the parameters whose product is Omega; none where the system does not tell."""
    return tuple(cast(Timed, system).frequency) if hasattr(system, "frequency") else ()


def frequency_factor_of(system: System) -> float:
    """Return what the product of the parameters `frequency_of` is multiplied by to be Omega."""
    return float(getattr(system, "frequency_factor", 1.0))


def frequency_held_of(system: System) -> dict[str, float]:
    """Return the values of parameters (SI) at which alone `frequency_factor_of` is right, by name."""
    return dict(getattr(system, "frequency_held", {}))


def compiling(system: System) -> Compiling | None:
    """Return the system as one with a compiler, if it has one."""
    return cast(Compiling, system) if hasattr(system, "library") else None


def address_of(system: System, kernel: str, free: tuple[int, ...] = ()) -> int | None:
    """Return where a system's compiled kernel is, see `Compiling`; None where NumPy is to do."""
    return cast(Compiling, system).address(kernel, free) if hasattr(system, "address") else None


def check_system(system: object) -> None:
    """Raise ValueError for what is no system, such as a model that is not compiled."""
    missing = [name for name in ("states", "parameters", "linearise", "rest") if not hasattr(system, name)]
    if missing or isinstance(system, type):
        raise ValueError(
            f"system is a {type(system).__name__} without {', '.join(missing)}; it must be a System "
            f"(symbolic.compile makes one of a model)"
        )


def index_of(system: System, parameter: str) -> int:
    """Return the index of a parameter. Raises ValueError for a name that is none."""
    names = [p.name for p in system.parameters]
    if parameter not in names:
        raise ValueError(f"parameter is {parameter!r}; it must be one of {', '.join(names)}")
    return names.index(parameter)
