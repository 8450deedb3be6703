"""What every system has: variables, equations with their derivatives, outputs, switches and a rest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, cast

from periodic.system.arrays import Array


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

    direction -1: only a falling crossing is a kink, +1 a rising one, 0 both. Levels fall; each marks the
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
    def residual(self) -> Array:
        """R, shape (N, n+m)."""

    @property
    def d_rate(self) -> Array:
        """Derivatives in x', shape (N, n+m, n)."""

    @property
    def d_state(self) -> Array:
        """Derivatives in x, shape (N, n+m, n)."""

    @property
    def d_algebraic(self) -> Array:
        """Derivatives in z, shape (N, n+m, m)."""

    @property
    def d_phase(self) -> Array:
        """Derivatives in tau, shape (N, n+m)."""

    @property
    def d_parameter(self) -> Array:
        """Derivatives in the free parameters, shape (N, n+m, q)."""


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
