"""The law of a film: its steady thickness as a function of the load that it carries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import POSITIVE
from symbolic.equations.variables import Value, above_zero


class FilmLaw(Protocol):
    """Steady thickness h(W) of a film: parts need no more of its law, as they need F(delta) of a ContactLaw.

    A law is a frozen dataclass of numbers that inherits from this protocol and defines `thickness`: positive,
    falling with W, ln h a smooth function of ln W.
    """

    def thickness(self, assembly: Assembly, load: ca.SX) -> ca.SX:
        """Return the steady thickness.

        Parameters
        ----------
        assembly : Assembly
            Its `parameter` makes the law's numbers parameters of the model.
        load : casadi.SX
            W in N, positive.

        Returns
        -------
        casadi.SX
            h in m.
        """
        ...


@dataclass(frozen=True)
class PowerFilm(FilmLaw):
    """h = h0 (W/W0)^(-1/beta).

    Parameters
    ----------
    h0 : float or Parameter
        Thickness in m under the load W0.
    load : float or Parameter
        W0 in N.
    beta : float or Parameter
        Exponent of the film's stiffness.

    Raises
    ------
    ValueError
        For numbers that are not positive.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), eq. (13) without squeeze.
    """

    h0: Value
    load: Value
    beta: Value = 22.23

    def __post_init__(self) -> None:
        for name in ("h0", "load", "beta"):
            above_zero(f"{name} of a PowerFilm", getattr(self, name))

    def thickness(self, assembly: Assembly, load: ca.SX) -> ca.SX:
        """Return h in m."""
        h0 = assembly.parameter(self.h0, "h0", "m", POSITIVE)
        at = assembly.parameter(self.load, "film_load", "N", POSITIVE)
        return h0 * ca.exp((ca.log(at) - ca.log(load)) / assembly.parameter(self.beta, "beta", "", POSITIVE))
