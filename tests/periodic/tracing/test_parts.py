"""Small functions of tracing: values by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import along

from periodic.orbit.mesh import EventNode
from periodic.stability.multipliers import Stability
from periodic.tracing import eventsfrommotion
from periodic.tracing.eventsfrommotion import DISTANCES_BEYOND, same_word
from periodic.tracing.start import Start

UP, DOWN, OTHER = EventNode(0, 1), EventNode(0, -1), EventNode(1, 1)


@pytest.mark.parametrize(
    ("autonomous", "stability", "looked_for"),
    [
        (False, Stability.MULTIPLIERS, True),
        (True, Stability.MULTIPLIERS, False),
        (False, Stability.EIGENVALUES, False),
        (True, Stability.EIGENVALUES, False),
    ],
)
def test_rest_under_the_mean_load_is_of_forced_orbits_alone(
    autonomous: bool, stability: Stability, looked_for: bool
) -> None:
    """Assert that free oscillations and equilibria have none, nor what no simulation settles to."""
    method = SimpleNamespace(
        stability=stability,
        resting=lambda system, guess: f"rest of {guess}",
        guess=lambda system, parameter, orbit: f"{orbit}, adopted",
    )
    problem = SimpleNamespace(autonomous=autonomous, system=None)
    solver: Any = SimpleNamespace(problem=problem, discretisation=method)
    rest = SimpleNamespace(parameter=None)
    method.resting = lambda system, guess: rest if guess == "guess" else None
    method.guess = lambda system, parameter, orbit: orbit
    start = Start(solver, lambda *_: (None, None))  # type: ignore[arg-type, return-value]
    assert (start._rest("guess") is rest) is looked_for  # type: ignore[arg-type]
    assert start._rest("at rest") is None  # type: ignore[arg-type]
    if not looked_for:
        assert list(start._settled("guess")) == [] and start.tried == []  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("multipliers", "ties", "near"),
    [
        ([0.5, -0.9], True, False),
        ([1.0, -1.0], True, False),
        ([0.5, -1.5], True, True),
        ([0.8 + 0.8j, 0.8 - 0.8j], True, True),
        ([0.5, 1.5], False, False),
    ],
)
def test_distances_beyond_a_change(
    multipliers: list[complex], ties: bool, near: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that only unstable orbits with impacts are left for short distances alone."""
    monkeypatch.setattr(eventsfrommotion, "tied", lambda system, orbit: [0] if ties else [])
    base: Any = SimpleNamespace(spectrum=SimpleNamespace(multipliers=np.array(multipliers)), orbit=None)
    found = eventsfrommotion._distances(None, base)  # type: ignore[arg-type]
    assert found == ((1e-2, 1e-3, 1e-4) if near else DISTANCES_BEYOND)


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ((), (), True),
        ((UP, DOWN, OTHER), (DOWN, OTHER, UP), True),
        ((UP, DOWN, OTHER), (OTHER, UP, DOWN), True),
        ((UP, DOWN, OTHER), (DOWN, UP, OTHER), False),
        ((UP, DOWN), (UP, DOWN, OTHER), False),
        ((UP,), (), False),
    ],
)
def test_words_that_are_the_same(
    one: tuple[EventNode, ...], other: tuple[EventNode, ...], same: bool
) -> None:
    """Assert that words are compared from wherever they are counted, and modes of meshes too."""

    def orbit(events: tuple[EventNode, ...], modes: Any = ()) -> Any:
        nodes = [(event, 1.0 + k) for k, event in enumerate(events)]
        return along(lambda tau: np.sin(tau)[:, None], nodes, modes, intervals=4 * max(len(nodes), 1))

    assert same_word(orbit(one), orbit(other)) is same
    assert not same_word(orbit(one), orbit(other, [(5, 1)]))
