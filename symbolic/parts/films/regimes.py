"""Films of point contacts in all four regimes of lubrication: rigid or elastic, isoviscous or piezoviscous.

With Moes' groups of a contact of radii R_x (rolling direction) and R_y under the load W,

    U = eta0 (u1 + u2)/(E' R_x),   M = W/(E' R_x^2) U^(-3/4),   L = alpha E' U^(1/4),   D = R_x/R_y,
    h = H R_x U^(1/2)

H joins the four asymptotes smoothly: it tends to each of them where that one is the largest by far.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca

from symbolic.checks import positive
from symbolic.equations.assembly import Assembly
from symbolic.parts.films.law import FilmLaw
from symbolic.parts.films.regressions import Compliance, Rolling

REGIMES = ("isoviscous-rigid", "isoviscous-elastic", "piezoviscous-rigid", "piezoviscous-elastic")


@dataclass(frozen=True)
class FilmRegime:
    """The film of a point contact, and the regime it is in.

    Parameters
    ----------
    thickness : float
        H = h/(R_x U^(1/2)), central.
    asymptotes : dict of str to float
        H of each regime alone: ``isoviscous-rigid`` and so on.
    name : str
        The regime whose asymptote decides: the larger of isoviscous and piezoviscous, in which the larger
        (isoviscous) or the smaller (piezoviscous) of rigid and elastic counts, as the formula joins them.
    """

    thickness: float
    asymptotes: dict[str, float]
    name: str


def film_regime(M: float, L: float, D: float = 1.0) -> FilmRegime:
    """Return the central film of a point contact and its regime by Nijenbanning, Venner and Moes.

    Parameters
    ----------
    M : float
        Moes' number of the load.
    L : float
        Moes' number of the lubricant.
    D : float
        R_x/R_y: 1 for circular contacts, less for ones that are wide across the rolling direction.

    Returns
    -------
    FilmRegime
        Thickness, asymptotes and name.

    Raises
    ------
    ValueError
        For numbers that are not positive.

    References
    ----------
    .. [1] G. Nijenbanning, C. H. Venner, H. Moes, Wear 176 (1994) 217-229.
    """
    load, lubricant = ca.SX(math.log(positive("M", M))), ca.SX(math.log(positive("L", L)))
    values = log_film(load, lubricant, ca.SX(positive("D", D)))
    joined, *rest = (float(ca.exp(value)) for value in values)
    asymptotes = dict(zip(REGIMES, rest, strict=True))
    rigid, elastic, viscous_rigid, viscous_elastic = REGIMES
    isoviscous = max(rigid, elastic, key=asymptotes.__getitem__)
    piezoviscous = min(viscous_rigid, viscous_elastic, key=asymptotes.__getitem__)
    return FilmRegime(joined, asymptotes, max(isoviscous, piezoviscous, key=asymptotes.__getitem__))


@dataclass(frozen=True)
class RegimeFilm(FilmLaw):
    """Central film of a point contact in whatever regime it is, by Nijenbanning, Venner and Moes.

    H^s = (H_RI^(3/2) + (H_EI^-4 + h00^-4)^(-3/8))^(2s/3) + (H_RP^-8 + H_EP^-8)^(-s/8)

    Parameters
    ----------
    rolling : Rolling
        The bodies and their lubricant.

    References
    ----------
    .. [1] G. Nijenbanning, C. H. Venner, H. Moes, Wear 176 (1994) 217-229.
    """

    rolling: Rolling

    def thickness(self, assembly: Assembly, load: ca.SX) -> ca.SX:
        """Return h in m."""
        log_m, log_l, log_u = moes(self.rolling, assembly, load)
        radius = self.rolling.reduced_radius(assembly)
        crown = assembly.parameter(self.rolling.crown, "crown_radius", "m")
        return radius * ca.exp(log_film(log_m, log_l, radius / crown)[0] + log_u / 2)

    def regime(self, load: float) -> FilmRegime:
        """Return the regime under a load (N), the law's numbers at their nominal values.

        Parameters
        ----------
        load : float
            W in N.

        Returns
        -------
        FilmRegime
            Thickness, asymptotes and name.

        Raises
        ------
        ValueError
            For a load that is not positive.
        """
        assembly = Assembly()
        log_m, log_l, _ = moes(self.rolling, assembly, ca.SX(positive("load", load)))
        crown = assembly.parameter(self.rolling.crown, "crown_radius", "m")
        ratio = self.rolling.reduced_radius(assembly) / crown
        m, oil, d = (assembly.nominal(item) for item in (ca.exp(log_m), ca.exp(log_l), ratio))
        return film_regime(m, oil, d)


def moes(rolling: Rolling, assembly: Assembly, load: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Return ln M, ln L and ln U of a point contact under a load in N."""
    groups = rolling.groups(assembly, load, Compliance.REDUCED)
    log_u = groups.log_u + math.log(2)
    return groups.log_w - 0.75 * log_u, groups.log_g + 0.25 * log_u, log_u


def log_film(log_m: ca.SX, log_l: ca.SX, ratio: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX, ca.SX]:
    """Return ln H and the logarithms of the four asymptotes in the order of REGIMES."""
    rigid = ca.log(145 / ratio) - 15 / 7 * ca.log(1 + 0.796 * ratio ** (14 / 15)) - 2 * log_m
    shape = ca.log(1 + 0.006 * ca.log(ratio) + 0.63 * ratio ** (4 / 7))
    elastic = math.log(3.18) - 14 / 25 * shape - ca.log(ratio) / 15 - 2 / 15 * log_m
    viscous_elastic = math.log(1.48) - 7 / 20 * shape - ca.log(ratio) / 24 - log_m / 12 + 0.75 * log_l
    viscous_rigid = math.log(1.29) - 2 / 3 * ca.log(1 + 0.691 * ratio) + 2 / 3 * log_l
    bluntness = 1.5 * (1 + ca.exp(-1.2 * ca.exp(elastic - rigid)))
    limited = _log_sum(-4 * elastic, -4 * ca.log(1.8 / ratio)) / -4
    isoviscous = _log_sum(1.5 * rigid, 1.5 * limited) / 1.5
    piezoviscous = _log_sum(-8 * viscous_rigid, -8 * viscous_elastic) / -8
    joined = _log_sum(bluntness * isoviscous, bluntness * piezoviscous) / bluntness
    return joined, rigid, elastic, viscous_rigid, viscous_elastic


def _log_sum(a: ca.SX, b: ca.SX) -> ca.SX:
    """ln(e^a + e^b)."""
    return (a + b) / 2 + ca.log(2 * ca.cosh((a - b) / 2))
