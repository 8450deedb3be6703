"""What tracing refuses, and in which words."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from support.numpy_systems import LinearOscillator

import periodic as per
import symbolic as sym
from periodic.collocation.meshmethod import scheme_for

NAN, INFINITE = math.nan, math.inf
A_METHOD = "it must be Collocation(), Shooting(), HarmonicBalance() or Equilibrium()"
MAGNITUDE = "from 1e-100 to 1e+100, and so their difference"
HUGE = "a number of too many digits"
REFUSED_TRACES = [
    ({"parameter": "speed"}, "parameter is 'speed'; it must be one of Omega, zeta, F"),
    ({"parameter": ""}, "parameter is ''; it must be one of Omega, zeta, F"),
    ({"bounds": (1.0,)}, "bounds of Omega are (1.0,); they must be two different finite numbers"),
    ({"bounds": 1.0}, "bounds of Omega are 1.0; they must be two different finite numbers"),
    ({"at": 0.2}, "at is 0.2; it must lie within the bounds 0.4 to 1.6"),
    ({"tol": "fine"}, "tol is 'fine'; it must be a number between 1e-11 and 0.01"),
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
    ({"at": "0.5"}, "at is '0.5'; it must be a number"),
    ({"start": "0.5"}, "start is '0.5'; it must be a number"),
    *(
        ({"bounds": ends}, f"bounds of Omega are {ends}; they must be each 0 or of a magnitude {MAGNITUDE}")
        for ends in [(0.5, 1e300), (1e-300, 2e-300), (1e300, 1e-300), (0, 5e-324), (-1.7e308, 1.0)]
    ),
    ({"bounds": (0.5, 10**5000)}, f"bounds of Omega are {HUGE}; they must be two different finite numbers"),
    ({"bounds": "0.5"}, "bounds of Omega are 0.5; they must be two different finite numbers"),
    ({"values": 3}, "values is 3; it must give numbers by their names"),
    ({"determined": 3}, "determined is 3; it must give conditions by their names"),
    ({"method": per.Collocation}, f"method is {per.Collocation!r}; {A_METHOD}"),
    ({"control": 3}, "control is 3; it must be ArclengthControl(...)"),
]
REFUSED_SETTINGS = [
    (per.Tolerance, "orbit", (0.0, -1e-7, 1.0, NAN, INFINITE, 1e-20)),
    (per.Collocation, "ntst", (0, -1, 5, 2000, 24.5, NAN)),
    (per.Collocation, "ntst_min", (0, 8.5)),
    (per.Collocation, "ntst_max", (0, NAN)),
    (per.ArclengthControl, "ds", (0.0, -0.1, 1.0, NAN, INFINITE)),
    (per.ArclengthControl, "ds_min", (0.0, -1.0, NAN)),
    (per.ArclengthControl, "ds_max", (0.0, NAN)),
    (per.ArclengthControl, "turn", (NAN, 1.0, 2.0)),
    (per.ArclengthControl, "max_points", (0, -3)),
    (per.ArclengthControl, "aim", (0.0, -1.0, 1.0, NAN)),
    (per.ArclengthControl, "bend", (0.0, -1.0, NAN)),
    (per.ArclengthControl, "slow", (0.0, INFINITE)),
    (per.ArclengthControl, "patience", (0, 2.5)),
    (per.ArclengthControl, "meshes", (-1, 0)),
    (per.ArclengthControl, "remesh_every", (0, -3)),
    (per.ArclengthControl, "growth", (((0, 2.0),), ((3, -1.0),))),
    (per.NewtonSettings, "max_change", (0.0, -1.0, NAN)),
    (per.NewtonSettings, "short", (0.0, INFINITE)),
    (per.NewtonSettings, "max_halvings", (-1, NAN)),
    (per.KinkSettings, "deepest", (-1.0, NAN)),
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
    settings = per.ArclengthControl()
    with pytest.raises(AttributeError):
        settings.ds = 1.0  # type: ignore[misc]
    with pytest.raises(TypeError):
        per.ArclengthControl(step=0.1)  # type: ignore[call-arg]


def test_accuracies_differ_in_tolerance() -> None:
    """Assert that each accuracy has a smaller tolerance than the one before, and no fewer points."""
    coarse_to_fine = list(per.Accuracy)
    assert coarse_to_fine == sorted(per.Accuracy, reverse=True) and len(set(coarse_to_fine)) == 3
    points = [scheme_for(accuracy).ncol for accuracy in coarse_to_fine]
    assert points == sorted(points)


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


def test_unfinished_discretisation() -> None:
    """Assert that a discretisation without one of its five methods cannot be made."""

    class Half(per.extend.Discretisation):
        def guess(self, system: per.extend.System, parameter: object, near: object) -> per.Orbit:
            raise NotImplementedError

    with pytest.raises(TypeError, match="abstract"):
        Half()  # type: ignore[abstract]


def test_what_is_no_special_point_is_refused() -> None:
    """Assert that a watch takes test functions alone."""
    with pytest.raises(ValueError, match=r"^special has 3; it must be a TestFunction\(label=, value=\)$"):
        per.Watch(special=(3,))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("watched", "sentence"),
    [
        ({"stop": "LP"}, "stop is 'LP'; it must give counts by their names"),
        ({"columns": {3: len}}, f"columns is {{3: {len!r}}}; it must give functionals by their names"),
        ({"columns": {"x": "x"}}, "column x is 'x'; it must be a functional of an orbit"),
        (
            {"columns": {"x": per.Maximum}},
            f"column x is {per.Maximum!r}; it must be a functional of an orbit",
        ),
        ({"limits": {"F": 3}}, "limits of F are 3; they must be two rising finite numbers"),
        ({"limits": {"F": ("a", 2)}}, "limits of F are ('a', 2); they must be two rising finite numbers"),
        ({"events": {"LP": per.Level(per.Maximum("x"), 1.0)}}, "events has 'LP', which is a label; it must "),
        ({"progress": 3}, "progress is 3; it must be a function of a point"),
        ({"journal": 3}, "journal is 3; it must be the name of a file"),
    ],
)
def test_refused_watches(watched: dict[str, object], sentence: str) -> None:
    """Assert that what cannot be watched is refused in one sentence."""
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}"):
        per.Watch(**watched)  # type: ignore[arg-type]


def test_columns_that_there_are_already_are_refused() -> None:
    """Assert that a column cannot take the name of a parameter, an output's extreme or a mark."""
    for name in ("Omega", "x max", "label", "residual"):
        watch = per.Watch(columns={name: per.Maximum("x")})
        with pytest.raises(ValueError, match=f"^columns has '{name}', which branches have already"):
            per.trace(LinearOscillator(), "Omega", (0.4, 0.6), watch=watch)


@pytest.mark.parametrize(
    ("function", "arguments"),
    [
        (per.extrema, ("a", None)),
        (per.doubled, (LinearOscillator(), None, "Omega")),
        (per.sensitivities, (LinearOscillator(), None, {})),
        (per.trace, ("a", "Omega", (0.0, 1.0))),
    ],
)
def test_what_is_no_orbit_or_system_is_refused(function: Any, arguments: tuple[Any, ...]) -> None:
    """Assert that functions of a system and an orbit say which of them is none."""
    with pytest.raises(ValueError, match="^(system|orbit) is a (str|NoneType)"):
        function(*arguments)


def test_negative_frequencies_are_refused() -> None:
    """Assert that a range of an excitation's frequency cannot begin below 0."""
    with pytest.raises(
        ValueError, match=r"^bounds is \(-1, 3\); 'Omega', a frequency, must not be negative$"
    ):
        per.trace(sym.scene("duffing"), "Omega", (-1, 3))


@pytest.mark.parametrize("low", [-1e-3, -0.5, -2.0])
def test_frequencies_are_not_negative(low: float) -> None:
    """Assert that a range of a frequency that begins below 0 is refused, and that of a force is not."""
    with pytest.raises(
        ValueError, match=f"^bounds is .{low:g}, 2.; 'Omega', a frequency, must not be negative$"
    ):
        per.trace(sym.scene("duffing"), "Omega", (low, 2.0))
    few = per.ArclengthControl(max_points=1)
    assert len(per.trace(sym.scene("duffing"), "F", (low, 2.0), start=1.0, control=few)) == 1


@pytest.mark.parametrize(
    ("start", "at", "said"), [(0.4999, (), "start is 0.4999"), (None, (2.0001,), "at is 2.0001")]
)
def test_values_outside_the_bounds(start: float | None, at: tuple[float, ...], said: str) -> None:
    """Assert that a start and a value asked for lie within the bounds, their ends included."""
    few = per.ArclengthControl(max_points=1)
    with pytest.raises(ValueError, match=said):
        per.trace(sym.scene("duffing"), "Omega", (0.5, 2.0), start=start, at=at, control=few)
    branch = per.trace(sym.scene("duffing"), "Omega", (0.5, 2.0), start=2.0, at=(0.5, 2.0), control=few)
    assert branch[-1].parameter == 2.0
