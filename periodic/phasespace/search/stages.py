"""A search for all motions, stage by stage: what was found stands wherever it is interrupted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np

from periodic.checks import named
from periodic.phasespace.motion import Motions
from periodic.phasespace.search.aperiodic import Attractors
from periodic.phasespace.search.images import Images
from periodic.phasespace.search.manifolds import Manifolds
from periodic.phasespace.search.round import Round
from periodic.phasespace.search.search import Search
from periodic.phasespace.search.settle import Settling
from periodic.phasespace.search.symmetries import Symmetry, symmetries_of
from periodic.phasespace.search.unexcited import Unexcited
from periodic.phasespace.search.unstable import Unstable

Stage = tuple[str, Callable[[], str]]
"""What is tried next, and what tries it and says in words what was tried."""


class SearchInterrupted(KeyboardInterrupt):
    """Ctrl-C during a search; `found` is what was found until then, and what was not tried."""

    def __init__(self, found: Any, what: str) -> None:
        super().__init__(
            f"interrupted; {what} the `found` of this exception: "
            f"`import sys; sys.last_value.found` where nothing caught it"
        )
        self.found = found


@dataclass(eq=False)
class Stages:
    """A search under way; along: parameters and their ranges in which branches are traced."""

    search: Search
    along: Mapping[str, tuple[float, float]]
    tried: list[str] = field(default_factory=list, init=False)
    labels: Any = field(default_factory=lambda: np.zeros(0, dtype=int), init=False)
    symmetries: tuple[Symmetry, ...] = field(default=(), init=False)

    def run(self, say: Callable[[str], None]) -> Motions:
        """Return what is found. Raises SearchInterrupted."""
        stages = self.all
        try:
            for _, stage in stages:
                self.tried.append(stage())
                say(f"{len(self.settling.orbits)} orbits, {len(self.others.found)} other attractors")
        except KeyboardInterrupt:
            left = [name for name, _ in stages[len(self.tried) :]]
            self.tried.append(f"interrupted; not tried, or not to the end: {', '.join(left)}")
            found = self.found()
            raise SearchInterrupted(found, f"the {len(found)} motions so far are") from None
        return self.found()

    @property
    def all(self) -> list[Stage]:
        """The stages in order."""
        along = named("along", self.along, "ranges of parameters")
        stages: list[Stage] = [
            ("motions from random places", self._settled),
            ("what those are that do not come back", self._sorted),
        ]
        if self.search.places:
            stages += [
                ("unstable orbits", self._unstable),
                ("motions from beside them", lambda: Manifolds(self.settling).run()),
            ]
        stages += [
            (f"branches over {name}", partial(self._round, name, bounds)) for name, bounds in along.items()
        ]
        return [*stages, ("images under symmetries", self._images)]

    @cached_property
    def settling(self) -> Settling:
        """Motions from all starts, not followed yet."""
        search = self.search
        system, parameter = search.crowd.system, search.crowd.parameter
        return search.settling(
            search.crowd.begin(search.box.draw(search.starts, search.seed, system, parameter))
        )

    @cached_property
    def others(self) -> Attractors:
        """Attractors that no motion comes back to."""
        return Attractors(self.search.crowd, self.settling.clock, self.settling.unit)

    def found(self) -> Motions:
        """Return what is known so far."""
        search, settling, others = self.search, self.settling, self.others
        made = [search.motion(one, search.starts) for one in settling.orbits.each]
        counts = [int((self.labels == k).sum()) for k in range(len(others.found))]
        made += [others.motion(k, count, search.starts) for k, count in enumerate(counts)]
        undecided = search.starts - len(settling.gone) - sum(motion.starts for motion in made)
        names = [p.name for p in search.crowd.system.parameters]
        made.sort(key=lambda motion: (not motion.stable, -motion.starts, motion.periods))
        return Motions(
            Images(settling, self.symmetries).marked(tuple(made), others),
            dict(zip(names, search.crowd.parameter.tolist(), strict=True)),
            search.box.ranges,
            search.starts,
            len(settling.gone),
            undecided,
            tuple(text for text in self.tried if text),
            search.box.unit,
        )

    def _settled(self) -> str:
        """Follow motions from all starts."""
        self.settling.run()
        search = self.search
        return (
            f"{search.starts} motions from random places in the box, for {search.settle} periods at the most"
        )

    def _sorted(self) -> str:
        """Tell motions that do not come back from each other."""
        self.labels = self.others.sorted_of(self.settling)
        return ""

    def _unstable(self) -> str:
        """Add unstable orbits, or equilibria and cycles."""
        search, settling = self.search, self.settling
        if search.frequency:
            return Unexcited(settling, search.box, search.places, search.seed).run()
        return Unstable(settling, search.box, search.periods, search.places, search.seed).run()

    def _round(self, name: str, bounds: tuple[float, float]) -> str:
        """Add what the branches of all orbits have at the parameter's value."""
        return Round(self.settling, name, bounds, self.search.tol, self.search.determined).run()

    def _images(self) -> str:
        """Add the images of orbits."""
        search = self.search
        self.symmetries = symmetries_of(search.crowd, search.box, search.seed, not search.frequency)
        return Images(self.settling, self.symmetries).run() if self.symmetries else ""
