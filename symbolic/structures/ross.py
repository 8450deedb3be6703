"""Rotors of the program ROSS: its matrices are taken, ROSS itself is not needed here."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from symbolic.checks import finite
from symbolic.structures.matrices import Matrices

KINDS = {4: ("x", "y", "alpha", "beta"), 6: ("x", "y", "z", "alpha", "beta", "theta")}
"""What ROSS calls the degrees of freedom of a node: lateral models of old, and models with all six."""

PROBES = 1.0, 1000.0
"""Speeds in rad/s at which bearings are compared where no speed is given."""


class RossRotor(Protocol):
    """What is used of a `ross.Rotor`."""

    @property
    def number_dof(self) -> int:
        """Degrees of freedom of a node."""

    def M(self) -> Any:
        """Mass matrix."""

    def C(self, frequency: float) -> Any:
        """Damping at a frequency in rad/s."""

    def K(self, frequency: float) -> Any:
        """Stiffness at a frequency in rad/s."""

    def G(self) -> Any:
        """Gyroscopic matrix."""


def ross_matrices(rotor: RossRotor, speed: float | None = None) -> Matrices:
    """Return the matrices of a ROSS rotor.

    Parameters
    ----------
    rotor : ross.Rotor
        The rotor, its bearings included.
    speed : float, optional
        Omega in rad/s at which its bearings are taken; needed where they depend on it.

    Returns
    -------
    Matrices
        M, C, K and G, with the places ``x0``, ``y0``, ... (number of the node), as ROSS names them.

    Raises
    ------
    ValueError
        For what is no ROSS rotor, and bearings that depend on the speed where no speed is given.
    """
    try:
        kinds = KINDS[rotor.number_dof]
        mass, gyroscopic = rotor.M(), rotor.G()
        first, last = [(rotor.C(w), rotor.K(w)) for w in ((finite("speed", speed),) * 2 if speed else PROBES)]
    except (AttributeError, KeyError, TypeError) as error:
        raise ValueError(f"rotor is no ross.Rotor: {error}") from None
    for name, one, other in zip(("damping", "stiffness"), first, last, strict=True):
        if not np.array_equal(one, other):
            raise ValueError(f"the {name} of the rotor's bearings depends on the speed; give speed= in rad/s")
    nodes = len(mass) // len(kinds)
    at = {f"{kind}{node}": len(kinds) * node + k for node in range(nodes) for k, kind in enumerate(kinds)}
    return Matrices(mass, first[0], first[1], gyroscopic, at=at)
