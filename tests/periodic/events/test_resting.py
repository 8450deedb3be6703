"""Complete chatter: from which bounces on a wall a motion comes to rest before the wall lets go of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along

from periodic.events import resting
from periodic.events.resting import Tail, bounced, lengthened, longest, neglected
from periodic.orbit.mesh import EventNode
from periodic.system import STUCK, Kind
from periodic.system.events import Surface


def test_longest_bounce_by_hand() -> None:
    """Assert that at e = 5/16 sigma is 1/2: (3 - 1/2) (1/2)^2 = 5/8 = 5/16 (3 - 1)."""
    assert longest(5 / 16) == pytest.approx(1 / 2 - 1 / 12, abs=1e-14)


@pytest.mark.parametrize("ratio", [0.05, 0.5, 0.9, 0.99])
@pytest.mark.parametrize(("part", "rests"), [(0.999, True), (1.001, False)])
def test_bounces_end_before_the_rest(ratio: float, part: float, rests: bool) -> None:
    """Assert that bounces under a force that falls to 0 end while it presses where the first is shorter."""
    assert _comes_to_rest(ratio, part * longest(ratio)) == rests


def _comes_to_rest(ratio: float, first: float) -> bool:
    """Whether bounces under s'' = t - 1 end before t = 1; the first would last `first` under s'' = -1."""
    t, speed = 0.0, first / 2
    while speed > 1e-12:
        # s = w u - (1 - t) u^2/2 + u^3/6 is 0 at the smaller root u of u^2/6 - (1 - t) u/2 + w.
        square = (1 - t) ** 2 / 4 - 2 * speed / 3
        if square < 0:
            return False
        length = 3 * ((1 - t) / 2 - square**0.5)
        speed = -ratio * (speed - (1 - t) * length + length**2 / 2)
        t += length
    return t < 1


def bouncing() -> Any:
    """A wall 0 under x, which may be left at the switch 1."""
    system: Any = Surfaces([Surface(Kind.IMPACT, "wall", 0, column=0, leaves=1)], [[1.0, 0.0], [0.0, 0.0]])
    return system


TAIL = Tail(length=1.0, square=0.04, first=0.5, ratio=0.5, thrown=np.array([0.0, 3.0]))
SETTLED = EventNode(0, -1, modes=((0, STUCK), (7, 1)))


@pytest.fixture
def chattering(monkeypatch: pytest.MonkeyPatch) -> Any:
    """An orbit of peak to peak 2 with a settling impact at 1, of which the bounces left out are given."""
    monkeypatch.setattr(resting, "tied", lambda *_: [0])
    monkeypatch.setattr(resting, "tail", lambda *_: TAIL)
    nodes = [(SETTLED, 1.0), (EventNode(1, 1), 5.0)]
    return along(lambda tau: np.column_stack([np.sin(tau), 0 * tau]), nodes, intervals=16)


def test_error_of_bounces_left_out(chattering: Any) -> None:
    """Assert the root of the square over the peak to peak; infinite where they do not end before the rest."""
    span = chattering.span()
    assert neglected(bouncing(), chattering) == pytest.approx(0.2 / span)
    short = replace(chattering, phases=np.array([1.0, 1.6]))
    assert longest(0.5) * 0.6 < 0.5 < longest(0.5) * 4.0
    assert neglected(bouncing(), short) == np.inf


def test_bounces_that_an_error_asks_for(chattering: Any) -> None:
    """Assert bounces half as long as the ones before, as many as the error needs, the last one to rest.

    k more of them reduce the error by 2^(3k/2): here to SHORT times a tolerance of a hundredth.
    """
    error = neglected(bouncing(), chattering)
    assert lengthened(bouncing(), chattering, 2 * error) is None
    found = lengthened(bouncing(), chattering, error / 100)
    assert found is not None
    events, phases = found
    count = int(np.ceil(np.log(100 / resting.SHORT) / (1.5 * np.log(2))))
    lengths = 0.5 * 0.5 ** np.arange(count)
    assert phases[: count + 1] == pytest.approx(1.0 + np.append(0.0, np.cumsum(lengths)))
    assert events[0] == EventNode(0, -1, modes=((7, 1),))
    assert events[1:count] == (EventNode(0, -1),) * (count - 1)
    assert events[count] == EventNode(0, -1, modes=((0, STUCK),))
    assert events[count + 1 :] == (EventNode(1, 1),) and phases[-1] == 5.0


def test_bounces_in_a_guess(chattering: Any) -> None:
    """Assert speeds that fall from a throw to its opposite in each bounce, half as much in the next."""
    events = [EventNode(0, -1), EventNode(0, -1, modes=((0, STUCK),)), EventNode(1, 1)]
    nodes = list(zip(events, (1.0, 1.5, 5.0), strict=True))
    guess = along(lambda tau: np.zeros((len(tau), 2)), nodes, intervals=12)
    found = bounced(bouncing(), chattering, guess)
    first = found.nodes[:4, 1]
    assert first == pytest.approx([3.0, 1.5, 0.0, -1.5])
    assert not found.nodes[4:-1].any() and not found.nodes[:, 0].any()
    assert found.nodes[-1].tolist() == found.nodes[0].tolist()
    points = guess.mesh.scheme.points
    assert found.stages[0, :, 1] == pytest.approx(3.0 - 1.5 * points)
    assert found.stages[3, :, 1] == pytest.approx(-1.5 - 1.5 * points)
    assert not found.stages[4:].any()
    longer = [EventNode(0, -1), EventNode(0, -1), EventNode(0, -1, modes=((0, STUCK),)), EventNode(1, 1)]
    nodes = list(zip(longer, (1.0, 1.5, 1.75, 5.0), strict=True))
    second = bounced(bouncing(), chattering, along(lambda tau: np.zeros((len(tau), 2)), nodes, intervals=16))
    assert second.nodes[:8, 1] == pytest.approx([3.0, 1.5, 0.0, -1.5, 1.5, 0.75, 0.0, -0.75])


def test_nearest_event_node_of_a_switch() -> None:
    """Assert it around the period, and among other switches."""
    nodes = [(EventNode(0, -1), 0.2), (EventNode(1, 1), 3.0), (EventNode(0, -1), 4.0)]
    orbit = along(lambda tau: np.sin(tau)[:, None], nodes, intervals=12)
    assert [resting._nearest(orbit, 0, phase) for phase in (0.0, 2.0, 3.1, 6.2)] == [0, 0, 2, 0]


@pytest.mark.parametrize(
    ("ratio", "pressure", "ends"),
    [(0.5, 2.0, True), (0.25, 8.0, True), (0.5, 0.0, False), (0.5, -1.0, False), (1.0, 2.0, False)],
)
def test_bounces_left_out_before_rest(
    ratio: float, pressure: float, ends: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert lengths that fall by e from 2 e v/p, and their sum; infinite where nothing presses, or e = 1."""
    system = bouncing()
    system.offset = np.array([0.0, -pressure])
    thrown = np.array([0.0, 3.0])
    rest = np.array([[0.0, 4.0]])
    monkeypatch.setattr(resting, "before", lambda orbit, index: (0, np.array([[0.0, -1.0]]), np.array([1.0])))
    monkeypatch.setattr(resting, "mapped", lambda *_: (rest,))
    monkeypatch.setattr(resting, "bounce", lambda *_: (rest[0] + thrown, ratio))
    monkeypatch.setattr(resting, "slope_before", lambda *_: -1.5)
    orbit = along(lambda tau: np.zeros((len(tau), 2)), [(SETTLED, 1.0), (EventNode(1, 1), 5.0)], intervals=8)
    found = resting.tail(system, orbit, 0)
    assert found.ratio == ratio and found.thrown.tolist() == thrown.tolist()
    if not ends:
        assert (found.length, found.square, found.first) == (np.inf, np.inf, np.inf)
        return
    first = 2 * ratio * 1.5 / pressure
    each = first * ratio ** np.arange(60)
    assert found.first == pytest.approx(first) and found.length == pytest.approx(each.sum())
    speeds = 9.0 * ratio ** (2 * np.arange(60))
    assert found.square == pytest.approx((speeds * each).sum() / (3 * 2 * np.pi))
