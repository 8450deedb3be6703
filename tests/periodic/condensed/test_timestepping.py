"""Motion in time steps: which modes joints have, when they change, and how steps are divided."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.condensed import timestepping
from periodic.condensed.timestepping import PARTS, Changed, Motion
from periodic.orbit.orbit import FORCED
from periodic.system import STUCK


def joint(column: int, slides: bool = True) -> Any:
    """A joint of three switches: its guard and the releases up and down."""
    return SimpleNamespace(
        index=column, column=column, slides=slides, switch=3 * column, up=3 * column + 1, down=3 * column + 2
    )


def motion(*joints: Any, side: tuple[float, ...], values: tuple[float, ...] = (), **more: Any) -> Any:
    """A motion whose joints have modes, and whose switches have values."""
    own: Any = SimpleNamespace(
        joints=joints,
        side=np.array(side, dtype=float),
        values=lambda x, tau, side: np.array(values),
        system=None,
        _stuck=(np.zeros(0, dtype=int), []),
        sliders={},
        **more,
    )
    return own


@pytest.mark.parametrize(
    ("mode", "guard", "part", "wrong"),
    [
        (1, 0.5, 0.0, None),
        (1, -0.5, 0.0, STUCK),
        (-1, -0.5, 0.0, None),
        (-1, 0.5, 0.0, STUCK),
        (1, 0.0, 0.0, None),
        (0, 0.5, 0.0, STUCK),
        (STUCK, 0.5, 1.0, None),
        (STUCK, 0.5, -1.0, None),
        (STUCK, 0.5, 1.01, 1),
        (STUCK, 0.5, -1.01, -1),
    ],
)
def test_mode_of_friction(mode: int, guard: float, part: float, wrong: int | None) -> None:
    """Assert that it sticks where it would turn, and slips where it holds with more than it can."""
    own = motion(joint(0), side=(mode,), values=(guard, 9.0, 9.0))
    found = Motion._wrong(own, np.zeros(1), np.array([part]), 0.0)
    assert found == (None if wrong is None else (0, wrong))


@pytest.mark.parametrize(
    ("mode", "moved", "up", "down", "wrong"),
    [
        (1, 0.5, 9.0, 9.0, None),
        (1, -0.5, 9.0, 9.0, STUCK),
        (-1, -0.5, 9.0, 9.0, None),
        (-1, 0.5, 9.0, 9.0, STUCK),
        (STUCK, 0.5, -0.1, 0.1, None),
        (STUCK, 0.5, 0.0, 0.0, None),
        (STUCK, 0.5, 0.1, 0.2, 1),
        (STUCK, 0.5, -0.2, -0.1, -1),
    ],
)
def test_mode_of_a_slider(
    mode: int, moved: float, up: float, down: float, wrong: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that it is held where it would go back, let go at its limits, left where friction stops it."""
    monkeypatch.setattr(timestepping, "stops", lambda system, joint, stuck: False)
    own = motion(joint(0, False), side=(mode,), values=(9.0, up, down), state=np.array([0.0, 1.0]))
    own.sliders = {0: (0, 1)}
    found = Motion._wrong(own, np.array([7.0, 1.0 + moved]), np.zeros(1), 0.0)
    assert found == (None if wrong is None else (0, wrong))
    monkeypatch.setattr(timestepping, "stops", lambda system, joint, stuck: True)
    assert Motion._wrong(own, np.array([7.0, 1.0 + moved]), np.zeros(1), 0.0) is None


def test_first_wrong_mode_is_changed_first() -> None:
    """Assert the first of two joints, and the second where the first is right."""
    both = (-1.0, 0.0, 0.0, -1.0, 0.0, 0.0)
    own = motion(joint(0), joint(1), side=(1, 1), values=both)
    assert Motion._wrong(own, np.zeros(1), np.zeros(2), 0.0) == (0, STUCK)
    own.side = np.array([-1.0, 1.0])
    assert Motion._wrong(own, np.zeros(1), np.zeros(2), 0.0) == (1, STUCK)


@pytest.mark.parametrize(
    ("slides", "before", "after", "first", "last", "share"),
    [
        (True, STUCK, 1, (0, 3, 0), (0, -1, 0), 0.75),
        (True, STUCK, -1, (0, 0, 1), (0, 0, -3), 0.25),
        (True, 1, STUCK, (0.4, -2.0, 0), (9, 9, 9), 0.4),
        (True, -1, STUCK, (0.4, 9.0, -2.0), (9, 9, 9), 0.4),
        (False, 1, STUCK, (1.0, 0, 0), (-3.0, 0, 0), 0.25),
        (False, STUCK, 1, (0, 1.0, 0), (0, -1.0, 0), 0.5),
        (True, STUCK, 1, (0, 3, 0), (0, 1, 0), 0.5),
        (True, STUCK, 1, (0, 0, 0), (0, 1, 0), 0.5),
    ],
)
def test_part_of_a_step_before_a_change(
    slides: bool, before: int, after: int, first: Any, last: Any, share: float
) -> None:
    """Assert where the guard that tells it is 0, on a straight line or by its rate; else the middle."""
    ends = [np.array(first, dtype=float), np.array(last, dtype=float)]
    own: Any = SimpleNamespace(
        values=lambda x, tau, side: ends[int(x)], states=[0, 1], phases=[2.0, 2.5], sides=[None, None]
    )
    assert Motion._share(own, 0, joint(0, slides), before, after) == pytest.approx(share)


def test_changes_of_a_step_are_noted() -> None:
    """Assert phase, modes and step of each joint that changes, but of one that had no mode."""
    own = motion(joint(0), joint(1), joint(2), side=())
    own.sides = [None, np.array([1.0, 0.0, STUCK]), np.array([STUCK, 1.0, STUCK])]
    own.phases, own.events = [0.0, 2.0, 2.5], []
    own._share = lambda k, joint, before, after: 0.5
    Motion._noted(own, 1)
    assert own.events == [Changed(0, 1, STUCK, 2.25, 1)]


@pytest.mark.parametrize(
    ("shortest", "count"), [(np.inf, 1), (FORCED / 16, 1), (FORCED / 17, 2), (FORCED / 1000, 3)]
)
def test_widths_of_steps(shortest: float, count: int) -> None:
    """Assert an eighth of the one before, down to the least width."""
    own: Any = SimpleNamespace(steps=16, shortest=shortest)
    levels = Motion._levels
    assert isinstance(levels, property) and levels.fget is not None
    assert levels.fget(own) == pytest.approx([FORCED / 16 / PARTS**k for k in range(count)])


class Stepping:
    """A motion whose mode changes in every step that passes a phase; it notes the steps that it keeps."""

    _advance = Motion._advance

    def __init__(self, change: float) -> None:
        self.change, self.at = change, 0.0
        self.z = self.state = self.unknown = 0.0
        self.side, self.holding = np.zeros(1), self
        self.phases: list[float] = []
        self.states: list[Any] = []
        self.unknowns: list[Any] = []
        self.sides: list[Any] = []
        self.shown = "shown"

    def gives_way(self, before: Any) -> bool:
        """No force gives way."""
        return False

    def _step(self, tau: float, width: float) -> None:
        self.side = np.ones(1) if tau >= self.change else np.zeros(1)
        self.state = tau


@pytest.mark.parametrize(("change", "kept"), [(5.0, 1), (0.3, PARTS)])
def test_steps_in_which_a_mode_changes_are_divided(change: float, kept: int) -> None:
    """Assert the phases that are kept, in which the change lies in the shortest."""
    own: Any = Stepping(change)
    own._advance(0.0, 1.0, [1.0, 1.0 / PARTS])
    assert own.phases == pytest.approx(np.arange(1, kept + 1) / kept)
    assert own.states == own.phases and own.sides == ["shown"] * kept


def test_steps_are_divided_again() -> None:
    """Assert eighths of the one eighth in which the mode changes, and no more than that."""
    own: Any = Stepping(0.3)
    own._advance(0.0, 1.0, [1.0, 1 / PARTS, 1 / PARTS**2])
    widths = np.diff([0.0, *own.phases])
    assert len(own.phases) == 2 * PARTS - 1
    assert widths[2 : 2 + PARTS] == pytest.approx(np.full(PARTS, 1 / PARTS**2))
    assert np.delete(widths, np.s_[2 : 2 + PARTS]) == pytest.approx(np.full(PARTS - 1, 1 / PARTS))


def test_guards_and_columns_that_stick() -> None:
    """Assert those of friction that sticks, not of sliders and of what slips."""
    own = motion(joint(0), joint(1, False), joint(2), joint(3), side=(STUCK, STUCK, 1, STUCK))
    stuck = Motion._stuck
    assert isinstance(stuck, property) and stuck.fget is not None
    columns, guards = stuck.fget(own)
    assert columns.tolist() == [0, 3] and guards == [0, 9]
