"""Rotors of the program ROSS: its matrices are taken, ROSS itself is not needed here."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from symbolic.checks import finite
from symbolic.structures.matrices import Matrices, dense

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


def ross_matrices(rotor: RossRotor, speed: float | None = None, *, lateral: bool = False) -> Matrices:
    """Return the matrices of a ROSS rotor.

    Parameters
    ----------
    rotor : ross.Rotor
        The rotor, its bearings included.
    speed : float, optional
        Omega in rad/s at which its bearings are taken; needed where they depend on it.
    lateral : bool
        Whether axial motion z and torsion theta are left out, which most rotors leave free.

    Returns
    -------
    Matrices
        M, C, K and G, with the places ``x0``, ``y0``, ... (number of the node), as ROSS names them.

    Raises
    ------
    ValueError
        For what is no ROSS rotor, bearings that depend on the speed where no speed is given, and lateral
        motion that is coupled to what is to be left out.
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
    found = Matrices(mass, first[0], first[1], gyroscopic, at=at)
    return _lateral(found) if lateral else found


def _lateral(matrices: Matrices) -> Matrices:
    """Bending alone: matrices without the freedoms z and theta."""
    at = {place: k for place, k in matrices.at.items() if place.rstrip("0123456789") not in ("z", "theta")}
    kept = np.array(list(at.values()))
    out = np.setdiff1d(np.arange(matrices.size), kept)
    each = {name: dense(getattr(matrices, name)) for name in "MCKG"}
    for name, matrix in each.items():
        if max(np.abs(matrix[np.ix_(*pair)]).max(initial=0.0) for pair in ((kept, out), (out, kept))) > 0:
            raise ValueError(f"lateral is True, but {name} couples bending to axial motion or torsion")
    cut = {name: matrix[np.ix_(kept, kept)] for name, matrix in each.items()}
    return Matrices(**cut, at={place: k for k, place in enumerate(at)})
