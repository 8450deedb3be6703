"""The static transmission error of a gear pair, which excites it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import NOT_NEGATIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, several


@dataclass(frozen=True)
class TransmissionError(Part):
    """Static transmission error e = sum_j e_j cos j tau: force -m e'' = m sum_j e_j (j Omega)^2 cos j tau.

    It is the inertia of the wheels (equivalent mass m) that follow the profile of the teeth, as the
    coordinate q is measured from it.

    Parameters
    ----------
    q : Coordinate
        Deflection of the mesh.
    m : float or Parameter
        Equivalent mass I1 I2 / (I1 r2^2 + I2 r1^2) in kg, that of the Mass on q.
    amplitudes : sequence of float or Parameter
        e_1, e_2, ... in m.
    frequency : float or Parameter
        Mesh frequency Omega in rad/s, teeth times the speed of a wheel; a bare number becomes the parameter
        Omega.

    Raises
    ------
    ValueError
        For amplitudes that are no sequence.

    References
    ----------
    Kahraman & Singh, J. Sound Vib. 142 (1990) 49-75 and 146 (1991) 135-156.
    """

    q: Coordinate
    m: Value
    amplitudes: Sequence[Value]
    frequency: Value = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "amplitudes", several("amplitudes", self.amplitudes))

    def contribute(self, assembly: Assembly) -> None:
        """Add the force and set the frequency of the excitation."""
        m = assembly.parameter(self.m, "m", "kg", NOT_NEGATIVE)
        omega = assembly.parameter(self.frequency, "Omega", "rad/s")
        assembly.excite(omega)
        for order, value in enumerate(self.amplitudes, 1):
            e = assembly.parameter(value, f"e{order}", self.q.unit)
            assembly.motion(self.q).force += m * e * (order * omega) ** 2 * assembly.harmonic(order)
