"""Time steps in C: those of NumPy, to rounding."""

from __future__ import annotations

import numpy as np
import pytest
from support.drawn.jointcases import drawn_joints

from periodic.condensed import timestepping
from periodic.condensed.settling import settled
from periodic.condensed.timestepping import Motion
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import uniform
from periodic.orbit.scheme import Scheme
from symbolic.kernels import native

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)


@pytest.mark.parametrize("seed", [122, 174])
def test_motion_is_that_of_numpy(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert states to 1e-12 of the largest and all modes over two periods of beams with several joints."""
    monkeypatch.setenv("ORBITRACE_KERNELS", "c")
    system, found = drawn_joints("joints", seed).system, list[Motion]()
    for fast in (True, False):
        motion = Motion.at_rest(system, system.nominal, *system.rest(system.nominal))
        assert motion._steps_in_c() is not None
        if not fast:
            monkeypatch.setattr(Motion, "_steps_in_c", lambda own: None)
        motion.pace(256, 1e-3)
        motion.period()
        motion.period()
        found.append(motion)
    fast, plain = found
    assert len(fast.events) > 5
    ours, theirs = ([(e.surface, e.before, e.after, e.step) for e in each.events] for each in found)
    assert ours == theirs
    assert np.array_equal(fast.sides, plain.sides)
    assert [e.phase for e in fast.events] == pytest.approx([e.phase for e in plain.events], rel=1e-9)
    expected = np.array(plain.states)
    assert np.abs(np.array(fast.states) - expected).max() < 1e-12 * np.abs(expected).max()


def test_steps_are_those_of_c_once_kernels_are_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that they are asked for until there are some, and then kept."""
    system, steps = drawn_joints("joints", 122).system, object()
    motion = Motion.at_rest(system, system.nominal, *system.rest(system.nominal))
    found = iter([None, steps])
    monkeypatch.setattr(timestepping, "native_steps", lambda *given: next(found))
    assert [motion._steps_in_c() for _ in range(3)] == [None, steps, steps]


def test_slider_beside_friction(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the word of a slider and friction between the same nodes, which stop at one instant.

    Friction then holds the slider at its limit, for .3 rad, and lets go to the other side: the slider does
    not slip again. By rounding it slipped and stopped up to thirty times a period.
    """
    monkeypatch.setenv("ORBITRACE_KERNELS", "c")
    case = drawn_joints("joints", 122)
    system, start = case.system, at_rest(case.system, uniform(Scheme(), 8), case.system.nominal)
    start.parameter[[p.name for p in system.parameters].index("Omega")] = case.start
    motion = Motion.at_rest(system, start.parameter, *system.rest(start.parameter))
    slider, other, friction = motion.joints
    assert friction.slides and not slider.slides
    words = [[event.switch for event in orbit.mesh.events] for orbit in settled(system, start)]
    assert len(words) == 3
    for word in words:
        assert len(word) == 10
        assert [word.count(k) for k in (friction.switch, friction.up, friction.down)] == [2, 1, 1]
        assert [word.count(k) for k in (slider.up, slider.down)] == [1, 1]
        assert [word.count(k) for k in (other.switch, other.up, other.down)] == [2, 1, 1]
