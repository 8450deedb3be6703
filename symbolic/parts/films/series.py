"""A film in series with an elastic contact: steady, solved for the load without a state, or squeezed.

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
from symbolic.equations.interval import POSITIVE
from symbolic.equations.variables import Value, above_zero
from symbolic.parts.contact.law import ContactLaw
from symbolic.parts.films.law import FilmLaw

LOAD_ITERATIONS = 6
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
    squeeze : float or Parameter, optional
        s of h = H(W) exp(-s (dh/dt)/u), H the law's steady thickness and u the entraining speed, which
        the bearing or gear gives: 123 for points (Mostofi 1981), 96.775 for lines. Without it the film
        has no state.

    Raises
    ------
    ValueError
        For what is no law, no contact at all, and a load or squeeze that is not positive.

    References
    ----------
    Mehdigoli, Rahnejat & Gohar, Wear 139 (1990), eqs. (5) and (6).
    """

    law: FilmLaw
    contacts: int = 1
    typical: float = 100.0
    squeeze: Value | None = None

    def __post_init__(self) -> None:
        if not callable(getattr(self.law, "thickness", None)):
            raise refusal("law of a film", self.law, "a FilmLaw, as PowerFilm(1e-6, 100.0) is")
        whole("contacts", self.contacts, 1)
        positive("typical load", self.typical)
        if self.squeeze is not None:
            above_zero("squeeze", self.squeeze)

    def load(self, assembly: Assembly, contact: ContactLaw, approach: ca.SX) -> ca.SX:
        """Return the load under the film.

        Parameters
        ----------
        assembly : Assembly
            The assembly of the model.
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
        delta = elastic.delta0 * ca.exp(elastic.log_deflection(y))
        film = self.contacts * self.law.thickness(assembly, self.typical * ca.exp(y))
        return self.typical * ca.exp(_solved(_balance(assembly, delta, film, approach), y))


@dataclass(frozen=True)
class Squeezed:
    """A film in series that is squeezed; its state is v = ln(W/W_steady), the departure of the load.

        delta(W) = d + c h,   h = H(W) exp(-s (dh/dt)/u)

    W stays positive, and v small, also where the bodies part.
    """

    film: SeriesFilm
    assembly: Assembly
    contact: ContactLaw

    def closed(self, v: ca.SX, approach: ca.SX, speed: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Return W in N and the row of the film, from v, d in m and u in m/s."""
        film, assembly = self.film, self.assembly
        assert film.squeeze is not None
        squeeze = assembly.parameter(film.squeeze, "squeeze", "", POSITIVE) / speed * assembly.omega
        elastic = self.contact.preloaded(assembly, ca.SX(film.typical))
        load = film.load(assembly, self.contact, approach) * ca.exp(v)
        deflection = elastic.delta0 * ca.exp(elastic.log_deflection(ca.log(load / film.typical)))
        h = (deflection - approach) / film.contacts
        return load, ca.log(h / film.law.thickness(assembly, load)) + squeeze * assembly.rate(h)


def _balance(assembly: Assembly, delta: ca.SX, film: ca.SX, approach: ca.SX) -> ca.SX:
    """ln(delta + max(-d, 0)) - ln(film + max(d, 0)): delta = d + film, both sides positive."""
    assembly.smooth_at(approach)
    return ca.log(delta + ca.fmax(-approach, 0)) - ca.log(film + ca.fmax(approach, 0))


def _solved(rising: ca.SX, y: ca.SX) -> ca.SX:
    """The zero of a function of y that is nearly linear."""
    step = y - rising / ca.jacobian(rising, y)
    found = ca.SX(0)
    for _ in range(LOAD_ITERATIONS):
        found = ca.substitute(step, y, found)
    return found
