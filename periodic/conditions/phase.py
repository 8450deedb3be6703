"""Phase conditions: what autonomous orbits need besides their equations, which leave their phase open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from periodic.conditions.twoparameter.augmented import of_orbits
from periodic.correction.condition import Condition, Given, SideCondition
from periodic.linear.unknowns import mean_weights, node_phase_gradient
from periodic.orbit.layout import layout_of
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System

PROBED = 8
"""Phases at which it is looked whether equations depend on them."""
SHIFTED = 1e-9
"""Relative remainder up to which the dependence on the phase is that of a shift of the unknowns."""


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
        if excited(system, parameter):
            raise ValueError(
                f"determined has {type(self).__name__}(), for orbits whose phase is free; "
                f"it must be left out, as the system is excited: its equations depend on the phase"
            )

    def at(self, origin: Orbit, given: Given) -> SideCondition:
        """Return the side condition with respect to an orbit. Raises ValueError for an equilibrium."""
        of_orbits(self, origin)
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


def open_phase(system: System, parameter: Array, continued: str) -> str:
    """Return why nothing determines the period of orbits without a phase condition; empty if something does.

    Parameters
    ----------
    system : System
        The equations.
    parameter : Array
        Parameters in SI units, shape (p,).
    continued : str
        The parameter that is continued in: orbits of given frequencies, as of a family, are no mistake.

    Returns
    -------
    str
        A clause that says which condition there is for it.
    """
    names = layout_of(system).frequency
    if len(names) != 1 or continued in names or excited(system, parameter):
        return ""
    return (
        f"the system is not excited, and determined={{{names[0]!r}: PhaseCondition()}} alone determines the "
        f"period of its orbits"
    )


def excited(system: System, parameter: Array) -> bool:
    """Whether the equations depend on the phase otherwise than by a constant shift of the unknowns.

    Where F(x', x + s e, tau + s) = F(x', x, tau) for one vector e, as with angles ahead of a mean rotation,
    the phase is free all the same: then d F / d tau = -(d F / d x) e at all points.
    """
    state, algebraic = system.rest(parameter)
    tau = np.linspace(0, FORCED, PROBED, endpoint=False)
    away = np.tile(state, (PROBED, 1)) + np.cos(np.arange(state.size) + tau[:, None])
    unknowns = np.tile(algebraic, (PROBED, 1))
    line = system.linearise(np.zeros_like(away), away, unknowns, tau, parameter, ())
    phase = np.nan_to_num(line.d_phase).ravel()
    shifts = np.nan_to_num(np.concatenate([line.d_state, line.d_algebraic], axis=2))
    shifts = shifts.reshape(phase.size, -1)
    left = phase - shifts @ np.linalg.lstsq(shifts, phase)[0]
    return bool(np.linalg.norm(left) > SHIFTED * np.linalg.norm(phase))
