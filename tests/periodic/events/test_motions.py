"""Guesses from motions in time: the modes that no event changes, and when there is none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, joint

from periodic.events import motions
from periodic.orbit.mesh import EventNode
from periodic.system import HELD, STUCK, Kind
from periodic.system.events import Surface


def event(surface: int, phase: float, before: int, after: int) -> Any:
    """An event of a motion."""
    return SimpleNamespace(surface=surface, phase=phase, before=before, after=after)


@pytest.fixture
def motion(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """The motion x = cos tau with events and modes that are given; what was followed."""
    given: dict[str, Any] = {"events": [], "modes": [], "asked": []}

    def followed(
        system: Any, state: Any, unknown: Any, parameter: Any, phase: Any, tolerance: float, before: Any
    ) -> Any:
        given["asked"].append((phase[0], phase[-1], tolerance, before))
        x = np.cos(phase)[:, None]
        none = np.zeros((len(phase), 0))
        return SimpleNamespace(
            phase=phase, state=x, algebraic=none, events=given["events"], modes=given["modes"]
        )

    monkeypatch.setattr(motions, "motion_from", followed)
    monkeypatch.setattr(motions, "placed", lambda surface, parameter, states: parameter + 10.0)
    return given


def guess(system: Any, begin: float = 0.0) -> Any:
    """The guess from the motion."""
    start = np.array([np.cos(begin)])
    return motions.orbit_of(system, start, np.zeros(0), np.ones(1), 1e-8, begin, [0])


@pytest.mark.parametrize(
    ("mode", "more", "kept", "moved"),
    [
        (STUCK, {"place": (0, (1.0,))}, HELD, True),
        (STUCK, {"alone": True}, HELD, True),
        (STUCK, {}, STUCK, False),
        (1, {"place": (0, (1.0,))}, 1, False),
        (-1, {"alone": True}, -1, False),
    ],
)
def test_modes_that_last(mode: int, more: Any, kept: int, moved: bool, motion: dict[str, Any]) -> None:
    """Assert that they are the mesh's, held at a place where there is one, which is a parameter then."""
    motion["modes"] = [mode]
    found = guess(Surfaces([joint(**more)], [[1.0]] * 3))
    assert found.mesh.modes == ((0, kept),) and found.parameter.tolist() == [11.0 if moved else 1.0]
    assert found.mesh.events == () and found.nodes[:, 0] == pytest.approx(
        np.cos(found.mesh.nodes(found.phases))
    )


@pytest.mark.parametrize("begin", [0.0, 1.5])
def test_modes_that_events_change(begin: float, motion: dict[str, Any]) -> None:
    """Assert that they are those of event nodes, and that the motion is read from its own begin on."""
    motion["modes"] = [1, -1]
    motion["events"] = [event(0, begin + 0.5, 1, STUCK), event(0, begin + 2.0, STUCK, 1)]
    found = guess(Surfaces([joint(), joint(1, 3)], [[1.0]] * 6), begin)
    assert found.mesh.events == (EventNode(0, -1, modes=((0, STUCK),)), EventNode(1, 1))
    assert found.phases == pytest.approx([begin + 0.5, begin + 2.0]) and found.mesh.modes == ((3, -1),)
    assert motion["asked"][0] == (begin, begin + 2 * np.pi, 1e-8, [0])
    assert found.nodes[:, 0] == pytest.approx(np.cos(found.mesh.nodes(found.phases)), abs=1e-8)
    assert found.stages[:, :, 0] == pytest.approx(np.cos(found.stage_phases), abs=1e-8)


def test_motions_that_are_no_guess(motion: dict[str, Any]) -> None:
    """Assert none of systems whose motions need no word, and none where two events are at one phase."""
    assert (
        guess(Surfaces([Surface(Kind.KINK, "kink", 0), Surface(Kind.IMPACT, "wall", 1)], [[1.0]] * 2)) is None
    )
    assert not motion["asked"]
    motion["modes"], motion["events"] = [1], [event(0, 1.0, 1, -1), event(0, 1.0 + 2 * np.pi, -1, 1)]
    assert guess(Surfaces([joint()], [[1.0]] * 3)) is None
    wall = Surface(Kind.IMPACT, "wall", 0, leaves=1)
    motion["modes"], motion["events"] = [0], []
    assert guess(Surfaces([wall], [[1.0]] * 2)).mesh.modes == ()
