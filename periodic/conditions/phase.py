"""Phase conditions: what autonomous orbits need besides their equations, which leave their phase open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from periodic.correction.condition import Condition, Given, SideCondition
from periodic.linear.unknowns import mean_weights, node_phase_gradient
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System

PROBED = 8
"""Phases at which it is looked whether equations depend on them."""


@dataclass(frozen=True)
class PhaseCondition(Condition):
    """The integral phase condition of autonomous orbits: mean over the period of <x - x_o, x_o'> = 0.

    x_o is the orbit before. It holds the phase that the equations leave open, and determines the angular
    frequency omega = 2 pi / period.

    References
    ----------
    Doedel, AUTO: a program for the automatic bifurcation analysis of autonomous systems, 1981.
    """

    intrinsic: ClassVar[bool] = True
    trivial: ClassVar[int] = 1

    def check(self, system: System, parameter: Array) -> None:
        """Refuse an excited system, whose equations hold the phase of its orbits."""
        state, algebraic = system.rest(parameter)
        tau = np.linspace(0, FORCED, PROBED, endpoint=False)
        away = np.tile(state, (PROBED, 1)) + np.cos(np.arange(state.size) + tau[:, None])
        unknowns = np.tile(algebraic, (PROBED, 1))
        line = system.linearise(np.zeros_like(away), away, unknowns, tau, parameter, ())
        if np.abs(np.nan_to_num(line.d_phase)).max(initial=0.0) > 0:
            raise ValueError(
                f"determined has {type(self).__name__}(), for orbits whose phase is free; "
                f"it must be left out, as the system is excited: its equations depend on the phase"
            )

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition with respect to an orbit."""
        return _Phase(origin)


@dataclass(frozen=True)
class Conservative(PhaseCondition):
    """The phase condition of systems that conserve energy, whose orbits come in families.

    It determines a parameter that would dissipate energy, such as a damping, which so stays 0; the angular
    frequency is then a parameter like any other. Two multipliers are 1 whatever the parameters.

    References
    ----------
    Munoz-Almaraz et al., Physica D 181 (2003) 1.
    """

    trivial: ClassVar[int] = 2


@dataclass(frozen=True)
class _Phase:
    """The phase condition with respect to one orbit."""

    origin: Orbit

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient; mesh points that move carry the origin's slope with them."""
        slope, k = self.origin.node_rates, len(orbit.phases)
        weighted = mean_weights(self.origin)[:, None] * slope
        outer = np.zeros(k + len(free))
        outer[:k] = -np.einsum("jn,jn,jk->k", weighted, slope, node_phase_gradient(orbit))
        value = np.einsum("jn,jn->", weighted, orbit.nodes - self.origin.nodes)
        value += outer[:k] @ (orbit.phases - self.origin.phases)
        return Row(float(value), weighted, outer)
