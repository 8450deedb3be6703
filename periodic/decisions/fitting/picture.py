"""The picture of a fit: measured points beside the branch, and their residuals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from periodic.conditions.functionals import Smooth
from periodic.decisions.fitting.match import Foot, Match
from periodic.decisions.fitting.measured import Measured
from periodic.decisions.responses.words import called
from periodic.orbit.scheme import Array
from periodic.results.betweenpoints import smooth
from periodic.results.branch import Branch

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw(match: Match, tests: Sequence[tuple[Measured, Branch]], functional: Smooth | None) -> Axes:
    """Draw a functional over place, of measured points and of the model, above their residuals.

    Raises ValueError where nothing was measured of it.
    """
    from matplotlib import pyplot

    known = [f for test, _ in tests for f in test.values]
    chosen = known[0] if functional is None and known else functional
    if chosen not in known:
        raise ValueError(f"functional is {chosen!r}; it must be one of which points were measured")
    figure, (upper, lower) = pyplot.subplots(
        2, 1, sharex=True, layout="constrained", gridspec_kw={"height_ratios": (3, 1)}
    )
    feet = [part for part in match.parts if isinstance(part, Foot)]
    for k, (test, branch) in enumerate((t, b) for t, b in tests if chosen in t.values):
        own = [foot for foot in feet if foot.spot.measured is test]
        look: dict[str, Any] = {"color": f"C{k}", "linestyle": "none"}
        upper.plot(*_curve(own[0], branch, chosen), "-", color=f"C{k}", linewidth=1.0)
        upper.plot(test.places, test.values[chosen], marker="o", fillstyle="none", label=test.name, **look)
        column = 1 + list(test.values).index(chosen)
        lower.plot(test.places, [foot.difference[column] for foot in own], marker="o", **look)
        lower.plot(test.places, [foot.difference[0] for foot in own], marker="x", **look)
        lower.set_xlabel(test.response.parameter)
    lower.axhline(0.0, color="0.6", linewidth=0.8)
    lower.set_ylabel("residual / sigma\n(x: of the place)")
    upper.set_ylabel(called(chosen), parse_math=False)
    upper.legend()
    return cast("Axes", upper)


def _curve(foot: Foot, branch: Branch, functional: Smooth) -> tuple[Array, Array]:
    """The model's curve, as the sensor would see it."""
    target = next(t for t in foot.spot.targets if t.functional == functional)
    values = np.array([functional(foot.way.system, point.orbit) for point in branch])
    return smooth(branch.values, target.gain * values + target.offset)
