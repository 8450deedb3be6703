"""Motions that settle, quickly or slowly, or never: those of maps of a period that are known."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.events.motions import PERIODS, STILL
from periodic.tracing import transient
from periodic.tracing.transient import CLOSE, TRANSIENTS, Transient

Array = np.ndarray


class Mapped:
    """A system whose motion over a period goes by a map of its state, through 0 on the way."""

    surfaces: tuple[Any, ...] = ()

    def __init__(self, over: Callable[[Array], Array]) -> None:
        self.over, self.begun = over, list[Array]()

    def motion(self, state: Array, algebraic: Array, parameter: Array, phase: Array, *rest: Any) -> Any:
        """The beginning, 0 and 1, and the end of a period."""
        self.begun.append(state)
        path = np.array([state, np.zeros(len(state)), np.ones(len(state)), self.over(state)])
        return SimpleNamespace(phase=phase, state=path, algebraic=np.zeros((4, 0)), modes=())


def settling(over: Callable[[Array], Array], *state: float) -> tuple[Mapped, Transient]:
    """A motion of a map from a state."""
    system = Mapped(over)
    begin = np.array(state), np.zeros(0), None
    return system, Transient(None, system, np.zeros(0), begin)  # type: ignore[arg-type]


@pytest.mark.parametrize(("still", "count"), [(STILL, 9), (CLOSE, 16)])
def test_motion_that_settles_soon(still: float, count: int) -> None:
    """Assert that it is followed until then, though Newton's method has its turn before."""
    system, motion = settling(lambda x: 0.5 + 0.5 * (x - 0.5), *np.ones(6))
    assert motion.settles(still) and len(system.begun) == count
    assert transient.apart(motion.path.state) < still


def test_motion_that_settles_slowly() -> None:
    """Assert that Newton's method takes over at its first turn, to either closeness."""
    system, motion = settling(lambda x: 0.5 + 0.98 * (x - 0.5), 1.0, 0.9)
    assert motion.settles(STILL)
    assert motion.place[0] == pytest.approx([0.5, 0.5], abs=STILL) and len(system.begun) < TRANSIENTS[0] + 12


def test_unstable_orbit_is_found_more_closely() -> None:
    """Assert that Newton's method comes as near as asked, where a motion leaves an orbit again."""

    def tent(x: Array) -> Array:
        return np.where(x < 0.5, 1.9 * x, 1.9 * (1 - x)) + 0.01 * np.sin(x)

    system, motion = settling(tent, 0.3)
    for still in (STILL, CLOSE):
        assert motion.settles(still) and transient.apart(motion.path.state) < still
    assert len(system.begun) < PERIODS


def test_newton_begins_at_the_closest_return(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the state at which the period began that nearly came back, not the last."""
    begins = list[float]()
    states = iter([0.9, 0.2, 0.7, 0.71, 0.1, 0.8, 0.3, 0.95, 0.4, 0.05, *[0.9, 0.1] * PERIODS])

    def fixed(own: Any, state: Array) -> None:
        begins.append(float(state[0]))

    monkeypatch.setattr(transient.ReturnMap, "fixed", fixed)
    system, motion = settling(lambda x: np.array([next(states)]), 0.5)
    assert not motion.settles(STILL) and len(system.begun) == PERIODS
    assert begins[0] == 0.7 and len(begins) == len(TRANSIENTS)


def test_motion_beyond_all_numbers() -> None:
    """Assert that it does not settle."""
    assert not settling(lambda x: x * np.inf, 1.0)[1].settles(STILL)


@pytest.mark.parametrize(
    ("gap", "size", "part"), [(0.9e-2, 1.0, 0.9e-2), (0.9e-2, 0.5, 1.8e-2), (0.0, 0.0, 0.0)]
)
def test_distance_from_coming_back(gap: float, size: float, part: float) -> None:
    """Assert it as a part of the largest peak to peak of a state."""
    path = np.array([[0.0, 0.0], [size, 0.1 * size], [gap, 0.0]])
    assert transient.apart(path) == pytest.approx(part)


@pytest.mark.parametrize(("vibrations", "places"), [(2, 193), (50, 3073), (10**6, transient.MOST_PLACES)])
def test_samples_show_the_motion_between_them(vibrations: int, places: int) -> None:
    """Assert that the number of phases is doubled until every other one shows the motion; not for ever."""

    def motion(state: Array, algebraic: Array, parameter: Array, phase: Array, *rest: Any) -> Any:
        wave = np.cos(vibrations * phase + 0.3)[:, None]
        return SimpleNamespace(phase=phase, state=wave, algebraic=np.zeros((len(phase), 0)), modes=())

    begin = np.ones(1), np.zeros(0), None
    system = SimpleNamespace(motion=motion, surfaces=())
    found = Transient(None, system, np.zeros(0), begin).samples()  # type: ignore[arg-type]
    assert len(found.phase) == places and found.phase[-1] == 2 * np.pi


def test_closest_returns_of_a_motion_that_never_settles() -> None:
    """Assert the periods that came back closest, in order, of a map that moves on by as much as is drawn."""
    moves = np.random.default_rng(1).uniform(1.0, 2.0, PERIODS)
    each = iter(moves)
    system, motion = settling(lambda x: x + next(each), 0.0)
    motion._turn = PERIODS + 1
    assert not motion.settles(STILL) and len(system.begun) == PERIODS
    begins = np.append(0.0, np.cumsum(moves))
    apart = moves / np.maximum(begins[1:], 1.0)  # the motion goes through 0 and 1
    motion.samples = lambda place=None: place  # type: ignore[method-assign,assignment,return-value]
    found = [place[0].item() for place in motion.returns()]  # type: ignore[index]
    assert found == pytest.approx(begins[np.argsort(apart)[: transient.RETURNS]])
