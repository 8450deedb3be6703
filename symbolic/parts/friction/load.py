"""What friction can hold: a number, or what presses two surfaces together in motion."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import NOT_NEGATIVE, POSITIVE
from symbolic.equations.variables import Coordinate, Value, above_zero, not_negative
from symbolic.parts.mechanics.ends import deflection


@dataclass(frozen=True)
class NormalLoad:
    """Limit of friction under a load that moves: mu max(N_0 + k_n w, 0), w the approach of the surfaces.

    Parameters
    ----------
    q : Coordinate
        w = q, or w = q - r.
    coefficient : float or Parameter
        mu, the coefficient of friction.
    stiffness : float or Parameter
        k_n in N/m, of the contact in the direction of its normal.
    preload : float or Parameter
        N_0 in N, at w = 0; negative over a clearance.
    to : Coordinate, optional
        The coordinate r; the ground, r = 0, where there is none.

    Raises
    ------
    ValueError
        For a coefficient that is negative, and a stiffness that is not positive.

    References
    ----------
    Yang, Chu & Menq, J. Sound Vib. 211 (1998) 461-481.
    """

    q: Coordinate
    coefficient: Value
    stiffness: Value
    preload: Value = 0.0
    to: Coordinate | None = None

    def __post_init__(self) -> None:
        not_negative("coefficient of friction", self.coefficient)
        above_zero("normal stiffness", self.stiffness)

    def limit(self, assembly: Assembly) -> ca.SX:
        """Return the limit of friction.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.

        Returns
        -------
        casadi.SX
            In N.
        """
        mu = assembly.parameter(self.coefficient, "mu", "", NOT_NEGATIVE)
        k = assembly.parameter(self.stiffness, "k_n", "N/m", POSITIVE)
        preload = assembly.parameter(self.preload, "N_0", "N")
        return mu * ca.fmax(preload + k * deflection(assembly, self.q, self.to), 0)


def limit_of(assembly: Assembly, value: Value | NormalLoad, name: str) -> ca.SX:
    """Return the limit of friction in N; bare numbers are called `name`."""
    if isinstance(value, NormalLoad):
        return value.limit(assembly)
    return assembly.parameter(value, name, "N", NOT_NEGATIVE)


def check_limit(field: str, value: Value | NormalLoad) -> None:
    """Refuse a number that is negative. Raises ValueError."""
    if not isinstance(value, NormalLoad):
        not_negative(field, value)
