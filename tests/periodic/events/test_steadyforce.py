"""Stops that break while the force that holds a joint stays as it is until an event at another joint."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

from periodic.events.rewrites.ends import Excursion, ends, excursions
from periodic.events.rewrites.grazingonsets import at_once, begins
from periodic.events.rewrites.sites import Site, edited, in_order
from periodic.events.rewrites.steadyforce import slipping_on
from periodic.events.rewrites.table import ADDING_ABOUT, SWAP, SWITCHING_ABOUT, SWITCHING_SLIDING
from periodic.events.sideconditions import Limit
from periodic.events.violations import limits
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import STUCK

STOP, TORN, FREE, HELD_AGAIN = 1.0, 2.0, 4.0, 5.0
"""Phases at which a mass stops on another one that rests, that one is torn off, the first is let go, and the
other one stops."""

SYSTEM = Surfaces([joint(0), joint(1, first=3)], np.eye(6).tolist())
"""Two joints: each has its guard and its releases upwards and downwards, which are the states."""

STOPS = EventNode(0, 1, modes=((0, STUCK),))


def resting(force: Callable[[Array], Array]) -> Orbit:
    """An orbit with a given force at the first joint, whose mass stops on a mass that rests."""

    def states(tau: Array) -> Array:
        found = np.zeros((len(tau), 6))
        found[:, 0] = np.where(tau < STOP, tau - STOP, np.where(tau > FREE, FREE - tau, 0.0))
        found[:, 1], found[:, 2], found[:, 4], found[:, 5] = force(tau), 1.0, -1.0, 1.0
        return found

    other = (EventNode(4, 1), TORN), (EventNode(3, -1, modes=((3, STUCK),)), HELD_AGAIN)
    nodes = sorted([(STOPS, STOP), (EventNode(2, -1), FREE), *other], key=lambda node: node[1])
    return along(states, nodes)


def slipping(speed: Callable[[Array], Array]) -> Orbit:
    """An orbit on which the mass passes where it stopped, with a given speed until it stops shortly after."""

    def states(tau: Array) -> Array:
        found = np.zeros((len(tau), 6))
        found[:, 0] = np.where((tau > STOP) & (tau < TORN + 0.01), speed(tau), 0.0)
        found[:, 0] = np.where(tau <= STOP, tau - STOP, found[:, 0])
        return found

    stop = EventNode(0, -1, modes=((0, STUCK),)), TORN + 0.01
    other = (EventNode(4, 1), TORN), (EventNode(3, -1, modes=((3, STUCK),)), HELD_AGAIN)
    nodes = [(EventNode(0, 1), STOP), stop, (EventNode(2, -1), FREE), *other]
    return along(states, sorted(nodes, key=lambda node: node[1]))


def broken(orbit: Orbit) -> Site:
    """The site at the stop on the orbit where it breaks."""
    (limit,) = (found for found in limits(SYSTEM, orbit, SYSTEM.surfaces[0]) if found.at == 0)
    site = begins(SYSTEM, orbit, limit)
    assert site is not None and site.row is SWITCHING_SLIDING
    (found,) = at_once(SYSTEM, orbit, site)
    return found


def test_the_new_stop_lies_after_the_event_from_which_the_force_comes_back() -> None:
    """Assert the row and the event, and the word: the mass passes, and stops a little after the event."""
    orbit = resting(lambda tau: np.minimum(0.0, TORN - tau))
    site = broken(orbit)
    assert (site.row, site.begin(orbit, 0.01)[1]) == (SWITCHING_ABOUT, TORN)
    nodes = in_order(edited(orbit, [site], 0.01), orbit)
    assert [(e.switch, e.direction, e.modes, phase) for e, phase in nodes[:3]] == [
        (0, 1, (), STOP),
        (4, 1, (), TORN),
        (0, -1, ((0, STUCK),), pytest.approx(TORN + 0.01)),
    ]


@pytest.mark.parametrize(
    "force",
    [
        lambda tau: STOP - tau,
        lambda tau: np.maximum(0.0, tau - TORN),
        lambda tau: np.minimum(0.0, FREE - tau),
    ],
    ids=["from the stop on", "further past it", "only once it is let go"],
)
def test_otherwise_the_new_stop_is_that_of_switching_sliding(force: Callable[[Array], Array]) -> None:
    """Assert the row where the force comes back at once, grows, or is the same until the joint is let go."""
    orbit = resting(force)
    site = broken(orbit)
    assert (site.row, site.begin(orbit, 0.01)[1]) == (SWITCHING_SLIDING, STOP)


def after_the_event(orbit: Orbit) -> Excursion:
    """What may end between the other joint's event and the stop, but for its own slip."""
    (found,) = (
        each for each in excursions(SYSTEM, orbit) if each.index == 1 and each.row is not ADDING_ABOUT
    )
    return found


def test_a_joint_that_speeds_up_until_the_event_ends_its_slip_with_it() -> None:
    """Assert the row's site in place of a swap, and the word without the slip: that of the orbit at rest."""
    orbit = slipping(lambda tau: np.where(tau < TORN, tau - STOP, 1.0 - 100 * (tau - TORN)))
    found = after_the_event(orbit)
    assert found.row is SWITCHING_ABOUT and found.size(SYSTEM, orbit) == pytest.approx(0.01)
    (site,) = ends(SYSTEM, orbit, found)
    assert site.held == Limit(0, 1, -1)
    events = [event for event, _ in in_order(edited(orbit, [site], 0.01), orbit)]
    assert events == list(resting(np.zeros_like).mesh.events)


def test_a_joint_that_slows_down_before_the_event_may_stop_before_it() -> None:
    """Assert a swap: its stop and the event change places."""
    orbit = slipping(lambda tau: TORN + 0.01 - tau)
    assert slipping_on(SYSTEM, orbit, 1) is None
    assert after_the_event(orbit).row is SWAP


def test_an_orbit_may_show_that_the_joint_slows_down_after_all() -> None:
    """Assert the site of a swap where the excursion was found on an orbit on which the joint speeds up."""
    orbit = slipping(lambda tau: TORN + 0.01 - tau)
    (site,) = ends(SYSTEM, orbit, Excursion(SWITCHING_ABOUT, 1))
    assert site.row is SWAP
    assert [added.event for added in site.added] == [orbit.mesh.events[2], orbit.mesh.events[1]]
