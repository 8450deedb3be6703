"""Sliders that are let go together, by the rest of the word."""

from __future__ import annotations

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

import symbolic as sym
from periodic.events.rewrites.rewrite import rewritten
from periodic.events.rewrites.together import together
from periodic.events.twinguards import held_throughout
from periodic.orbit.mesh import EventNode
from periodic.system import HELD, STUCK, Kind, surfaces_of


def beside(*parts: str) -> sym.CompiledSystem:
    """A mass on friction and on sliders."""
    x = sym.coordinate("x", unit="m")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 0.1) + sym.HarmonicForce(x, 1.0)
    if "friction" in parts:
        model = model + sym.CoulombFriction(x, 0.5)
    if "slider" in parts:
        model = model + sym.Jenkins(x, 1.0, 0.2, creep=None)
    if "sliders" in parts:
        model = model + sym.Iwan(x, 1.0, [0.1, 0.2], creep=None)
    return sym.compile(model)


def guards(system: sym.CompiledSystem, kind: Kind) -> list[tuple[int, int, int]]:
    """Guards and releases (up, down) of surfaces."""
    each = [s for s in surfaces_of(system) if s.kind == kind]
    return [(s.switch, *s.releases) for s in each if s.releases is not None]


def back_and_forth(
    system: sym.CompiledSystem, direction: int, at: tuple[float, float, float], onward: int | None = None
) -> list[tuple[EventNode, float]]:
    """Two sliders that stop together in a direction of their guard, and slip one after the other."""
    way = direction if onward is None else onward
    (a, *first), (b, *second) = guards(system, Kind.SLIDER)
    stop = EventNode(a, direction, modes=((a, STUCK), (b, STUCK)))
    slips = [EventNode(releases[0 if way > 0 else 1], way) for releases in (first, second)]
    return list(zip((stop, *slips), at, strict=True))


def test_sliders_held_together_are_let_go_together() -> None:
    """Assert that two releases become one where both were carried on before their stop at one turn."""
    system = beside("sliders")
    (a, up_a, _), (b, up_b, _) = guards(system, Kind.SLIDER)
    word = [
        *back_and_forth(system, -1, (0.5, 1.0, 1.1), onward=1),
        *back_and_forth(system, -1, (2.0, 2.5, 2.7)),
        *back_and_forth(system, 1, (4.0, 4.5, 4.7)),
    ]
    found = together(system, word, 0.1)
    assert len(found) == len(word) - 1
    joint = [event for event, _ in found if event.modes and event.switch in (up_a, up_b)]
    assert [dict(event.modes) for event in joint] in ([{b: 1}], [{a: 1}])
    assert together(system, found, 0.1) == found


def test_a_slider_held_all_along_holds_no_other_one() -> None:
    """Assert that two of three sliders are let go together beside a third that never slips: no friction is.

    Friction that is held all along is, until one of the event nodes lets it go.
    """
    joints = [joint(k, 3 * k, Kind.SLIDER) for k in range(3)]
    system = Surfaces([*joints, joint(3, 9)], [[1.0]] * 12)
    both = (0, STUCK), (3, STUCK)
    word = [
        (EventNode(0, -1, modes=both), 0.5),
        (EventNode(1, 1, modes=((3, 1),)), 1.0),
        (EventNode(0, -1, modes=both), 2.0),
        (EventNode(2, -1), 2.5),
        (EventNode(5, -1), 2.7),
        (EventNode(0, 1, modes=both), 4.0),
        (EventNode(1, 1), 4.5),
        (EventNode(4, 1), 4.7),
    ]
    parted = [*word[:1], (EventNode(1, 1), 1.0), (EventNode(4, 1), 1.1), *word[2:]]

    def read(word: list[tuple[EventNode, float]], *modes: tuple[int, int]) -> int:
        orbit = along(lambda tau: np.sin(tau)[:, None], word, modes)
        return len(rewritten(system, orbit, [], 0.1)[0])

    assert held_throughout(system, [(6, HELD), (9, HELD), (0, 1)]) == [9]
    assert [read(word), read(word, (6, HELD)), read(parted), read(parted, (6, HELD))] == [len(word)] * 4
    assert read(parted, (9, HELD)) == len(parted)


def test_a_slider_that_has_slipped_is_let_go_by_itself() -> None:
    """Assert that a joint release is parted where one of both slips before, it earlier than the other."""
    system = beside("sliders")
    (a, up_a, down_a), (b, up_b, _) = guards(system, Kind.SLIDER)
    both = ((a, STUCK), (b, STUCK))
    word = [
        (EventNode(a, -1, modes=both), 0.5),
        (EventNode(down_a, -1), 0.8),
        (EventNode(a, 1, modes=((a, STUCK),)), 0.9),
        (EventNode(up_a, 1, modes=((b, 1),)), 1.5),
        *back_and_forth(system, -1, (3.0, 3.5, 3.7)),
        *back_and_forth(system, 1, (5.0, 5.5, 5.7)),
    ]
    found = together(system, word, 0.1)
    alone = [(event.switch, phase) for event, phase in found if 1.4 < phase < 1.6]
    assert [switch for switch, _ in alone] == [up_a, up_b]
    assert alone[1][1] == 1.5
    assert alone[0][1] == pytest.approx(1.5 - 0.5 * 0.1**2)


@pytest.mark.parametrize("direction", [1, -1])
def test_friction_takes_a_slider_along(direction: int) -> None:
    """Assert that a slider at its limit beside friction that holds goes with it, and only the same way."""
    system = beside("friction", "slider")
    ((c, up, down),), ((z, up_z, down_z),) = guards(system, Kind.SLIDING), guards(system, Kind.SLIDER)
    release = EventNode(up if direction > 0 else down, direction)
    slips = EventNode(up_z if direction > 0 else down_z, direction)
    word = [
        (EventNode(c, -1, modes=((c, STUCK), (z, STUCK))), 1.0),
        (release, 1.5),
        (slips, 1.6),
        *(
            [(EventNode(c, -1, modes=((z, STUCK),)), 3.0), (EventNode(down_z, -1), 3.5)]
            if direction > 0
            else []
        ),
        (EventNode(c, 1, modes=((z, STUCK),)), 5.0),
        (EventNode(up_z, 1), 5.5),
    ]
    found = together(system, word, 0.1)
    if direction < 0:
        assert found == word
    else:
        assert (EventNode(up, 1, modes=((z, 1),)), 1.5) in found
        assert len(found) == len(word) - 1


def test_sliders_follow_friction_together_after_a_broken_stop() -> None:
    """Assert that two sliders whose strain turned before friction stopped are let go at one node after it."""
    system = beside("friction", "sliders")
    ((friction, up, down),) = guards(system, Kind.SLIDING)
    (a, up_a, _), (b, up_b, _) = guards(system, Kind.SLIDER)
    both, held = ((a, STUCK), (b, STUCK)), (friction, STUCK)
    word = [
        (EventNode(friction, -1, modes=both), 1.0),
        (EventNode(friction, 1, modes=(held,)), 1.01),
        (EventNode(up, 1, modes=((a, 1), (b, 1))), 1.5),
        (EventNode(friction, -1, modes=(held, *both)), 3.0),
        (EventNode(down, -1, modes=((a, -1), (b, -1))), 3.5),
        (EventNode(friction, 1, modes=(held, *both)), 4.5),
        (EventNode(up, 1, modes=((a, 1), (b, 1))), 5.0),
    ]
    found = together(system, word, 0.01)
    later = [(event, phase) for event, phase in found if 1.5 <= phase < 3]
    assert [event.switch for event, _ in later] in ([up, up_a], [up, up_b])
    assert later[0][0].modes == ()
    assert dict(later[1][0].modes) in ({b: 1}, {a: 1})
    assert later[1][1] == pytest.approx(1.5 + 0.01 ** (2 / 3))
    assert together(system, found, 0.01) == found
