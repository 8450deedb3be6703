"""Newton's method from a motion that nearly comes back: with friction, beyond changes of its word."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.correction.outcome import FAILURES
from periodic.events.motions import has_words
from periodic.tracing import transient
from periodic.tracing.closing import STEPS, Closing
from periodic.tracing.transient import BETWEEN, Transient

Array = np.ndarray


def rubbed(unstable: bool = False) -> sym.CompiledSystem:
    """A mass on a spring with dry friction, forced at 0.8; where unstable, with negative damping besides."""
    damping = -0.3 if unstable else 0.02

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": -damping * x.v - x.x - p.R * sym.functions.sign(x.v) + wave.cos}

    states = {"x": 0.0, "v": 0.0}
    return sym.compile(sym.Equations(rates, states, {"Omega": 0.8, "R": 0.2}, frequency="Omega"))


class Line(Closing):
    """Steps of a map from a number to its distance, 1 at most, that are known."""

    def __init__(self, way: float, distance: Any) -> None:
        super().__init__(None, None, None, distance)  # type: ignore[arg-type]
        object.__setattr__(self, "_step", way)

    def _way(self, state: Array) -> Array | None:
        return np.array([self._step])  # type: ignore[attr-defined]


def test_steps_go_on_while_they_lead_nearer() -> None:
    """Assert steps of 1 from 0 towards 5.2, the last a quarter of one, and no more than are allowed."""
    found, off = Line(1.0, lambda x: abs(float(x[0]) - 5.2)).nearest(np.zeros(1), 0.0)
    assert found.tolist() == [5.25] and off == pytest.approx(0.05)
    found, _ = Line(1.0, lambda x: 0.5 ** float(x[0])).nearest(np.zeros(1), 0.0)
    assert found.tolist() == [float(STEPS)]


def test_enough_is_enough() -> None:
    """Assert no step within the distance that is enough."""
    found, off = Line(1.0, lambda x: abs(float(x[0]) - 5.2)).nearest(np.zeros(1), 2.5)
    assert found.tolist() == [3.0] and off == pytest.approx(2.2)


def test_motion_that_cannot_be_followed_is_no_nearer() -> None:
    """Assert that a step is halved that leads to where the integration fails, or is not finite."""

    def distance(x: Array) -> float:
        if x[0] > 1.5:
            raise FAILURES[0]
        return float("nan") if x[0] > 0.7 else 5.0 - float(x[0])

    found, off = Line(2.0, distance).nearest(np.zeros(1), 0.0)
    assert 0.5 <= found[0] <= 0.7 and off == pytest.approx(5 - found[0])


def test_no_word_no_step() -> None:
    """Assert the given state where no orbit is read from its motion, or its equations fail."""
    state = np.array([0.3])
    nothing = Closing(None, None, lambda x: None, lambda x: 1.0)  # type: ignore[arg-type]
    assert nothing.nearest(state, 0.0) == (state, 1.0)

    def failing(*given: Any) -> Any:
        raise FAILURES[0]

    method: Any = SimpleNamespace(guess=lambda *given: None, linearise=failing)
    motion: Any = SimpleNamespace(parameter=np.zeros(1))
    unsolved = Closing(method, None, lambda x: motion, lambda x: 1.0)  # type: ignore[arg-type]
    assert unsolved.nearest(state, 0.0) == (state, 1.0)


@pytest.mark.parametrize("unstable", [False, True])
def test_from_a_motion_to_an_orbit_in_few_periods(unstable: bool) -> None:
    """Assert that a motion far off is closed in a few steps, also to an orbit that motions leave."""
    system: Any = rubbed(unstable)
    begin = np.array([0.5, 0.4]), np.zeros(0), None
    motion = Transient(per.Collocation(), system, system.nominal, begin)
    found = motion._closed(*begin)
    assert has_words(system) and found is not None
    end = system.motion(found[0], found[1], system.nominal, np.array([0.0, 2 * np.pi]), 1e-9).state[-1]
    assert end == pytest.approx(found[0], abs=1e-4)


def test_closing_has_its_turn_again_and_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert one after every ten periods of a motion with words that does not settle."""
    turns = list[int]()
    system: Any = rubbed(unstable=True)
    monkeypatch.setattr(transient, "PERIODS", 3 * BETWEEN + 1)
    monkeypatch.setattr(Transient, "_closed", lambda own, *place: turns.append(own._count))
    begin = np.array([0.5, 0.4]), np.zeros(0), None
    assert not Transient(per.Collocation(), system, system.nominal, begin).settles(1e-3)
    assert turns == [BETWEEN, 2 * BETWEEN, 3 * BETWEEN]
