"""Models with several joints drawn at random, as numbers for the judge; a seed is a model.

Two to six masses in a chain or a tree, or a cantilever of two to four elements, forced harmonically at one
place, with two to eight joints among dry friction, exact sliders (Jenkins), several of them side by side
(Iwan) and one-sided springs; some with cubic springs. The range goes from below the resonance of the model
with its sliders loose to above that with its sliders stuck.

Limits are sized by linear responses. A slider slips where its spring, never slipping, would carry more than
its limit, the Coulomb joints being loose; a Coulomb joint where what holds it, the others being loose and
the sliders stuck, would exceed its own. The first joint has 0.2 to 0.6 of the smaller of both ends of the
range, so that it slips all along if the others leave it what it would have alone; the others have the same
in three models of five, else anything between 0.2 of that and 0.8 of the largest in the range, so that some
of them are held in parts of it. Where at an end of the range all could stick, all limits are made smaller.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray
from reference.joints.model import Coulomb, Cubic, Joint, Jointed, Slider, Stop

Array = NDArray[np.float64]
Random = np.random.Generator

KINDS = ("coulomb", "jenkins", "iwan", "stop")
SHARES = (0.3, 0.3, 0.15, 0.25)
"""How often a joint is of a kind."""

LOOSE = 0.6
"""Share of the models in which all joints are to slip throughout the range."""

SLIDERS = ("jenkins", "iwan")

Links = tuple[tuple[int, int | None, float, float], ...]

STIFFNESS = {
    "jenkins": (0.1, 1.0),
    "iwan": (0.1, 1.0),
    "stop": (1.0, 1e3),
    "cubic": (0.005, 0.05),
}
"""Of a joint, drawn evenly in its logarithm, in parts of what the body has (a cubic spring's at the ends)."""

MOST = 2.0
"""What an amplitude counts for at the most, in parts of that at the ends: joints take it away."""

NEEDED = 1.5
"""Of the limits, what at least one joint would have to carry at either end if all were to stick there."""

FREQUENCIES = 80
"""At which the linear response is looked at."""


@dataclass(frozen=True, kw_only=True)
class Attached:
    """A joint or cubic spring between places i and `to` (None: the ground), in SI.

    stiffness: k in N/m (N/m^3 of a cubic spring). limits: of friction, in N; several of an Iwan joint, whose
    sliders have k/n each. gap: of a stop, in m, on the side of negative u where `below`.
    """

    kind: str
    i: int
    to: int | None
    stiffness: float = 0.0
    limits: tuple[float, ...] = ()
    gap: float = 0.0
    below: bool = False


@dataclass(frozen=True, kw_only=True)
class JointModel:
    """M, C, K (n, n) in SI, the places' degrees of freedom, the force, what is attached, the range in rad/s.

    links: springs (i, to, k, c) of which K and C consist; empty for a beam, whose matrices are given as such.
    """

    seed: int
    mass: Array
    damping: Array
    stiffness: Array
    places: tuple[int, ...]
    links: Links
    forced: int
    force: float = 1.0
    attached: tuple[Attached, ...] = ()
    bounds: tuple[float, float] = (0.0, 0.0)

    @property
    def beam(self) -> bool:
        """Whether it is a beam."""
        return not self.links

    @property
    def told(self) -> str:
        """The model in words."""
        body = f"beam of {len(self.places)}" if self.beam else f"{len(self.mass)} masses"
        low, high = self.bounds
        joints = "; ".join(_said(a) for a in self.attached)
        return f"joints {self.seed}: {body}, {joints}; Omega {low:.4f} to {high:.4f}"

    @property
    def sliders(self) -> list[str]:
        """What the places of sliders are called in the model of parts."""
        found = []
        for a in self.attached:
            between = f"q{a.i}" if a.to is None else f"q{a.i} - q{a.to}"
            if a.kind == "jenkins":
                found.append(f"z of {between}")
            elif a.kind == "iwan":
                found += [f"z{k} of {between}" for k in range(1, len(a.limits) + 1)]
        return found

    def row(self, i: int, to: int | None) -> Array:
        """u = q_i - q_to as a row."""
        one = np.eye(len(self.mass))[list(self.places)]
        return one[i] if to is None else one[i] - one[to]

    def record(self) -> Jointed:
        """The same for the judge; Iwan joints are so many sliders."""
        joints, cubics = list[Joint](), list[Cubic]()
        for a in self.attached:
            row = self.row(a.i, a.to)
            if a.kind == "coulomb":
                joints.append(Coulomb(row, a.limits[0]))
            elif a.kind == "stop":
                joints.append(Stop(-row if a.below else row, a.stiffness, a.gap))
            elif a.kind == "cubic":
                cubics.append(Cubic(row, a.stiffness))
            else:
                joints += [Slider(row, a.stiffness / len(a.limits), limit) for limit in a.limits]
        force = self.force * self.row(self.forced, None)
        return Jointed(self.mass, self.damping, self.stiffness, force, joints, cubics)


def _said(a: Attached) -> str:
    numbers = [f"k {a.stiffness:.4g}"] if a.stiffness else []
    numbers += [f"F {limit:.4g}" for limit in a.limits]
    numbers += [f"gap {a.gap:.4g}{' below' if a.below else ''}"] if a.kind == "stop" else []
    return " ".join([a.kind, str(a.i), "-" if a.to is None else str(a.to), *numbers])


def joint_model(seed: int) -> JointModel:
    """Return the model of a seed."""
    random = np.random.default_rng([11, seed])
    model = (beam if random.random() < 0.2 else masses)(random, seed)
    return _sized(random, _attached(random, model))


def masses(random: Random, seed: int) -> JointModel:
    """Two to six masses in a chain or a tree."""
    n = int(random.integers(2, 7))
    zeta, links = _log(random, 0.005, 0.05), list[tuple[int, int | None, float, float]]()
    tree = random.random() < 0.4
    for i in range(n):
        if i == 0 or random.random() < 0.4:
            k = random.uniform(0.3, 1.5)
            links.append((i, None, k, 2 * zeta * math.sqrt(k)))
        if i:
            k = random.uniform(0.5, 2)
            to = int(random.integers(i)) if tree else i - 1
            links.append((i, to, k, 2 * zeta * math.sqrt(k)))
    one, damping, stiffness = np.eye(n), np.zeros((n, n)), np.zeros((n, n))
    for i, end, k, c in links:
        row = one[i] if end is None else one[i] - one[end]
        stiffness += k * np.outer(row, row)
        damping += c * np.outer(row, row)
    mass = np.diag(random.uniform(0.5, 2, n))
    forced = int(random.integers(n))
    return _bare(seed, (mass, damping, stiffness), tuple(range(n)), tuple(links), forced)


def beam(random: Random, seed: int) -> JointModel:
    """A cantilever of two to four elements, EI = rho A = L = 1, damped in its modes; driven at a node."""
    elements = int(random.integers(2, 5))
    zeta, n, h = _log(random, 0.005, 0.03), 2 * elements, 1 / elements
    mass, stiffness = np.zeros((n + 2, n + 2)), np.zeros((n + 2, n + 2))
    for e in range(elements):
        at = slice(2 * e, 2 * e + 4)
        scale = np.outer([1, h, 1, h], [1, h, 1, h])
        stiffness[at, at] += (
            scale / h**3 * np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
        )
        mass[at, at] += (
            scale
            * h
            / 420
            * np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]])
        )
    mass, stiffness = mass[2:, 2:], stiffness[2:, 2:]
    squares, shapes = scipy.linalg.eigh(stiffness, mass)
    damping = mass @ shapes @ np.diag(2 * zeta * np.sqrt(squares)) @ shapes.T @ mass
    places = tuple(range(0, n, 2))
    return _bare(seed, (mass, damping, stiffness), places, (), int(random.integers(elements)))


def _bare(
    seed: int, matrices: tuple[Array, Array, Array], places: tuple[int, ...], links: Links, forced: int
) -> JointModel:
    mass, damping, stiffness = matrices
    return JointModel(
        seed=seed,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        places=places,
        links=links,
        forced=forced,
    )


def _attached(random: Random, model: JointModel) -> JointModel:
    """Two to eight joints, the first of friction, and in a third of the models a cubic spring or two."""
    typical, found = 3.0 if model.beam else 1.0, list[Attached]()
    for k in range(int(random.integers(2, 9))):
        kinds = 4 if k else 3
        kind = KINDS[int(random.choice(kinds, p=np.array(SHARES[:kinds]) / sum(SHARES[:kinds])))]
        ends = _ends(random, model, kind, found)
        if ends is None:
            kind, ends = "stop", _pair(random, model)
        stiffness = typical * _log(random, *STIFFNESS[kind]) if kind in STIFFNESS else 0.0
        below = kind == "stop" and bool(random.random() < 0.5)
        found.append(Attached(kind=kind, i=ends[0], to=ends[1], stiffness=stiffness, below=below))
    if random.random() < 1 / 3:
        for _ in range(int(random.integers(1, 3))):
            i, to = _pair(random, model)
            stiffness = typical * _log(random, *STIFFNESS["cubic"])
            found.append(Attached(kind="cubic", i=i, to=to, stiffness=stiffness))
    return replace(model, attached=tuple(found))


def _pair(random: Random, model: JointModel) -> tuple[int, int | None]:
    i = int(random.integers(len(model.places)))
    to = int(random.integers(len(model.places))) if random.random() < 0.5 else None
    return i, None if to == i else to


def _ends(
    random: Random, model: JointModel, kind: str, found: Sequence[Attached]
) -> tuple[int, int | None] | None:
    """Ends of another joint: sliders side by side are one Iwan joint, what friction holds is independent."""
    coulombs = [model.row(a.i, a.to) for a in found if a.kind == "coulomb"]
    sliders = [{a.i, a.to} for a in found if a.kind in ("jenkins", "iwan")]
    for _ in range(20):
        i, to = _pair(random, model)
        rank = np.linalg.matrix_rank(np.array([*coulombs, model.row(i, to)]))
        if kind == "coulomb" and rank == len(coulombs) + 1:
            return i, to
        if kind in ("jenkins", "iwan") and {i, to} not in sliders:
            return i, to
        if kind == "stop":
            return i, to
    return None


def _sized(random: Random, model: JointModel) -> JointModel:
    """The range, limits and gaps, of linear responses."""
    stuck = model.stiffness.copy()
    for a in model.attached:
        if a.kind in SLIDERS:
            stuck += a.stiffness * np.outer(model.row(a.i, a.to), model.row(a.i, a.to))
    low = random.uniform(0.65, 0.85) * _lowest(model.mass, model.stiffness)
    high = random.uniform(1.15, 1.5) * _lowest(model.mass, stuck)
    responses = [_responses(model, stuck, w) for w in np.linspace(low, high, FREQUENCIES)]
    swings, holds = np.abs([r[0] for r in responses]), np.abs([r[1] for r in responses])
    loose = bool(random.random() < LOOSE)
    sized = [
        _given(random, a, (holds if a.kind == "coulomb" else swings)[:, k], loose or k == 0)
        for k, a in enumerate(model.attached)
    ]
    return _slipping(replace(model, bounds=(low, high), attached=tuple(sized)), stuck)


def _slipping(model: JointModel, stuck: Array) -> JointModel:
    """The model with smaller limits, so that not all that sticks can do so at an end of the range."""
    least = min(_needed(model, stuck, Omega) for Omega in model.bounds)
    part = min(1.0, least / NEEDED)
    each = [replace(a, limits=tuple(part * limit for limit in a.limits)) for a in model.attached]
    return replace(model, attached=tuple(each))


def _needed(model: JointModel, stuck: Array, Omega: float) -> float:
    """The largest of the forces in the joints, none of them slipping, over its limit."""
    held = [a for a in model.attached if a.kind == "coulomb"]
    rows = np.array([model.row(a.i, a.to) for a in held]).reshape(-1, len(stuck))
    dynamic = stuck + 1j * Omega * model.damping - Omega**2 * model.mass
    whole = np.block([[dynamic, rows.T], [rows, np.zeros((len(held), len(held)))]])
    force = model.force * model.row(model.forced, None)
    swing, forces = np.split(np.linalg.solve(whole, np.append(force, np.zeros(len(held)))), [len(stuck)])
    parts = [float(abs(size) / a.limits[0]) for size, a in zip(forces, held, strict=True)]
    for a in model.attached:
        if a.kind in SLIDERS:
            parts.append(float(a.stiffness * abs(model.row(a.i, a.to) @ swing) / sum(a.limits)))
    return max(parts)


def _given(random: Random, a: Attached, seen: Array, loose: bool) -> Attached:
    """A joint with its limits or gap; `seen` is its amplitude in the range, of u or of what holds it."""
    ends = float(min(seen[0], seen[-1]))
    most = min(float(seen.max()), MOST * float(max(seen[0], seen[-1])))
    if a.kind == "cubic":
        return replace(a, stiffness=a.stiffness / ends**2)
    if a.kind == "stop":
        return replace(a, gap=_log(random, 0.3 * ends, 0.7 * most))
    part = random.uniform(0.2, 0.6) * ends if loose else _log(random, 0.2 * ends, 0.8 * most)
    if a.kind == "coulomb":
        return replace(a, limits=(part,))
    if a.kind == "jenkins":
        return replace(a, limits=(a.stiffness * part,))
    sliders = int(random.integers(2, 5))
    sizes = np.linspace(0.3, 1.3, sliders) * random.uniform(0.9, 1.1, sliders)
    return replace(a, limits=tuple(float(size * a.stiffness / sliders * part) for size in sizes))


def _responses(model: JointModel, stuck: Array, Omega: float) -> tuple[Array, Array]:
    """Of all that is attached u with the Coulomb joints loose, and the force that would hold it alone."""
    force = model.force * model.row(model.forced, None)
    dynamic = stuck + 1j * Omega * model.damping - Omega**2 * model.mass
    rows = np.array([model.row(a.i, a.to) for a in model.attached])
    flexible = rows @ np.linalg.solve(dynamic, np.column_stack([force, rows.T]))
    return flexible[:, 0], flexible[:, 0] / np.diag(flexible[:, 1:])


def _lowest(mass: Array, stiffness: Array) -> float:
    return math.sqrt(scipy.linalg.eigh(stiffness, mass, eigvals_only=True)[0])


def _log(random: Random, low: float, high: float) -> float:
    return float(np.exp(random.uniform(math.log(low), math.log(high))))
