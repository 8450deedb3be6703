"""Multipliers, pairs and their turns, of matrices that are given: values by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.stability import graded, multipliers, product, shares, winding
from periodic.stability.multipliers import Pair, Spectrum, apart, nearest, without_trivial
from periodic.stability.winding import Motion, WindingLimits, collisions, pair_crossings, rotated


def pair(argument: float, rotated: float = 0.0, modulus: float = 1.0, place: int = 0) -> Pair:
    """A pair of multipliers."""
    distance = abs(1 - modulus * np.exp(1j * argument))
    return Pair(argument, modulus, distance, rotated, place=place)


def turn(angle: float, modulus: float = 1.0) -> Any:
    """A rotation, scaled."""
    c, s = modulus * np.cos(angle), modulus * np.sin(angle)
    return np.array([[c, -s], [s, c]])


def spectrum(
    *pairs: tuple[float, float], real: tuple[float, ...] = (), trivial: int = 0, steps: int = 200
) -> Spectrum:
    """Motions that turn evenly by angles, which may be more than a turn, and grow to moduli."""
    size = 2 * len(pairs) + len(real)
    found = np.zeros((steps + 1, size, size))
    for k, part in enumerate(np.linspace(0, 1, steps + 1)):
        for j, (angle, modulus) in enumerate(pairs):
            found[k, 2 * j : 2 * j + 2, 2 * j : 2 * j + 2] = turn(part * angle, modulus**part)
        for j, value in enumerate(real, start=2 * len(pairs)):
            found[k, j, j] = 1 + part * (value - 1)
    return Spectrum(found, trivial)


@pytest.mark.parametrize(
    ("begin", "end", "angle"),
    [
        (pair(0.5, 0.5), pair(0.7, 0.7), 0.2),
        (pair(3.0, 3.0), pair(-3.0, math.tau - 3.0), math.tau - 6.0),
        (pair(0.5, 0.5), pair(0.6, 0.6 + math.tau), 0.1 + math.tau),
        (pair(0.5, 0.5), pair(0.4, 0.4 - 2 * math.tau), -0.1 - 2 * math.tau),
    ],
)
def test_turn_of_a_multiplier(begin: Pair, end: Pair, angle: float) -> None:
    """Assert the turn, whole turns of the solution included."""
    assert begin.turn(end) == pytest.approx(angle, abs=1e-12)


def test_other_member_of_a_pair() -> None:
    """Assert its argument and rotation, and the conjugate left eigenvector."""
    one = Pair(0.5, 0.9, 0.4, 6.0, np.array([1 + 2j]), 3)
    other = one.conjugate()
    assert (other.argument, other.rotated, other.modulus, other.distance, other.place) == (
        -0.5,
        -6.0,
        0.9,
        0.4,
        3,
    )
    assert other.left is not None and other.left.tolist() == [1 - 2j]


@pytest.mark.parametrize("count", [1, 2, 6])
def test_pairs_lead_to_the_nearest(count: int) -> None:
    """Assert the member to which each leads: by itself up to three pairs, and as many together."""
    own = [pair(0.3 + 0.4 * k, 0.3 + 0.4 * k) for k in range(count)]
    moved = [pair(0.35 + 0.4 * k, 0.35 + 0.4 * k, place=k) for k in range(count)]
    assert [(found.place, found.argument) for found in nearest(own, moved)] == [
        (k, moved[k].argument) for k in range(count)
    ]
    turned = [found.conjugate() for found in moved][::-1]
    assert [found.place for found in nearest(own, turned)] == list(range(count))
    assert [found.argument for found in nearest(own, turned)] == pytest.approx([m.argument for m in moved])


def test_pairs_of_motions_that_turn_evenly() -> None:
    """Assert argument, modulus, distance from 1 and turn of two pairs, one with a whole turn."""
    found = sorted(spectrum((0.5, 0.9), (1.0 + math.tau, 0.8)).pairs, key=lambda p: p.rotated)
    assert [p.argument for p in found] == pytest.approx([0.5, 1.0], abs=1e-10)
    assert [p.modulus for p in found] == pytest.approx([0.9, 0.8], abs=1e-10)
    assert [p.rotated for p in found] == pytest.approx([0.5, 1.0 + math.tau], abs=1e-10)
    assert found[0].distance == pytest.approx(abs(1 - 0.9 * np.exp(0.5j)), abs=1e-12)


def test_left_eigenvectors_measure_a_pairs_part() -> None:
    """Assert 2 |left x| = 1 for x = (1, 0), the most that its motion becomes, and 0 beside it."""
    (found, _) = spectrum((0.5, 0.9), (2.0, 0.5)).pairs
    assert found.left is not None
    assert 2 * abs(found.left @ np.array([1.0, 0, 0, 0])) == pytest.approx(1.0, abs=1e-10)
    assert abs(found.left @ np.array([0, 0, 1.0, 0])) < 1e-12


def test_a_pair_that_is_trivial_is_left_out() -> None:
    """Assert that the multipliers nearest 1 are not among the pairs, nor the others."""
    found = spectrum((0.01, 1.0), (1.0, 0.9), trivial=2)
    assert [p.modulus for p in found.pairs] == pytest.approx([0.9])
    assert np.abs(found.nontrivial) == pytest.approx([0.9, 0.9])


def test_multipliers_nearest_1_are_taken_out() -> None:
    """Assert which are left of four, for none, one and two."""
    found = np.array([0.5, 1.01, 0.9, -1.0], dtype=complex)
    assert without_trivial(found, 0) is found
    assert without_trivial(found, 1).tolist() == [0.5, 0.9, -1.0]
    assert without_trivial(found, 2).tolist() == [0.5, -1.0]


@pytest.mark.parametrize(
    ("nearest_one", "trivial", "known"), [(1.09, 1, True), (1.11, 1, False), (1.5, 0, True)]
)
def test_spectrum_is_known_where_1_is_left(nearest_one: float, trivial: int, known: bool) -> None:
    """Assert that the multiplier that is 1 is within a tenth of it."""
    assert Spectrum(np.diag([nearest_one, 0.2])[None], trivial).known is known
    assert (
        Spectrum(np.diag([3.0, 0.2])[None]).radius == 3.0
        and Spectrum(np.diag([0.5, 0.2])[None]).radius == 1.0
    )


def test_distance_of_spectra() -> None:
    """Assert the larger of |2.1 - 2| and |1.1^2 + 1 - 2| / 2, relative to the largest multiplier."""
    one, two = np.diag([1.0, 1.0]), np.diag([1.1, 1.0])
    assert apart(one, two) == pytest.approx(max(0.1, 0.21 / 2))
    assert apart(np.diag([1.0, -1.0]), np.diag([2.0, -2.0])) == pytest.approx(3.0)
    assert Spectrum(np.diag([2.0, 1.0])[None]).apart(np.diag([2.2, 1.0])) == pytest.approx(max(0.1, 0.105))


def test_rotation_along_chords() -> None:
    """Assert the angle between unit vectors, and that a reversal turns nothing."""
    begin = np.array([[[1.0 + 0j]], [[2.0 + 0j]], [[1.0 + 0j]], [[0j]]])
    end = np.array([[[np.exp(0.3j)]], [[np.exp(-2.0j)]], [[-1.0 + 0j]], [[1.0 + 0j]]])
    assert multipliers._rotations(begin, end)[:, 0] == pytest.approx([0.3, -2.0, 0.0, 0.0], abs=1e-7)


def test_left_eigenvector_from_the_triangle() -> None:
    """Assert left M = mu left, scaled to left v = 1, where a multiplier of 0 spoils the inverse."""
    matrix = np.array([[0.5, 1.0, 0.0], [0.0, 0.25, 1.0], [0.0, 0.0, 0.125]])
    found = Spectrum(matrix[None])
    found.__dict__["_inverse"] = None
    for k, mu in enumerate(found.multipliers):
        left = found._left(k)
        assert left is not None
        assert left @ matrix == pytest.approx(mu * left, abs=1e-12)
        assert left @ found.vectors[:, k] == pytest.approx(1.0, abs=1e-12)
    twice = Spectrum(np.array([[1.0, 1.0], [0.0, 1.0]])[None])
    assert twice._inverse is None and twice._left(0) is None


@pytest.mark.parametrize(
    ("angles", "sign", "places"),
    [
        ((-0.1, 0.3), 1, [0.25]),
        ((0.1, 0.3), 1, []),
        ((3.0, 3.3), -1, [(math.pi - 3.0) / 0.3]),
        ((3.0, 3.3), 1, []),
        ((-0.2, -0.1), 1, []),
    ],
)
def test_places_where_pairs_pass_1(
    angles: tuple[float, float], sign: int, places: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert the parts of the way at which arguments pass 0 or pi, and the modulus there, 0.8 to 0.9."""
    ends = pair(angles[0], angles[0], 0.8), pair(angles[1], angles[1], 0.9)
    monkeypatch.setattr(winding, "_matched", lambda *_: [ends])
    given: Any = None
    found = pair_crossings(given, given, sign)
    assert [place for place, _ in found] == pytest.approx(places)
    assert [size for _, size in found] == pytest.approx([0.8 ** (1 - p) * 0.9**p for p in places])


def test_a_pair_that_may_turn_either_way(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that both ways are taken where it turns by more than half a turn: past 0, or past pi."""
    begin, end = pair(0.5, 0.5), pair(0.5 + 3.5 - math.tau, 0.5 + 3.5)
    monkeypatch.setattr(winding, "_matched", lambda *_: [(begin, end)])
    given: Any = None
    (past_minus,) = pair_crossings(given, given, -1)
    assert past_minus[0] == pytest.approx((math.pi - 0.5) / 3.5)
    (past_plus,) = pair_crossings(given, given, 1)
    assert past_plus[0] == pytest.approx(0.5 / (math.tau - 3.5))


def test_what_a_cubic_does_not_show() -> None:
    """Assert the largest distance of 1 / (1 - mu) from the cubic through its ends, by direct evaluation."""
    begin, way = np.array([[complex(-0.1, -0.2)]]), np.array([[complex(0.0, 0.5)]])
    (found,) = winding._unresolved(begin, way)[0]

    def value(t: float) -> complex:
        return 1 / (1 - np.exp(begin[0, 0] + way[0, 0] * t))

    def slope(t: float) -> complex:
        mu = np.exp(begin[0, 0] + way[0, 0] * t)
        return way[0, 0] * mu / (1 - mu) ** 2

    places = [*np.linspace(0, 1, 9), 0.4]
    cubic = [
        (1 + 2 * t) * (1 - t) ** 2 * value(0)
        + t**2 * (3 - 2 * t) * value(1)
        + t * (1 - t) ** 2 * slope(0)
        - t**2 * (1 - t) * slope(1)
        for t in places
    ]
    assert found == pytest.approx(
        max(abs(value(t) - c) for t, c in zip(places, cubic, strict=True)), rel=1e-10
    )


def test_places_nearest_1_on_a_turn() -> None:
    """Assert where arguments pass multiples of a whole turn, 0 standing for none."""
    found = winding._nearest(np.array([[-0.2], [0.1]]), np.array([[0.5], [0.2]]))
    assert found == pytest.approx(np.array([[0.4], [0.0]]))
    twice = winding._nearest(np.array([[-0.2]]), np.array([[math.tau + 0.5]]))
    assert twice == pytest.approx(np.array([[0.2, math.tau + 0.2]]) / (math.tau + 0.5))


def test_excitation_of_a_pair() -> None:
    """Assert 2 |left . change| d^2 / (|mu| |way|), infinite where the eigenvector is not known."""
    own = Pair(0.5, 0.9, 0.4, 0.5, np.array([1.0 + 0j, 2.0]))
    assert winding._excitation(own, 0.3 + 0.4j, np.array([0.1, 0.2])) == pytest.approx(
        2 * 0.5 * 0.16 / (0.9 * 0.5)
    )
    assert winding._excitation(pair(0.5), 1.0, np.zeros(2)) == np.inf


def test_turn_of_light_pairs_bounds_a_step() -> None:
    """Assert the turn over 1.4 rad where nothing is excited; none of heavily damped and still pairs."""
    still = np.zeros(2)

    def ratio(first: tuple[float, float], last: tuple[float, float]) -> float:
        return rotated(Motion(spectrum(first), still), Motion(spectrum(last), still), WindingLimits()).ratio

    assert ratio((1.0, 0.95), (1.35, 0.95)) == pytest.approx(0.25)
    assert ratio((1.0, 0.75), (1.35, 0.95)) == 0.0
    assert ratio((1.0, 0.95), (1.0015, 0.95)) == 0.0


@pytest.mark.parametrize(("most", "visible"), [(1.4, 0.02), (1.4, 0.002)])
def test_unseen_motion_bounds_a_step(most: float, visible: float) -> None:
    """Assert the fourth root of what has passed unseen over what may, from its pieces."""
    change, limits = np.array([0.3, 0.0]), WindingLimits(most=most, visible=visible)
    before, after = Motion(spectrum((0.1, 0.95)), change), Motion(spectrum((0.3, 0.95)), change)
    (one, other) = winding._matched(before.spectrum, after.spectrum)[0]
    way = complex(0.0, one.turn(other))
    excited = min(winding._excitation(p, way, change) for p in (one, other))
    left = winding._unresolved(np.array([[complex(math.log(0.95), one.argument)]]), np.array([[way]]))[0, 0]
    expected = max(abs(way.imag) / most, (excited * left / visible) ** 0.25)
    assert rotated(before, after, limits).ratio == pytest.approx(expected, rel=1e-9)


def test_pairs_that_meet_half_way() -> None:
    """Assert place and growth where an argument passes that of another pair, to which it is coupled.

    One goes from 1 to 1.1, with a whole turn within the period, the other stays at 1.05.
    """
    first = spectrum((1.0 + math.tau, 0.98), (1.05, 0.9))
    mixed = spectrum((1.1 + math.tau, 0.98), (1.05, 0.9))
    basis = np.linalg.qr(np.eye(4) + 0.4 * np.random.default_rng(1).standard_normal((4, 4)))[0]
    other = Spectrum(basis @ mixed.fundamental @ basis.T)
    (one,), (back,) = collisions(first, other), collisions(other, first)
    assert (one.place, one.growth) == (pytest.approx(0.5), pytest.approx(np.log(0.98)))
    assert (back.place, back.growth) == (pytest.approx(0.5), pytest.approx(np.log(0.98)))
    assert collisions(first, mixed) == []
    assert winding._growth(pair(0.0, modulus=0.5), pair(0.0, modulus=2.0), 0.25) == pytest.approx(
        -0.5 * np.log(2)
    )


def test_multipliers_of_a_product_over_decades() -> None:
    """Assert diagonal steps exactly, over 200 decades, and a pair of modulus 1 beside a small one."""
    steps = np.array([np.diag([1e5, 1e-5])] * 20)
    assert product.multipliers(steps, 0.0) == pytest.approx([1e100, 1e-100], rel=1e-12)
    mixed = np.zeros((10, 3, 3))
    mixed[:, :2, :2] = turn(0.1)
    mixed[:, 2, 2] = 1e-2
    found = product.multipliers(mixed)
    assert found[:2] == pytest.approx(np.exp([1j, -1j]), abs=1e-10) or found[:2] == pytest.approx(
        np.exp([-1j, 1j]), abs=1e-10
    )
    assert found[2] == pytest.approx(1e-20, rel=1e-10)
    assert product.multipliers(np.array([[[2.0]], [[-3.0]]]))[0] == -6.0


def test_motions_that_a_step_loses_have_no_multiplier() -> None:
    """Assert 0 for what one step makes smaller than its relative error of the largest."""
    steps = np.array([np.diag([1.0, 1e-9]), np.diag([1.0, 1.0])])
    assert product.multipliers(steps, 1e-8).tolist() == [1.0, 0.0]
    assert product.multipliers(steps, 1e-10) == pytest.approx([1.0, 1e-9])


def test_steps_are_multiplied_up_while_they_are_well_conditioned() -> None:
    """Assert pieces whose conditions multiply to less than 1000, with the same product."""
    steps = np.array([np.diag([10.0, 1.0])] * 5)
    found = product._joined(steps)
    assert found[:, 0, 0] == pytest.approx([1e2, 1e2, 1e1], rel=1e-12)
    bad = np.array([np.diag([1.0, 0.0]), np.eye(2), np.eye(2)])
    assert len(product._joined(bad)) == 2


def test_flow_taken_out_of_steps() -> None:
    """Assert the other multiplier, 0.5, of a flow along (1, 1) that comes back, and what strays."""
    along, across = np.array([1.0, 1.0]) / np.sqrt(2), np.array([1.0, -1.0]) / np.sqrt(2)
    step = np.outer(along, along) + 0.5 * np.outer(across, across)
    flow = np.array([along, along, along])
    steps = np.array([step, step])
    assert np.abs(graded._transverse(steps, flow)).ravel() == pytest.approx([0.5, 0.5])
    assert graded._stray(steps, flow) == pytest.approx(0.0, abs=1e-15)
    assert graded._stray(1.2 * steps, flow) == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("growth", "trivial", "count", "plain"),
    [(1e2, 1, 2, True), (1e4, 1, 2, False), (1e2, 1, 3, False)],
)
def test_which_spectrum_an_orbit_has(growth: float, trivial: int, count: int, plain: bool) -> None:
    """Assert that from the steps where motions grow by more than three decades, or steps are as many."""
    operator = SimpleNamespace(growth=growth, steps=np.array([np.eye(2)] * count), flow=None)
    found = graded.spectrum_of(np.array([np.eye(2)] * 3), operator, trivial)
    assert (type(found) is Spectrum) is plain
    assert type(graded.spectrum_of(np.array([np.eye(2)]), None, trivial)) is Spectrum


def test_shares_of_intervals() -> None:
    """Assert the norm of each interval's part: M (D_{j+1} / Phi_{j+1} - D_j / Phi_j) of numbers 1, 2, 4."""
    coarse, fine = np.array([1.0, 2.0, 4.0]), np.array([1.0, 9.0, 2.2, 9.0, 4.8])
    found = shares.shares(coarse[:, None, None], fine[:, None, None])
    assert found is not None
    assert found == pytest.approx([4 * 0.2 / 2, 4 * (0.8 / 4 - 0.2 / 2)])
    assert shares.shares(coarse[:, None, None], fine[:4, None, None]) is None


@pytest.mark.parametrize("trivial", [0, 1])
def test_spectra_of_graded_steps_apart(trivial: int) -> None:
    """Assert the larger change of the first two sums of powers, in the radius, each over its power."""

    def stepping(*values: float) -> Any:
        """Steps of a half period each."""
        steps = np.array([np.diag(np.sqrt(values))] * 2)
        flow = np.tile([1.0, 0.0], (3, 1)) if trivial else None
        return SimpleNamespace(growth=1e9, steps=steps, flow=flow)

    own, other = stepping(1.0, 0.25), stepping(1.0, 0.49)
    found = graded.spectrum_of(np.array([np.eye(2)] * 2 + [np.diag([1.0, 0.25])]), own, trivial)
    assert isinstance(found, graded.GradedSpectrum)
    assert np.abs(found.multipliers) == pytest.approx([1.0, 0.25])
    first, second = 0.49 - 0.25, (0.49**2 - 0.25**2) / 2
    expected = max(first / found.radius, second / found.radius**2)
    assert found.apart(np.diag([1.0, 0.49]), other) == pytest.approx(expected)
    assert found.apart(np.diag([1.0, 0.25]), own) == pytest.approx(0.0, abs=1e-12)
