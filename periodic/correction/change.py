"""Where the pattern of an orbit's events changes: an excursion begins or ends, two events swap.

On either side of such a place an orbit takes a mesh of its own. A discretisation tells of a change between
two orbits (`periodic.correction.discretisation.Discretisation.change`); the continuation ends its step there
and goes on beyond it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

from periodic.correction.condition import SideCondition
from periodic.linear.unknowns import Increment
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System


@dataclass(frozen=True)
class Beyond:
    """How an orbit goes on beyond a change: its mesh, the event nodes' phases, and the condition held there.

    grazes: whether that orbit is the one at which a switch grazes its level. spare: whether it is
    tried only where those before are none, or lie behind the change, beyond more folds than one. parameter:
    the parameters (p,) that it has, where they are not those of the orbit before.
    """

    mesh: Mesh
    phases: Array
    condition: SideCondition
    grazes: bool
    spare: bool = False
    parameter: Array | None = None


class Change(Protocol):
    """A change of pattern ahead of an orbit."""

    @property
    def condition(self) -> SideCondition:
        """The condition that holds where the step ends, on the mesh that the orbits have so far."""

    @property
    def grazes(self) -> bool:
        """Whether a switch grazes its level where the step ends."""

    @property
    def strict(self) -> bool:
        """Whether orbits past the change, on the same mesh, are no orbits of the system."""

    @property
    def otherwise(self) -> Change | None:
        """The change to take instead where no orbit meets the condition, if any."""

    @property
    def final(self) -> bool:
        """Whether the branch cannot be followed nearer to the change than where the step ends."""

    @property
    def nearer(self) -> bool:
        """Whether the step ends nearer to it than where words are exchanged, which has been tried before."""

    @property
    def last(self) -> bool:
        """Whether the branch ends there: no orbits beyond it are near."""

    @property
    def name(self) -> str:
        """What changes, in words."""

    @property
    def part(self) -> float:
        """The part of the way to the second orbit at which it lies, about."""

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield ways to go on from the orbit at which the step ended, the best first."""


@dataclass(frozen=True)
class Held:
    """A side condition in place of the arclength constraint, for orbits on the mesh of `origin`.

    The tangent points along `direction`, or to where the condition grows if there is none.
    """

    origin: Orbit
    condition: SideCondition
    direction: Increment | None = None

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient of the condition."""
        return self.condition.linearise(system, orbit, free)
