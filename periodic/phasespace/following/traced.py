"""Branches that a search traces: those that are kept already are not traced again."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.orbit.orbit import Orbit
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.following.working import work
from periodic.results.branch import Branch
from periodic.results.described import described
from periodic.results.files import digest
from periodic.results.journal import packed, unpacked
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.trace import trace
from periodic.tracing.watch import Watch


def traced(
    crowd: Crowd,
    parameter: str,
    bounds: tuple[float, float],
    *,
    start: float,
    guess: Orbit,
    tol: float,
    at: Sequence[float] = (),
    determined: Mapping[str, Condition] | None = None,
    method: Discretisation | None = None,
    control: ArclengthControl | None = None,
) -> Branch:
    """Return the branch of a guess, at the parameters of a crowd, as `trace` does. Raises its errors."""
    given = {"start": start, "at": at, "tol": tol, "determined": determined, "control": control}
    kept, key = work().kept, ""
    if kept:
        said = described([parameter, bounds, given, guess, type(method).__name__])
        key = digest(crowd.identity.encode(), json.dumps(said).encode())
        if held := kept.get(key):
            return Branch(**vars(unpacked(held)))
    branch = trace(
        crowd.system,
        parameter,
        bounds,
        start=start,
        at=at,
        guess=guess,
        tol=tol,
        determined=determined,
        method=method,
        control=control,
        watch=Watch(peaks={}, progress=lambda point: None),
    )
    if kept and len(branch):
        kept.add(key, packed(branch))
    return branch
