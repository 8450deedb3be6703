"""Further orbits on the branches of those that are known: along a parameter and back to its value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from periodic.checks import two
from periodic.correction.condition import Condition
from periodic.correction.outcome import FAILURES
from periodic.orbit.orbit import FORCED
from periodic.phasespace.following.traced import traced
from periodic.phasespace.search.settle import Settling
from periodic.results.branch import Branch
from periodic.system import index_of


@dataclass(frozen=True, eq=False)
class Round:
    """Branches of known orbits over a parameter within bounds (SI), to a tolerance."""

    settling: Settling
    parameter: str
    bounds: tuple[float, float]
    tol: float
    determined: Mapping[str, Condition]

    def run(self) -> str:
        """Add what the branches have at the parameter's value; return what was tried, in words."""
        system = self.settling.crowd.system
        value = float(self.settling.crowd.parameter[index_of(system, self.parameter)])
        low, high = two(f"along[{self.parameter!r}]", self.bounds)
        if not low < value < high:
            raise ValueError(
                f"along[{self.parameter!r}] is {self.bounds}; it must have the value, {value:g}, inside"
            )
        before, done, lost = len(self.settling.orbits.each), set[int](), 0
        while (
            k := next((i for i in range(len(self.settling.orbits.each)) if i not in done), None)
        ) is not None:
            done.add(k)
            one = self.settling.orbits.each[k]
            if one.point is None or one.periods == 0:
                continue
            try:
                branch = traced(
                    self.settling.crowd,
                    self.parameter,
                    (low, high),
                    start=value,
                    guess=one.point.orbit,
                    at=[value],
                    tol=self.tol,
                    determined=self.determined,
                )
            except FAILURES:
                lost += 1
                continue
            done |= self._added(branch, value)
        found = len(self.settling.orbits.each) - before
        lost_too = f", {lost} of them lost" if lost else ""
        return (
            f"the branches of all orbits over {self.parameter} from {low:g} to {high:g}{lost_too}: "
            f"{found} more orbits"
        )

    def _added(self, branch: Branch, value: float) -> set[int]:
        """Add the branch's orbits at the value; the indices of those that need not be traced themselves."""
        on_it = set[int]()
        for point in branch:
            if abs(point.parameter - value) > 1e-9 * max(1.0, abs(value)):
                continue
            periods = round(float(point.orbit.mesh.period) / FORCED)
            if self.settling.add(point, periods, f"on a branch over {self.parameter}"):
                on_it.add(len(self.settling.orbits.each) - 1)
        return on_it
