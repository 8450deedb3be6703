"""What tracing refuses, and in which words."""

from __future__ import annotations

import math
import re

import pytest
from numpy_systems import LinearOscillator

import periodic as per
import symbolic as sym

NAN, INFINITE = math.nan, math.inf
REFUSED_TRACES = [
    ({"parameter": "speed"}, "parameter is 'speed'; it must be one of Omega, zeta, F"),
    ({"parameter": ""}, "parameter is ''; it must be one of Omega, zeta, F"),
    ({"bounds": (1.0,)}, "bounds of Omega are (1.0,); they must be two different finite numbers"),
    ({"bounds": 1.0}, "bounds of Omega are 1.0; they must be two different finite numbers"),
    ({"at": 0.2}, "at is 0.2; it must lie within the bounds 0.4 to 1.6"),
    ({"accuracy": "fine"}, "accuracy is 'fine'; it must be Accuracy.DRAFT, .STANDARD or .FINE"),
    ({"bounds": (1.0, 1.0)}, "bounds of Omega are (1.0, 1.0); they must be two different finite numbers"),
    ({"bounds": (0.4, NAN)}, "bounds of Omega are (0.4, nan); they must be two different finite numbers"),
    (
        {"bounds": (0.4, INFINITE)},
        "bounds of Omega are (0.4, inf); they must be two different finite numbers",
    ),
    ({"start": 2.0}, "start is 2.0; it must lie within the bounds 0.4 to 1.6"),
    ({"start": NAN}, "start is nan; it must lie within the bounds 0.4 to 1.6"),
    ({"at": (0.5, 0.3)}, "at is 0.3; it must lie within the bounds 0.4 to 1.6"),
    ({"at": (NAN,)}, "at is nan; it must lie within the bounds 0.4 to 1.6"),
]
REFUSED_SETTINGS = [
    (per.MeshSettings, "tolerance", (0.0, -1e-7, 1.0, NAN, INFINITE, 1e-20)),
    (per.MeshSettings, "ntst", (0, -1, 5, 2000, 24.5, NAN)),
    (per.MeshSettings, "ntst_min", (0, 8.5)),
    (per.MeshSettings, "ntst_max", (0, NAN)),
    (per.StepSettings, "ds", (0.0, -0.1, 1.0, NAN, INFINITE)),
    (per.StepSettings, "ds_min", (0.0, -1.0, NAN)),
    (per.StepSettings, "ds_max", (0.0, NAN)),
    (per.StepSettings, "turn", (NAN, 1.0, 2.0)),
    (per.StepSettings, "max_points", (0, -3)),
    (per.NewtonSettings, "tolerance", (0.0, -1.0, 1.0, NAN)),
    (per.NewtonSettings, "max_iterations", (0, -1)),
]


@pytest.mark.parametrize("change, sentence", REFUSED_TRACES)
def test_refused_traces(change: dict[str, object], sentence: str) -> None:
    """Assert that a trace which makes no sense is refused in one sentence."""
    asked = {"parameter": "Omega", "bounds": (0.4, 1.6), **change}
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}$"):
        per.trace(LinearOscillator(), **asked)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "kind, name, value", [(kind, name, v) for kind, name, values in REFUSED_SETTINGS for v in values]
)
def test_refused_settings(kind: type, name: str, value: float) -> None:
    """Assert that settings out of range are refused in a sentence of what is wrong and what is allowed."""
    with pytest.raises(ValueError, match=r"^[^\n]* is [^\n]*; it must [^\n]*$"):
        kind(**{name: value})


def test_settings_are_frozen() -> None:
    """Assert that settings cannot be changed, and that a mistyped one does not pass."""
    settings = per.StepSettings()
    with pytest.raises(AttributeError):
        settings.ds = 1.0  # type: ignore[misc]
    with pytest.raises(TypeError):
        per.StepSettings(step=0.1)  # type: ignore[call-arg]


def test_accuracies_differ_in_tolerance() -> None:
    """Assert that each accuracy has a smaller tolerance than the one before, and no fewer points."""
    meshes = [accuracy.settings().mesh for accuracy in per.Accuracy]
    assert [a.tolerance > b.tolerance for a, b in zip(meshes, meshes[1:], strict=False)] == [True, True]
    assert [a.scheme.ncol <= b.scheme.ncol for a, b in zip(meshes, meshes[1:], strict=False)] == [True, True]


def test_refused_system() -> None:
    """Assert that a model which was not compiled is refused in one sentence."""
    x = sym.coordinate("x")
    with pytest.raises(ValueError, match="^system is a Model without states, .*symbolic.compile makes one"):
        per.trace(sym.Mass(x, 1.0) + sym.Spring(x, 1.0), "Omega", (0.5, 1.0))  # type: ignore[arg-type]


def test_one_value_at() -> None:
    """Assert that a single value needs no list."""
    branch = per.trace(LinearOscillator(), "Omega", (0.4, 0.6), at=0.5)  # type: ignore[arg-type]
    assert [p.parameter for p in branch.labelled(per.Label.USER)] == [0.5]


def test_short_names_of_results() -> None:
    """Assert that branches, points and orbits tell what they are in a line."""
    branch = per.trace(LinearOscillator(), "Omega", (0.4, 0.6))
    assert repr(branch) == f"Branch(Omega, {len(branch)} points, bound reached: upper end of the range)"
    assert repr(branch[0]) == "Point(0.4, EP stable)"
    assert re.fullmatch(r"Orbit\(\d+ intervals, 2 states, 1 periods\)", repr(branch[0].orbit))
