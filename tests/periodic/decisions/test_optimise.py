"""Optimal designs against brute force, anchors, and derivatives of optima against optima found anew."""

from __future__ import annotations

import math

import pytest
from scipy.optimize import minimize, minimize_scalar

import periodic as per
import symbolic as sym
from reports.studies.decide.designs import absorber

SWING = per.PeakToPeak("x")
LIMIT = {"F_slider": (0.09, 0.25)}
RANGE = (0.9, 1.4)


def damper() -> sym.CompiledSystem:
    """The friction damper of the scenes."""
    return sym.scene("jenkins-damper")


def highest(system: sym.CompiledSystem, values: dict[str, float], bounds: tuple[float, float]) -> float:
    """The highest peak of x, of a branch traced for it."""
    branch = per.trace(system, "Omega", bounds, values=values)
    return max(point.peak_to_peak("x") for point in branch)


def test_friction_damper_is_that_of_brute_force_and_scales() -> None:
    """Assert the limit of the lowest peak against a search by traces; twice the force needs twice of it."""
    response = per.Response("Omega", RANGE)
    once = per.optimise(damper(), LIMIT, minimise=response.highest(SWING), start={"F_slider": 0.1})
    assert once.ok
    brute = minimize_scalar(
        lambda limit: highest(damper(), {"F_slider": limit}, RANGE),
        bounds=(0.12, 0.16),
        method="bounded",
        options={"xatol": 3e-4},
    )
    assert once.objective == pytest.approx(brute.fun, rel=1e-6)
    assert once.values["F_slider"] == pytest.approx(brute.x, rel=5e-3)
    twice = per.optimise(
        damper(),
        {"F_slider": (0.18, 0.5)},
        minimise=per.Response("Omega", RANGE, values={"F": 0.2}).highest(SWING),
    )
    assert twice.values["F_slider"] == pytest.approx(2 * once.values["F_slider"], rel=1e-5)
    assert twice.objective == pytest.approx(2 * once.objective, rel=1e-7)


def test_absorber_has_two_peaks_of_one_height() -> None:
    """Assert the optimum of two parameters against Nelder and Mead on traces, and its derivatives."""
    free, response = {"k2": (0.03, 0.06), "c2": (0.004, 0.03)}, per.Response("Omega", (0.6, 1.8))
    found = per.optimise(absorber(), free, minimise=response.highest(SWING))
    assert found.ok and len(found.decisive) == 2
    assert sum(found.decisive.values()) == pytest.approx(1.0, abs=1e-6)
    heights = [p.peak_to_peak("x") for p in found.branches[0].labelled("PK")]
    assert sorted(heights)[-1] == pytest.approx(sorted(heights)[-2], rel=1e-7)
    begin = [found.values["k2"] * 1.005, found.values["c2"] * 0.99]
    brute = minimize(
        lambda v: highest(absorber(), {"k2": v[0], "c2": v[1]}, (0.6, 1.8)),
        begin,
        method="Nelder-Mead",
        options={"xatol": 1e-6, "fatol": 1e-9, "maxfev": 45},
    )
    assert found.objective <= brute.fun * (1 + 1e-7)
    assert found.objective == pytest.approx(brute.fun, rel=1e-5)
    step = 1e-3
    ends = [
        per.optimise(
            absorber(), free, minimise=per.Response("Omega", (0.6, 1.8), values={"F": f}).highest(SWING)
        ).objective
        for f in (0.05 + step, 0.05 - step)
    ]
    assert found.derivatives["F"] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-3)


def test_constraints_bounds_and_maxima() -> None:
    """Assert a constraint that decides, a parameter at its end, and the opposite of a minimum."""
    system = sym.scene("duffing")
    response = per.Response("Omega", (0.5, 2.6))
    jump = response.place("LP")
    found = per.optimise(
        system,
        {"c": (0.08, 0.2), "k3": (0.5, 1.5)},
        minimise=response.highest(SWING),
        subject_to=[jump >= 2.0],
    )
    assert found.ok
    assert found.constraints[0] == pytest.approx(2.0, rel=1e-6)
    assert found.at_bounds == ("k3",)
    alone = per.optimise(system, {"c": (0.08, 0.2)}, minimise=response.highest(SWING))
    assert alone.values == {"c": 0.2} and alone.at_bounds == ("c",)
    other = per.optimise(system, {"c": (0.08, 0.2)}, maximise=response.place("LP"))
    assert other.values == {"c": 0.08} and other.ok
    at = per.optimise(system, {"k3": (0.5, 1.5)}, minimise=response.at(1.0, SWING))
    assert at.values == {"k3": 1.5}
    low = per.optimise(system, {"c": (0.08, 0.2)}, maximise=response.lowest(per.Minimum("x")))
    assert low.values == {"c": 0.2}


def test_what_cannot_be_met_is_said() -> None:
    """Assert that a design that there is not is no optimum, and how much is missing."""
    response = per.Response("Omega", (0.5, 2.6))
    found = per.optimise(
        sym.scene("duffing"),
        {"c": (0.08, 0.2)},
        minimise=response.place("LP"),
        subject_to=[response.highest(SWING) <= 1.0],
    )
    assert not found.ok
    assert "no design was found with highest" in found.reason and "misses by" in found.reason


def test_gradients_are_those_of_differences() -> None:
    """Assert gradients of peaks and folds to 1e-6 of central differences of features found anew."""
    from periodic.decisions.responses.feature import Count
    from periodic.decisions.responses.readquantities import traced

    response = per.Response("Omega", (0.5, 2.6), tol=1e-9)
    quantities = [response.highest(SWING), response.place("LP"), response.at(1.0, SWING)]
    system = sym.scene("duffing")
    middle = traced(system, quantities, {"c": 0.1}, Count())
    for k, feature in enumerate(middle.decisive):
        step = 1e-4
        ends = [middle.at({"c": 0.1 + side * step}).decisive[k].value for side in (1, -1)]
        assert feature.gradient["c"] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-5)


@pytest.mark.parametrize(
    ("free", "arguments", "said"),
    [
        ({}, {}, "free is empty"),
        ({"d": (0, 1)}, {}, "a name in free is 'd'; it must be one of"),
        ({"c": (0.2, 0.1)}, {}, "must be two rising finite numbers"),
        ({"c": 3}, {}, "must be two numbers, the smaller first"),
        ({"c": (0.1, math.inf)}, {}, "must be two rising finite numbers"),
        ({"c": (0.1, 0.2)}, {"minimise": None}, "must be one of the two"),
        ({"c": (0.1, 0.2)}, {"minimise": 3}, "objective is 3; it must be a quantity"),
        ({"c": (0.1, 0.2)}, {"start": {"c": 1.0}}, "it must lie in its range"),
        ({"c": (0.1, 0.2)}, {"start": {"k": 1.0}}, "a name in start is 'k'"),
        ({"c": (0.1, 0.2)}, {"subject_to": [True]}, "subject_to has True"),
        ({"Omega": (1.0, 2.0)}, {}, "Omega is free, and also given by the response"),
    ],
)
def test_bad_input(free: object, arguments: dict[str, object], said: str) -> None:
    """Assert one sentence for what is not allowed."""
    given = {"minimise": per.Response("Omega", (0.5, 2.6)).highest(SWING), **arguments}
    with pytest.raises(ValueError, match=said):
        per.optimise(sym.scene("duffing"), free, **given)  # type: ignore[arg-type]


def test_bad_responses() -> None:
    """Assert sentences of responses and quantities."""
    response = per.Response("Omega", (0.5, 2.6))
    with pytest.raises(ValueError, match="bounds of Omega are 3; they must be two numbers"):
        per.Response("Omega", 3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="label is 'XX'; it must be one of LP, PD, NS, GR"):
        response.place("XX")
    with pytest.raises(ValueError, match="value is 9; it must lie within the bounds"):
        response.at(9.0, SWING)
    with pytest.raises(ValueError, match="which has no derivative"):
        response.highest(lambda system, orbit: 1.0)
    with pytest.raises(ValueError, match="bound is nan; it must be finite"):
        response.place("LP") <= math.nan  # noqa: B015
    with pytest.raises(
        ValueError, match="at the start the branch over Omega has 2 points LP, counted from 0, and which is 5"
    ):
        per.optimise(sym.scene("duffing"), {"c": (0.1, 0.2)}, minimise=response.place("LP", which=5))
    with pytest.raises(ValueError, match="at the start the branch over Omega has no point NS"):
        per.optimise(sym.scene("duffing"), {"c": (0.1, 0.2)}, minimise=response.place("NS"))
    with pytest.raises(ValueError, match="output is 'y'; it must be one of x"):
        per.optimise(sym.scene("duffing"), {"c": (0.1, 0.2)}, minimise=response.highest(per.PeakToPeak("y")))
    with pytest.raises(ValueError, match="sheet is 4; the branch has 1 motions at 1"):
        per.optimise(sym.scene("duffing"), {"c": (0.1, 0.2)}, minimise=response.at(1.0, SWING, sheet=4))


def test_a_branch_that_stopped_early_has_no_highest_peak() -> None:
    """Assert that the highest of the peaks before the end of a branch that was cut short is not taken."""
    few = per.Response("Omega", (0.5, 2.6), control=per.ArclengthControl(max_points=5))
    with pytest.raises(ValueError, match="at the start the branch over Omega stopped early: largest number"):
        per.optimise(sym.scene("duffing"), {"c": (0.1, 0.2)}, minimise=few.highest(SWING))
