"""Orbits that are proven to exist: `proved`, and what it returns."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from periodic.bifurcations.label import Label
from periodic.checks import number
from periodic.orbit.layout import layout_of
from periodic.orbit.orbit import Orbit
from periodic.proof.statement import equations
from periodic.results.point import Point
from periodic.system import System, check_system, index_of

EXTRA = "pip install 'orbitrace[proof]'"
"""What brings ball arithmetic along."""

CLAIMS = {Label.FOLD: "fold", Label.DOUBLING: "doubling"}
"""What is claimed of points with a label."""


@dataclass(frozen=True)
class Disc:
    """A disc in the complex plane that holds a Floquet multiplier.

    Parameters
    ----------
    centre : complex
        Its centre.
    radius : float
        Its radius.
    """

    centre: complex
    radius: float


@dataclass(frozen=True, repr=False)
class Proof:
    """What is proven of a periodic orbit, or why nothing is.

    Parameters
    ----------
    reason : str
        Why it is not decided; empty where there is a proof.
    says : str
        The theorem, in the checker's words.
    certificate : dict
        What `periodic/proof/check.py` checks without any other file.
    radius : float
        Largest half width of the boxes that hold the orbit at the nodes, scaled as its states are.
    distance : float
        The most by which the orbit that was given differs from the proven one at the nodes, over the largest
        peak to peak of its scaled states, as its error estimate is; of a stretch not known.
    multipliers : tuple of Disc
        Discs that hold the Floquet multipliers; none for folds, doublings and stretches.
    stable : bool, optional
        Whether all of them lie within the unit circle, that of a free oscillation left out; None where it is
        not decided.
    minimum, maximum : dict
        Bounds of the least and of the greatest value of each output (SI), by name.
    parameter : tuple of float, optional
        Bounds of the parameter at a fold or doubling, of the frequency of a free oscillation; ends of a
        stretch, also of the part of it that is proven where it is not the whole.
    """

    reason: str = ""
    says: str = ""
    certificate: dict[str, Any] = field(default_factory=dict)
    radius: float = np.inf
    distance: float = np.inf
    multipliers: tuple[Disc, ...] = ()
    stable: bool | None = None
    minimum: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    maximum: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    parameter: tuple[float, float] | None = None

    def __bool__(self) -> bool:
        return not self.reason

    def __repr__(self) -> str:
        return f"Proof({self.says})" if self else f"Proof(not decided: {self.reason})"

    def peak_to_peak(self, output: str) -> tuple[float, float]:
        """Return bounds of an output's peak to peak (SI).

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        tuple of float
            Lower and upper bound.

        Raises
        ------
        ValueError
            For a name without bounds: an output is left out where it has comparisons that the equations of
            motion do not have.
        """
        if output not in self.minimum:
            raise ValueError(
                f"output is {output!r}; it must be one that has bounds, {', '.join(self.minimum)}"
            )
        least, most = self.minimum[output], self.maximum[output]
        return float(np.nextafter(most[0] - least[1], -np.inf)), float(
            np.nextafter(most[1] - least[0], np.inf)
        )

    def save(self, path: str | Path) -> None:
        """Write the certificate, which `python check.py certificate.json` checks.

        Parameters
        ----------
        path : str or Path
            Where it is written, as JSON.

        Raises
        ------
        ValueError
            Where there is no proof.
        """
        if not self.certificate:
            raise ValueError(f"there is no certificate: {self.reason}")
        Path(path).write_text(json.dumps(self.certificate, indent=1), "utf-8")


def proved(
    system: System,
    what: Orbit | Point,
    parameter: str | None = None,
    between: tuple[float, float] | None = None,
) -> Proof:
    """Prove that there is a periodic orbit where one was computed, how far from it, and whether it is stable.

    An interval Newton step on multiple shooting, in ball arithmetic, with flows by Taylor series whose
    remainders are bounded: see `periodic/proof/check.py`, which checks the certificate that is returned and
    imports nothing of this package. Kinks of the equations (gaps, stops, backlash, Hertzian contacts),
    friction that slips and impacts are crossed at their events; that no other event happens is part of the
    proof. Takes seconds to minutes.

    Parameters
    ----------
    system : System
        A compiled system with one unknown beside its states at the most.
    what : Orbit or Point
        The orbit, at the parameters that it has.
    parameter : str, optional
        The branch's parameter, for a point LP or PD: it is then proven that there is a fold or a period
        doubling, and between which values.
    between : (float, float), optional
        Two values of the parameter (SI), with that of the point between them: it is then proven that the
        branch goes from one to the other through the point without a fold, with one orbit for each value, in
        as many ranges as that takes. Where it does not come so far the proof is of what is proven of it, and
        its `reason` says where it ends.

    Returns
    -------
    Proof
        True where there is a proof; else its `reason` says what could not be shown. Nothing is ever "proven"
        wrongly, much cannot be: stiff systems, grazing orbits.

    Raises
    ------
    ImportError
        Without python-flint: ``pip install 'orbitrace[proof]'``.
    ValueError
        For what is no orbit of the system, an equilibrium, where a point is none with a proof, and ends that
        do not hold its value.
    """
    check_system(system)
    if parameter is not None:
        index_of(system, parameter)
    claim, orbit = _asked(what, parameter, between is not None)
    ends = None if between is None else _ends(between, orbit, parameter)
    orbit = orbit.expressed_in(layout_of(system))
    try:
        from flint import ctx

        from periodic.proof.check import NotProvedError
    except ImportError as error:
        raise ImportError(f"proofs need python-flint; {EXTRA}") from error
    try:
        given, values = equations(system, orbit, claim, parameter)
    except ValueError as error:
        return Proof(str(error))
    before = ctx.prec, ctx.cap  # python-flint's own, which all that use it share
    try:
        return _proved(orbit, claim, given, values) if ends is None else _stretch(orbit, given, values, ends)
    except (NotProvedError, ArithmeticError) as error:
        return Proof(str(error) or type(error).__name__)
    finally:
        ctx.prec, ctx.cap = before


def _asked(what: Orbit | Point, parameter: str | None, stretch: bool) -> tuple[str, Orbit]:
    if not isinstance(what, Orbit | Point):
        raise ValueError(f"what is a {type(what).__name__}; it must be an Orbit or a Point")
    orbit = what.orbit if isinstance(what, Point) else what
    if orbit.equilibrium:
        raise ValueError("what is an equilibrium; it must be a periodic orbit")
    if stretch:
        if parameter is None:
            raise ValueError("between is given; parameter must then say of what")
        return "stretch", orbit
    if parameter is None:
        return "orbit", orbit
    claim = CLAIMS.get(what.label) if isinstance(what, Point) else None
    if claim is None:
        raise ValueError("parameter is given; what must then be a point LP or PD of its branch")
    return claim, orbit


def _ends(between: tuple[float, float], orbit: Orbit, parameter: str | None) -> tuple[float, float]:
    if not isinstance(between, tuple | list) or len(between) != 2:
        raise ValueError(f"between is {between!r}; it must be two values of {parameter}")
    low, high = sorted(number("between", each) for each in between)
    value = orbit.parameters[str(parameter)]
    if not low <= value <= high or low == high:
        raise ValueError(f"between is {low:g}, {high:g}; it must hold the point's {parameter}, {value:g}")
    return low, high


def _stretch(
    orbit: Orbit, given: dict[str, Any], values: dict[str, float], ends: tuple[float, float]
) -> Proof:
    from periodic.proof import check
    from periodic.proof.certificate import drafted
    from periodic.proof.draft import RANGE, ratio
    from periodic.proof.stretch import Tiling, certificate, fraction

    draft = drafted(given, values, orbit, RANGE)
    if len(given["unknown"]) > 1:
        draft.anchors.append(("x0", 0, ratio(draft.places[0][0][1][0])))
    if draft.problem.events:
        draft.anchors.append(("t", 0, "0/1"))
    over = given["unknown"][-1]
    tiling = Tiling(draft, over, Fraction(ends[0]), Fraction(ends[1]))
    tiles = tiling.tiles(Fraction(values[over]))
    if not tiles:
        return Proof("; ".join(tiling.reasons))
    reached = float(fraction(tiles[0].begin)), float(fraction(tiles[-1].end))
    own = certificate(draft, tiles)
    own["digest"] = check.digest(own)
    boxes = [box for tile in tiles for node in tile.boxes for box in node[: tile.problem.n]]
    kinds = {tile.stable() for tile in tiles}
    only = f"proven from {reached[0]:.10g} to {reached[1]:.10g} only; "
    return Proof(
        reason=only * bool(tiling.reasons) + "; ".join(tiling.reasons),
        says=check.says(own, tiles),
        certificate=own,
        radius=max(float(box.rad()) for box in boxes),
        stable=kinds.pop() if len(kinds) == 1 else None,
        parameter=reached,
    )


def _proved(orbit: Orbit, claim: str, given: dict[str, Any], values: dict[str, float]) -> Proof:
    from periodic.proof import certificate as made
    from periodic.proof import check
    from periodic.proof.draft import ratio

    draft = made.drafted(given, values, orbit)
    if claim != "orbit":
        draft = made.extended(draft, claim)
    elif given["unknown"]:
        draft.anchors.append(("x0", 0, ratio(draft.places[0][0][1][0])))
    if draft.problem.events:
        draft.anchors.append(("t", 0, "0/1"))
    first = [y for places in draft.places for _, y in places]
    found = draft.boxed(draft.refined())
    n = found.problem.n
    apart = [
        abs(a - b)
        for old, new in zip(first, found.boxes, strict=True)
        for a, b in zip(old[:n], new, strict=False)
    ]
    outputs = given["names"]["outputs"]
    claims: dict[str, Any] = {"outputs": made.extremes(found, list(outputs.values()))}
    if claim == "orbit" and (discs := made.discs(found)) is not None:
        claims |= {"multipliers": discs, "stable": found.stable()}
    unknown = [_outward(ball) for ball in found.boxes[0][found.problem.first : found.problem.free]]
    proof = Proof(
        radius=max(float(box.rad()) for node in found.boxes for box in node[:n]),
        distance=max(float(each.upper()) for each in apart) / orbit.span(),
        multipliers=tuple(
            Disc(complex(_float(re), _float(im)), _float(radius))
            for re, im, radius in claims.get("multipliers", ())
        ),
        stable=claims.get("stable"),
        minimum={name: _bounds(claims["outputs"][line][0][2:]) for name, line in outputs.items()},
        maximum={name: _bounds(claims["outputs"][line][1][2:]) for name, line in outputs.items()},
        parameter=unknown[-1] if unknown else None,
    )
    own = {**draft.given, "claims": claims}
    own["digest"] = check.digest(own)
    found.given = own
    found.verify()
    return replace(proof, says=check.says(own, [found]), certificate=own)


def _outward(ball: Any) -> tuple[float, float]:
    low, high = float(ball.lower()), float(ball.upper())
    return float(np.nextafter(low, -np.inf)), float(np.nextafter(high, np.inf))


def _float(text: str) -> float:
    return float(Fraction(text))


def _bounds(both: list[str]) -> tuple[float, float]:
    low, high = sorted(map(_float, both))
    return float(np.nextafter(low, -np.inf)), float(np.nextafter(high, np.inf))
