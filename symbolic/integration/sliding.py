"""Time integration through dry friction: pieces on a side of each jump, or sliding along it (Filippov)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.equations.expressions import Expressions
from symbolic.equations.surfaces import STUCK
from symbolic.integration.events import Event, Value
from symbolic.integration.lsoda import Rates

Sides = tuple[int, ...]
"""Of each jump along which motions slide: 1, -1, or STUCK."""

SHARP = 1e-3
"""How far past its zero a switch that ends a piece is, in tolerances: it may begin there at rest."""


class Slippery(Protocol):
    """What is asked of a system that slides."""

    @property
    def expressions(self) -> Expressions: ...
    @property
    def slides(self) -> dict[int, tuple[int, int]]: ...
    def switch(self, state: Array, phase: Array, parameter: Array) -> Array: ...


@dataclass(frozen=True, eq=False)
class Sliding:
    """The sides of a system's jumps along a motion: its rates there, and where they change."""

    system: Slippery
    parameter: Array
    tolerance: float
    _slides: list[tuple[int, tuple[int, int]]] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_slides", list(self.system.slides.items()))

    def begin(self, tau: float, y: Array) -> Sides:
        """The sides at the beginning of a motion."""
        values = self._switches(tau, y)
        return tuple(self._at(values, k, pair) for k, pair in self._slides)

    def again(self, sides: Sides, tau: float, y: Array) -> Sides:
        """The sides after an impact, which may turn what slips, and tear off what held."""
        values = self._switches(tau, y)
        slips = [abs(values[k]) > self.tolerance for k, _ in self._slides]
        return tuple(b if slip else a for a, b, slip in zip(sides, self.begin(tau, y), slips, strict=True))

    def rates(self, sides: Sides) -> Rates:
        """x' on given sides."""
        given = np.zeros(len(self._jumps))
        for side, (k, _) in zip(sides, self._slides, strict=True):
            given[self._jumps.index(k)] = side
        return lambda tau, y: np.array(self._rates(y, tau, self.parameter, given)).ravel()

    def events(self, sides: Sides) -> list[Event[Sides]]:
        """What ends a piece on given sides."""
        found = []
        for i, ((k, (up, down)), side) in enumerate(zip(self._slides, sides, strict=True)):
            if side == STUCK:
                found += [self._release(sides, i, up, -1), self._release(sides, i, down, 1)]
            else:
                found.append(self._stop(sides, i, k, side))
        return found

    def _release(self, sides: Sides, i: int, switch: int, way: int) -> Event[Sides]:
        return Event(self._value(switch, way), lambda tau, y: (y, _with(sides, i, -way)))

    def _stop(self, sides: Sides, i: int, switch: int, side: int) -> Event[Sides]:
        up, down = self._slides[i][1]

        def after(tau: float, y: Array) -> tuple[Array, Sides]:
            values = self._switches(tau, y)
            holds = values[up] < 0 < values[down]
            return y, _with(sides, i, STUCK if holds else -side)

        return Event(self._value(switch, side), after)

    def _value(self, switch: int, side: int) -> Value:
        past = SHARP * self.tolerance
        return lambda tau, y: side * float(self._switches(tau, y)[switch]) + past

    def _at(self, values: Array, switch: int, pair: tuple[int, int]) -> int:
        up, down = pair
        if abs(values[switch]) > self.tolerance:
            return 1 if values[switch] > 0 else -1
        if values[up] < 0 < values[down]:
            return STUCK
        return 1 if values[up] > 0 else -1

    def _switches(self, tau: float, y: Array) -> Array:
        return self.system.switch(y[None], np.array([tau]), self.parameter)[0]

    @property
    def _jumps(self) -> Sequence[int]:
        return self.system.expressions.sided.jumps

    @cached_property
    def _rates(self) -> ca.Function:
        e = self.system.expressions
        sided = e.sided
        rest = ca.substitute(sided.residual, e.rate, ca.SX.zeros(e.rate.numel()))
        explicit = ca.solve(ca.jacobian(sided.residual, e.rate), -rest)
        return ca.Function("beside", [e.state, e.phase, e.parameter, sided.side], [explicit])


def _with(sides: Sides, i: int, side: int) -> Sides:
    return (*sides[:i], side, *sides[i + 1 :])
