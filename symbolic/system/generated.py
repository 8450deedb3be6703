"""The kernels of a system, each generated when it is first called for."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca

from symbolic.equations.expressions import Expressions
from symbolic.interrupts import interruptible
from symbolic.kernels.choice import ChosenKernel, Kernels, shared
from symbolic.kernels.kernel import Argument, batch, build, points, vector

Kernel = Callable[..., None]

ITERATED_UP_TO = 60
"""Number of states up to which the engine iterates in C."""

ITERATED = {"linearise": "residual", "linearise_beside": "beside"}
"""Methods of a system whose kernels whole iterations then call, and the rows that they evaluate."""


@dataclass(frozen=True, eq=False)
class Generated:
    """Functions of arrays that evaluate a model's expressions at N points at a time.

    Parameters
    ----------
    expressions : Expressions
        What they evaluate.
    choice : Kernels
        The back end.
    """

    expressions: Expressions = field(repr=False)
    choice: Kernels
    _derivatives: dict[tuple[str, tuple[int, ...]], Kernel] = field(default_factory=dict, init=False)
    _addresses: dict[tuple[str, tuple[int, ...]], int] = field(default_factory=dict, init=False)
    _libraries: dict[str, ctypes.CDLL | None] = field(default_factory=dict, init=False)

    def _built(self, arguments: Sequence[Argument], results: list[ca.SX]) -> Kernel:
        return build(list(arguments), results, self.choice)

    @cached_property
    def _arguments(self) -> tuple[Argument, ...]:
        e = self.expressions
        return (
            batch(e.rate, "rate"),
            batch(e.state, "state"),
            batch(e.algebraic, "algebraic"),
            points(e.phase, "phase"),
            vector(e.parameter, "parameter"),
        )

    @property
    def _at_states(self) -> tuple[Argument, ...]:
        _, state, _, phase, parameter = self._arguments
        return state, phase, parameter

    @interruptible()
    def _along_states(self, rows: ca.SX) -> list[ca.SX]:
        e = self.expressions
        return [ca.jacobian(rows, v) for v in (e.state, e.phase, e.parameter)]

    @cached_property
    def residual(self) -> Kernel:
        """Of (rate, state, algebraic, phase, parameter)."""
        return self._built(self._arguments, [self.expressions.residual])

    @cached_property
    def move(self) -> Kernel:
        """Of (algebraic, increment)."""
        e = self.expressions
        return self._built([batch(e.algebraic, "algebraic"), batch(e.increment, "increment")], [e.moved])

    @cached_property
    def output(self) -> Kernel:
        """Of (rate, state, algebraic, phase, parameter)."""
        return self._built(self._arguments, [self.expressions.outputs])

    @cached_property
    def switch(self) -> Kernel:
        """Of (state, phase, parameter)."""
        return self._built(self._at_states, [self.expressions.switches])

    @cached_property
    def switch_gradient(self) -> Kernel:
        """Of (state, phase, parameter), in each of them."""
        return self._built(self._at_states, self._along_states(self.expressions.switches))

    @cached_property
    def guards(self) -> Kernel:
        """The switches of (state, phase, parameter, side), where they depend on the sides of jumps."""
        return self._built([*self._at_states, self._side], [self.expressions.guards])

    @cached_property
    def guards_gradient(self) -> Kernel:
        """Their derivatives in state, phase and parameter."""
        return self._built([*self._at_states, self._side], self._along_states(self.expressions.guards))

    @property
    def _side(self) -> Argument:
        return batch(self.expressions.sided.side, "side")

    @cached_property
    def resets(self) -> dict[int, Kernel]:
        """By switch: the states after its event, of (state, phase, parameter)."""
        return {k: self._built(self._at_states, [after]) for k, after in self.expressions.resets.items()}

    @cached_property
    def reset_gradients(self) -> dict[int, Kernel]:
        """By switch: their derivatives in state, phase and parameter."""
        found = self.expressions.resets.items()
        return {k: self._built(self._at_states, self._along_states(after)) for k, after in found}

    def derivatives(self, name: str, free: tuple[int, ...]) -> Kernel:
        """Return the kernel of some rows and of their derivatives, made once for each choice.

        Parameters
        ----------
        name : str
            "residual", "beside" (the residual on given sides of its jumps) or "outputs".
        free : tuple of int
            Indices of the parameters to differentiate in.

        Returns
        -------
        callable
            Of (rate, state, algebraic, phase, parameter), and the sides.
        """
        if (name, free) not in self._derivatives:
            self._derivatives[name, free] = self._derived(name, free)
        return self._derivatives[name, free]

    @interruptible()
    def _derived(self, name: str, free: tuple[int, ...]) -> Kernel:
        rows, more = self._rows(name)
        e = self.expressions
        chosen = ca.vertcat(ca.SX(0, 1), *[e.parameter[i] for i in free])
        variables = (e.rate, e.state, e.algebraic, e.phase, chosen)
        results = [rows, *(ca.jacobian(rows, v) for v in variables)]
        iterated = name in ITERATED.values() and e.state.numel() <= ITERATED_UP_TO
        return build([*self._arguments, *more], results, self.choice, iterated)

    def _rows(self, name: str) -> tuple[ca.SX, tuple[Argument, ...]]:
        """Rows to be differentiated, and the arguments that they take beside the usual ones."""
        e = self.expressions
        if name == "beside":
            return e.sided.residual, (self._side,)
        return {"residual": e.residual, "outputs": e.outputs}[name], ()

    @property
    def compiled(self) -> bool:
        """Whether derivatives of the residual are evaluated in C by now."""
        made = [kernel for (name, _), kernel in self._derivatives.items() if name in ITERATED.values()]
        return any(isinstance(kernel, ChosenKernel) and kernel.compiled for kernel in made)

    def library(self, source: str) -> ctypes.CDLL | None:
        """Return the loaded library of a C source that serves every system, or None: NumPy is to do."""
        if source not in self._libraries:
            self._libraries[source] = shared(source, self.choice)
        return self._libraries[source]

    def address(self, name: str, free: tuple[int, ...] = ()) -> int | None:
        """Return where a compiled kernel is: see `periodic.system.Compiling`.

        Where derivatives are compiled the others are too, when they are asked for.
        """
        if (name, free) not in self._addresses:
            rows = ITERATED.get(name)
            kernel = getattr(self, name) if rows is None else self.derivatives(rows, free)
            where = kernel.address(self.compiled) if isinstance(kernel, ChosenKernel) else None
            if where is None:
                return None
            self._addresses[name, free] = where
        return self._addresses[name, free]
