"""What failures are called, and how increments are measured for convergence and damping."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import along

from periodic.correction import newton
from periodic.correction.newton import Equations
from periodic.correction.outcome import EventsCrossedError, Outcome, outcome_of


@pytest.mark.parametrize(
    ("failure", "outcome"),
    [
        (np.linalg.LinAlgError("singular"), Outcome.SINGULAR),
        (EventsCrossedError(), Outcome.EVENTS_CROSSED),
        (FloatingPointError("nan"), Outcome.NOT_FINITE),
        (ArithmeticError("integration"), Outcome.NOT_INTEGRATED),
    ],
)
def test_failures_by_name(failure: Exception, outcome: Outcome) -> None:
    """Assert the outcome that each stands for."""
    assert outcome_of(failure) is outcome


def sizes(monkeypatch: pytest.MonkeyPatch, height: float = 0.5, **given: Any) -> tuple[float, float]:
    """Sizes of an increment of nodes, stages, phases, a parameter and an unknown at 1, on even intervals."""
    orbit = along(lambda tau: height * np.sin(tau)[:, None])
    unknown = np.ones((*orbit.stages.shape[:2], 1))
    parts = {"nodes": 0.0, "stages": 0.0, "phases": 0.0, "parameter": 0.0, "unknown": 0.0} | given
    at: Any = SimpleNamespace(
        span=orbit.span, parameter=np.array([parts.get("at", 2.0)]), algebraic=unknown, grid=orbit.grid
    )
    change = np.zeros_like(unknown)
    change[3, 1] = parts["unknown"]
    increment: Any = SimpleNamespace(
        nodes=np.array([[parts["nodes"], 0.0]]),
        stages=np.array([[[0.0, parts["stages"]]]]),
        phases=np.array([parts["phases"]]),
        parameters=np.array([parts["parameter"]]),
        algebraic=change,
    )
    monkeypatch.setattr(newton, "moved_unknowns", lambda system, unknowns, by: unknowns + by)
    own: Any = SimpleNamespace(
        free=(0,),
        system=SimpleNamespace(nominal=np.array([parts.get("nominal", 4.0)])),
        settings=SimpleNamespace(tiny=1e-3, negligible=1e-6, short=parts.get("short", 0.01)),
    )
    operator: Any = SimpleNamespace(orbit=at, effect=np.array([parts.get("effect", 1.0)]))
    return Equations._sizes(own, operator, increment)


def test_states_count_relative_to_the_orbit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the larger of both sizes, over the peak to peak where that exceeds 1, and phases as they are."""
    assert sizes(monkeypatch, nodes=-0.3, stages=0.2) == pytest.approx((0.3, 0.3))
    assert sizes(monkeypatch, nodes=-0.1, stages=0.2) == pytest.approx((0.2, 0.2))
    assert sizes(monkeypatch, height=5.0, nodes=-0.3, stages=0.2) == pytest.approx((0.03, 0.03), rel=1e-3)
    assert sizes(monkeypatch, height=5.0, nodes=-0.3, phases=-0.2) == pytest.approx((0.2, 0.2))


@pytest.mark.parametrize(
    ("at", "nominal", "effect", "size"),
    [
        (2.0, 4.0, 1e-9, 0.1 / 4.0),
        (2.0, 4.0, 1.0, 0.1 / 2.0),
        (5.0, 4.0, 1e-9, 0.1 / 5.0),
        (0.0, 4.0, 1e-5, 0.1 / 0.1),
        (0.0, 4.0, 0.0, 0.1 / 4.0),
        (0.0, 0.0, 0.0, 0.1 / 1e-3),
        (-2.0, -1.0, 1.0, 0.1 / 2.0),
    ],
)
def test_parameters_count_relative_to_their_values(
    at: float, nominal: float, effect: float, size: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert a change of 0.1 over the value, or over what hardly changes the states where that is more."""
    found = sizes(monkeypatch, parameter=-0.1, at=at, nominal=nominal, effect=effect)
    assert found == pytest.approx((size, size))


@pytest.mark.parametrize(("short", "weight"), [(0.01, 1.0), (np.pi / 10, 0.5)])
def test_unknowns_count_with_their_square(
    short: float, weight: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert (0.4 / 2)^2 for convergence, and for damping 0.4 / 2, less in intervals that are short."""
    assert sizes(monkeypatch, unknown=-0.4, short=short) == pytest.approx((0.04, 0.2 * weight))


@pytest.mark.parametrize("part", ["nodes", "stages", "phases", "parameter", "unknown"])
def test_increments_that_are_not_finite(part: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that they are infinite in both."""
    with np.errstate(invalid="ignore"):
        assert sizes(monkeypatch, **{part: np.nan}) == (np.inf, np.inf)
        assert sizes(monkeypatch, **{part: np.inf}) == (np.inf, np.inf)
