"""Whether a step passes a resonance unseen.

Where a complex pair of multipliers passes near +1 the free vibration is in tune with a harmonic of the
excitation (a superharmonic resonance): the branch may leave its course for a peak far narrower than a step
and return to it. Along the branch the pair's part of the motion is about f/(1 - mu), f its excitation, which
follows from how fast that part changes at the step's ends; what of it the cubic through the ends, with their
tangents, does not show has passed unseen. However near +1 a pair comes that nothing excites, it is of no
matter. Where a pair passes -1 or +1 it may also leave the unit circle and come back. Its solution is
followed over the whole period, so that full turns count.
"""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np

from periodic.checks import positive
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Complex, Pair, Spectrum, nearest

ORDER = 4
"""What a cubic does not show goes with this power of the step."""

TINY = 1e-9
"""Least distance of a multiplier from +1."""

INSIDE = np.array([0.0, 1.0, *np.linspace(0, 1, 9)[1:-1]])
"""Places in a step at which it is looked at, both ends first; also those where it is nearest +1."""


FADED = 1e-3
"""Multipliers nearer to 0 than this are too far from the unit circle to reach it and come back in a step."""

COUPLED = 0.2
"""Least coupling of two pairs that may leave the unit circle, over their distance from it in log |mu|."""


@dataclass(frozen=True, kw_only=True)
class WindingLimits:
    """How far multipliers may turn in a step.

    Parameters
    ----------
    visible : float
        The largest part of a motion that may pass unseen, in peaks to peak.
    most, least : float
        Largest turn of a multiplier (rad), and one that is always allowed.
    light : float
        Pairs of smaller modulus are damped too well for a narrow peak.
    """

    visible: float = 0.02
    most: float = 1.4
    least: float = 0.002
    light: float = 0.8

    def __post_init__(self) -> None:
        for name in ("visible", "most", "least", "light"):
            positive(name, getattr(self, name))


@dataclass(frozen=True)
class Motion:
    """An orbit's spectrum, and how its states at the beginning of the period (n,) change along the branch.

    change: over a whole step, in peaks to peak of the orbit.
    """

    spectrum: Spectrum
    change: Array


@dataclass(frozen=True)
class Rotation:
    """How far multipliers turn in a step and would in the next one as long, where 1 is the most."""

    ratio: float
    ahead: float


def rotated(before: Motion, after: Motion, limits: WindingLimits) -> Rotation:
    """How far lightly damped pairs of multipliers turn between two orbits.

    Those that the motion excites the less the nearer they are to +1, and none so far that it is lost.
    """
    excited, begins, ways, turn = [], [], [], 0.0
    for a, b in _matched(before.spectrum, after.spectrum):
        way = complex(math.log(b.modulus / a.modulus), a.turn(b))
        if min(a.modulus, b.modulus) > limits.light and abs(way.imag) > limits.least:
            excitation = min(_excitation(a, way, before.change), _excitation(b, way, after.change))
            excited.append((excitation, excitation))
            begins.append([complex(math.log(pair.modulus), pair.argument) for pair in (a, b)])
            ways.append((way, way))
            turn = max(turn, abs(way.imag) / limits.most)
    if not ways:
        return Rotation(0.0, 0.0)
    unresolved = np.array(excited) * _unresolved(np.array(begins), np.array(ways)) / limits.visible
    ratio, ahead = (max(turn, float(size) ** (1 / ORDER)) for size in unresolved.max(axis=0))
    return Rotation(ratio, ahead)


def _excitation(pair: Pair, way: complex, change: Array) -> float:
    """The size of f, from the change of the pair's part f/(1 - mu) over a step in which log mu goes `way`."""
    if pair.left is None:
        return np.inf
    return 2 * abs(complex(pair.left @ change)) * pair.distance**2 / (pair.modulus * abs(way))


def _unresolved(begin: Complex, way: Complex) -> Array:
    """The largest distance of 1/(1 - mu) from the cubic through its ends while log mu goes from `begin`.

    Of each of many, in arrays of one shape.
    """
    begin, way = begin[..., None], way[..., None]
    inside = np.broadcast_to(INSIDE, (*begin.shape[:-1], len(INSIDE)))
    place = np.concatenate([inside, _nearest(begin.imag, way.imag)], axis=-1)
    mu = np.exp(begin + way * place)
    value = 1 / np.where(np.abs(1 - mu) > TINY, 1 - mu, TINY)
    first, last, out, back = (f[..., k : k + 1] for f in (value, way * mu * value**2) for k in (0, 1))
    rest = 1 - place
    cubic = (1 + 2 * place) * rest**2 * first + place**2 * (3 - 2 * place) * last
    cubic = cubic + place * rest * (rest * out - place * back)
    return np.asarray(np.abs(value - cubic).max(axis=-1))


def _nearest(argument: Array, turn: Array) -> Array:
    """Where multipliers that turn are nearest +1, as parts of the way; 0 for what is missing."""
    ends = argument, argument + turn
    first, last = (np.ceil(end / math.tau) for end in (np.minimum(*ends), np.maximum(*ends)))
    past = first + np.arange(int((last - first).max()))
    return np.asarray(np.where(past < last, (math.tau * past - argument) / turn, 0.0))


def pair_crossings(before: Spectrum, after: Spectrum, sign: int) -> list[tuple[float, float]]:
    """Return where pairs turn past `sign` (+1 or -1) between two orbits, as parts of the way, and moduli.

    Of a pair that seems to turn by more than half a turn it is not sure which way it goes: both are taken.
    Pairs that have faded at both orbits do not count.
    """
    offset, found = 0.0 if sign > 0 else math.pi, []
    for a, b in _matched(before, after):
        if max(a.modulus, b.modulus) < FADED:
            continue
        shortest = a.turn(b)
        for turn in (shortest, shortest - math.copysign(math.tau, shortest))[: 1 + (abs(shortest) > math.pi)]:
            low, high = sorted((a.argument, a.argument + turn))
            first, last = (math.floor((end - offset) / math.tau) for end in (low, high))
            places = ((offset + math.tau * past - a.argument) / turn for past in range(first + 1, last + 1))
            found += [(p, a.modulus ** (1 - p) * b.modulus**p) for p in places]
    return found


@dataclass(frozen=True)
class Collision:
    """Two pairs that collide between two orbits: at which part of the way, and log |mu| nearer the circle.

    Pairs that collide may leave the unit circle together, one outwards, and come back.
    """

    place: float
    growth: float


def collisions(before: Spectrum, after: Spectrum) -> list[Collision]:
    """Return where pairs that are coupled enough to leave the unit circle collide between two orbits."""
    if len(after.pairs) < len(before.pairs):
        return [Collision(1 - m.place, m.growth) for m in collisions(after, before)]
    found, ways = [], [(a, b, a.turn(b)) for a, b in _matched(before, after)]
    for (i, (a, b, turn)), (j, (c, d, other)) in combinations(enumerate(ways), 2):
        if a.place == c.place or b.place == d.place:  # one pair that is the nearest of two
            continue
        for sign in (1, -1):
            gap, closing = a.argument - sign * c.argument, turn - sign * other
            low, high = sorted((gap, gap + closing))
            for past in range(math.ceil(low / math.tau), math.ceil(high / math.tau)):
                place = (math.tau * past - gap) / closing
                growth = min((_growth(*pairs, place) for pairs in ((a, b), (c, d))), key=abs)
                if _coupling(before, after)[i, j] > COUPLED * abs(growth):
                    found.append(Collision(place, growth))
    return found


def _growth(before: Pair, after: Pair, place: float) -> float:
    """log |mu| of a pair at a part of its way."""
    return (1 - place) * math.log(before.modulus) + place * math.log(after.modulus)


def confined(before: Spectrum, after: Spectrum) -> bool:
    """Whether no pair is coupled enough to its own conjugate to leave the unit circle at +1 or -1.

    As far as two orbits tell. At the one, mu = r exp(i a) and its conjugate are eigenvalues; at the other,
    where the pair has turned to b, they mix by r c (1 - sin b / sin a), c the coupling by which they part
    where they meet. The less of both ways is taken, which is never far above r c.
    """
    first, last = _own_coupling(before, after), _own_coupling(after, before)
    for a, b in _matched(before, after):
        modulus = max(a.modulus, b.modulus)
        coupling = min(first[a.place], last[b.place])
        if modulus >= FADED and not coupling < COUPLED * abs(math.log(modulus)):
            return False
    return True


def _own_coupling(own: Spectrum, other: Spectrum) -> dict[int, float]:
    """How much each pair of an orbit mixes with its conjugate in the monodromy matrix of another.

    In parts of its modulus, by its place among the multipliers.
    """
    k, mixed = len(own.pairs), _mixed(own, other)
    both = np.sqrt(np.diag(mixed[:k, k:]) * np.diag(mixed[k:, :k]))
    each = zip(own.pairs, both.tolist(), strict=True)
    return {pair.place: size / pair.modulus for pair, size in each}


@lru_cache(maxsize=4)
def _coupling(own: Spectrum, other: Spectrum) -> Array:
    """How much each two pairs of an orbit mix in the monodromy matrix of another, (pairs, pairs).

    The geometric mean of both ways, by which they may part where they meet. As much as can be where the two
    are known in other coordinates.
    """
    k, mixed = len(own.pairs), _mixed(own, other)
    blocks = [
        mixed[rows, columns]
        for rows in (slice(0, k), slice(k, None))
        for columns in (slice(0, k), slice(k, None))
    ]
    largest = np.max(blocks, axis=0)
    return np.asarray(np.sqrt(largest * largest.T))


def _mixed(own: Spectrum, other: Spectrum) -> Array:
    """The size of what each multiplier of the pairs of an orbit, then of their conjugates, becomes of each
    in the monodromy matrix of another; infinite where that is not known."""
    chosen = [pair.place for pair in own.pairs]
    both = np.concatenate([own.vectors[:, chosen], own.vectors[:, chosen].conj()], axis=1)
    matrix = _in_frame_of(own, other)
    if matrix is not None:
        with contextlib.suppress(np.linalg.LinAlgError):
            return np.abs(np.linalg.pinv(both) @ matrix @ both)
    return np.full((both.shape[1], both.shape[1]), np.inf)


def _in_frame_of(own: Spectrum, other: Spectrum) -> Array | None:
    """The other's monodromy matrix in the subspace of an orbit's own, None where their coordinates differ."""
    if own.frame is None or other.frame is None:
        return other.monodromy
    if len(own.frame) != len(other.frame):
        return None
    rotated = other.frame.T @ own.frame
    return np.asarray(rotated.T @ other.monodromy @ rotated)


@lru_cache(maxsize=4)
def _matched(before: Spectrum, after: Spectrum) -> list[tuple[Pair, Pair]]:
    """The pairs of two orbits, each of the side that has fewer with the nearest of the other.

    A pair may be born of two real multipliers or end in them.
    """
    if len(before.pairs) <= len(after.pairs):
        return list(zip(before.pairs, nearest(before.pairs, after.pairs), strict=True))
    return list(zip(nearest(after.pairs, before.pairs), after.pairs, strict=True))
