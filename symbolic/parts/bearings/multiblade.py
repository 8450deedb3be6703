"""Multiblade coordinates: states of elements that take each other's places, with the period of one passage.

n elements at theta_i = (tau + 2 pi i)/n each bring a state v_i, that of the next one a passage later. Their
Fourier series around the bearing,

    v_i = a_0 + sum over k = 1 .. n/2 of (a_k cos k theta_i + b_k sin k theta_i),

has coefficients that repeat with the passage (Coleman & Feingold, NACA Report 1351, 1958, for rotor blades).
Where n is even cos and sin of k = n/2 tell one number of the elements by two: what of them no element shows,
e = b cos(tau/2) - a sin(tau/2), is left to decay, de/dtau = -IDLE e.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.terms import State

IDLE = 3.0
"""Rate at which what no element shows decays, per rad of a passage; its multiplier is -6e-9."""


@dataclass(frozen=True)
class Multiblade:
    """A state of each of n elements in multiblade coordinates, without dimension.

    Parameters
    ----------
    assembly : Assembly
        The workbench of the model.
    name : str
        What the states are called by.
    count : int
        n.
    passage : casadi.SX
        tau, the angle of the passage of elements.
    """

    assembly: Assembly
    states: tuple[State, ...]
    count: int
    passage: ca.SX

    @classmethod
    def of(cls, assembly: Assembly, name: str, count: int, passage: ca.SX) -> Multiblade:
        """Add the coefficients as states."""
        names = ["mean", *(f"{wave} {k}" for k in range(1, count // 2 + 1) for wave in ("cos", "sin"))]
        states = tuple(assembly.state(f"{name} {each}", "", 1.0, ca.SX(0)) for each in names)
        return cls(assembly, states, count, passage)

    def element(self, i: int) -> ca.SX:
        """Return v_i."""
        theta, (mean, *others) = (self.passage + 2 * ca.pi * i) / self.count, self.states
        value = mean.symbol
        for j, (a, b) in enumerate(zip(others[::2], others[1::2], strict=True), 1):
            value += a.symbol * ca.cos(j * theta) + b.symbol * ca.sin(j * theta)
        return value

    def idle(self) -> list[ca.SX]:
        """Return the row of what no element shows, none where n is odd."""
        if self.count % 2:
            return []
        a, b = self.states[-2:]
        hidden = b.symbol * ca.cos(self.passage / 2) - a.symbol * ca.sin(self.passage / 2)
        return [self.assembly.rate(hidden) + IDLE * self.assembly.rate(self.passage) * hidden]
