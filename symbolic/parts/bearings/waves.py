"""Waviness of the races and elements of a rolling bearing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import casadi as ca

from symbolic.checks import one_of, whole
from symbolic.equations.assembly import Assembly
from symbolic.equations.excitation import Order, order_of
from symbolic.equations.variables import Value

SURFACES = ("outer", "inner", "ball")


@dataclass(frozen=True)
class Turns:
    """Angles in a bearing: of an element's place, of the shaft, and of an element about itself (rad).

    shaft and spin are None where no rational order ties them to the excitation.
    """

    place: ca.SX
    shaft: ca.SX | None
    spin: ca.SX | None


@dataclass(frozen=True)
class RaceWave:
    """Waves on a surface of a rolling bearing: their height presses the elements that they meet.

    The outer race stands, a cos(n theta + phi) at the place theta of an element; the inner race turns with
    the shaft, a cos(n (theta - theta_s) + phi); a ball meets both races with its own waves, at its angle psi
    and opposite, a cos(n psi + phi) + a cos(n (psi + pi) + phi).

    Parameters
    ----------
    surface : str
        "outer", "inner" or "ball".
    waves : int
        n, around the surface.
    amplitude : float or Parameter
        a in m.
    phase : float or Parameter
        phi in rad.
    """

    surface: Literal["outer", "inner", "ball"]
    waves: int
    amplitude: Value
    phase: Value = 0.0

    def __post_init__(self) -> None:
        one_of("surface", self.surface, SURFACES)
        whole("waves", self.waves, 1)

    def height(self, assembly: Assembly, turns: Turns) -> ca.SX:
        """Return the height at an element.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.
        turns : Turns
            The angles of the element.

        Returns
        -------
        casadi.SX
            Height in m.

        Raises
        ------
        ValueError
            For waves that turn, where no rational order ties them to the passage of the elements.
        """
        name = f"{self.surface}_{self.waves}"
        a = assembly.parameter(self.amplitude, f"{name}_amplitude", "m")
        phi = assembly.parameter(self.phase, f"{name}_phase", "rad")
        if self.surface == "outer":
            return a * ca.cos(self.waves * turns.place + phi)
        angle = turns.shaft if self.surface == "inner" else turns.spin
        if angle is None:
            needed = "passages" if self.surface == "inner" else "passages and spin"
            raise ValueError(
                f"waves on the {self.surface} have no common period with the passage of the elements; "
                f"give the bearing {needed} per turn of the shaft as rational numbers"
            )
        if self.surface == "inner":
            return a * ca.cos(self.waves * (turns.place - angle) + phi)
        return a * (ca.cos(self.waves * angle + phi) + ca.cos(self.waves * (angle + ca.pi) + phi))

    def order(self, passages: Order, spin: Order | None) -> Order:
        """Return the order of the shaft's angle in which the height at an element's place repeats.

        Parameters
        ----------
        passages, spin : int, float, str or Fraction
            Passages of elements, and turns of an element about itself, in one turn of the shaft.

        Returns
        -------
        int, float, str or Fraction
            The order.
        """
        if self.surface == "outer":
            return passages
        return self.waves * (order_of(spin) if self.surface == "ball" and spin is not None else 1)
