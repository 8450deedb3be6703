"""A film in series with an elastic contact, solved for the load: no state, no unknown, no kink.

The bodies' approach d (beyond that at which dry surfaces touch) and the film make up the deflection,

    delta(W) = d + c h(W),   W = F(delta),

c films one after another. With y = ln W Newton's method, written out, solves it in logarithms,
ln(delta + max(-d, 0)) = ln(c h + max(d, 0)).
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.checks import positive, refusal, whole
from symbolic.equations.assembly import Assembly
from symbolic.parts.contact.law import ContactLaw
from symbolic.parts.films.law import FilmLaw

ITERATIONS = 6
"""Newton's steps; both sides are nearly straight lines in ln W, on either side of d = 0."""


@dataclass(frozen=True)
class SeriesFilm:
    """Steady film in series with an elastic contact: W of F^-1(W) = d + c h(W).

    Parameters
    ----------
    law : FilmLaw
        h(W).
    contacts : int
        c: 2 where an element has a film on either side.
    typical : float
        A load in N from which the equation is solved; the result does not depend on it.

    Raises
    ------
    ValueError
        For what is no law, no contact at all, and a load that is not positive.
    """

    law: FilmLaw
    contacts: int = 1
    typical: float = 100.0

    def __post_init__(self) -> None:
        if not callable(getattr(self.law, "thickness", None)):
            raise refusal("law of a film", self.law, "a FilmLaw, as PowerFilm(1e-6, 100.0) is")
        whole("contacts", self.contacts, 1)
        positive("typical load", self.typical)

    def load(self, assembly: Assembly, contact: ContactLaw, approach: ca.SX) -> ca.SX:
        """Return the load under the film.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.
        contact : ContactLaw
            F.
        approach : casadi.SX
            d in m, of either sign.

        Returns
        -------
        casadi.SX
            W in N, always positive.
        """
        elastic = contact.preloaded(assembly, ca.SX(self.typical))
        y = ca.SX.sym("log_load")
        log_delta = ca.log(elastic.delta0) + elastic.log_deflection(y)
        log_film = ca.log(self.contacts * self.law.thickness(assembly, self.typical * ca.exp(y)))
        parting, pressing = ca.fmax(-approach, 0), ca.fmax(approach, 0)
        assembly.smooth_at(approach)
        rising = ca.log(ca.exp(log_delta) + parting) - ca.log(ca.exp(log_film) + pressing)
        return self.typical * ca.exp(_solved(rising, y))


def _solved(rising: ca.SX, y: ca.SX) -> ca.SX:
    """Where a function of y that rises nearly along a line is zero."""
    step = y - rising / ca.jacobian(rising, y)
    found = ca.SX(0)
    for _ in range(ITERATIONS):
        found = ca.substitute(step, y, found)
    return found
