"""How extremes change along a branch, against their exact derivatives and against the branch itself."""

from __future__ import annotations

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.correction.measured import measured
from periodic.correction.solution import Solution
from periodic.tracing.steps.leveltest import rate_of


def solutions(system: sym.CompiledSystem, parameter: str, bounds: tuple[float, float]) -> list[Solution]:
    """The ends of the first eight steps of a branch from the lower bound."""
    run, found = per.continuation(per.Problem(system, parameter, bounds), bounds[0]), []
    for _, _ in zip(range(8), run, strict=False):
        if run.state is not None:
            found.append(run.state.last)
    return found


@pytest.mark.parametrize("scene", ["duffing", "gear-pair"])
def test_slopes_are_those_of_the_functionals(scene: str) -> None:
    """Assert d maximum and d minimum / d arclength to 1e-6 of the larger one, or to 1e-10, of each output."""
    system = sym.scene(scene)
    for solution in solutions(system, "Omega", (0.5, 1.2)):
        found = measured(solution)
        for k, output in enumerate(system.outputs):
            slopes = found.minimum_slope[k], found.maximum_slope[k]
            exact = [rate_of(kind(output.name))(solution) for kind in (per.Minimum, per.Maximum)]
            assert slopes == pytest.approx(exact, abs=1e-6 * max(map(abs, exact)) + 1e-10)
            assert found.peak_to_peak_slope[k] == pytest.approx(exact[1] - exact[0], rel=1e-5, abs=1e-10)
        assert measured(solution) is found


def test_extreme_at_an_event_moves_with_it() -> None:
    """Assert the greatest speed of a mass before a wall, which is that of its impacts, by differences."""
    x, omega = sym.coordinate("x"), sym.parameter("Omega", 2.5, "rad/s")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.1), sym.HarmonicForce(x, 1.0, omega)]
    speed = sym.Equations(
        lambda s, p: {"slow": s.x_dot - s.slow},
        {"slow": 0.0},
        {},
        coordinates=[x],
        outputs=lambda s, p: {"speed": s.x_dot},
    )
    system = sym.compile(sym.combine([*parts, sym.RigidStop(x, 0.1, 0.8), speed]))
    branch = per.trace(
        system, "Omega", (2.4, 2.6), start=2.5, control=per.ArclengthControl(ds=0.01, ds_max=0.01)
    )
    k = len(branch) // 2
    before, point, after = branch[k - 1], branch[k], branch[k + 1]
    assert np.isin("GR", [p.label for p in (before, point, after)]).sum() == 0
    for extremes, slopes in (("minimum", "minimum_slope"), ("maximum", "maximum_slope")):
        ends = [getattr(p, extremes)["speed"] for p in (before, after)]
        rise = (ends[1] - ends[0]) / (after.parameter - before.parameter)
        assert getattr(point, slopes)["speed"] / point.slope == pytest.approx(rise, rel=1e-3)
