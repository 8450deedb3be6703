"""What users write of symbols: it works, or one sentence quotes it and names what does."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym

F = sym.functions
Term = Callable[[Any], Any]


def compiled(term: Term) -> sym.CompiledSystem:
    """An oscillator with a term in its acceleration."""
    return sym.compile(
        sym.Equations(lambda x, p: {"x": x.v, "v": -x.x + term(x)}, {"x": 0.3, "v": 0.2}, {"c": 1.0})
    )


def residual(term: Term) -> np.ndarray[Any, Any]:
    """The residual of the oscillator at some states, on both sides of its kinks."""
    system = compiled(term)
    count = len(system.parameters)
    state = np.array([[0.7, 0.2], [-0.6, 0.1], [0.1, -0.9], [1.4, 2.0]])
    parameters = np.array([parameter.value for parameter in system.parameters]).reshape(count)
    return system.residual(np.zeros((4, 2)), state, np.zeros((4, 0)), np.zeros(4), parameters)


SAME: list[tuple[Term, Term]] = [
    (lambda x: np.sin(x.x), lambda x: F.sin(x.x)),
    (lambda x: np.exp(-x.x) + np.sqrt(1 + x.v**2), lambda x: F.exp(-x.x) + F.sqrt(1 + x.v**2)),
    (lambda x: abs(x.x), lambda x: F.fabs(x.x)),
    (lambda x: np.abs(x.x), lambda x: F.fabs(x.x)),
    (lambda x: np.maximum(x.x, 0), lambda x: F.fmax(x.x, 0)),
    (lambda x: np.minimum(0.5, x.x), lambda x: F.fmin(0.5, x.x)),
    (lambda x: np.clip(x.x, -0.5, 0.5), lambda x: F.clip(x.x, -0.5, 0.5)),
    (lambda x: np.where(x.x > 0, x.v, 0), lambda x: F.if_else(x.x > 0, x.v, 0)),
    (lambda x: np.arctan2(x.x, x.v), lambda x: F.atan2(x.x, x.v)),
    (lambda x: np.dot(np.array([1.0, 2.0]), np.array([x.x, x.v])), lambda x: x.x + 2 * x.v),
    (lambda x: sum(np.sin(np.array([x.x, x.v]))), lambda x: F.sin(x.x) + F.sin(x.v)),
]


@pytest.mark.parametrize("pair", range(len(SAME)))
def test_functions_of_numpy_work(pair: int) -> None:
    """Assert that functions of NumPy's give the same equations and switches as ours, without a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        of_numpy, ours = SAME[pair]
        assert np.array_equal(residual(of_numpy), residual(ours))
    assert len(compiled(of_numpy).switches) == len(compiled(ours).switches)


def test_interp_of_numpy_is_traced() -> None:
    """Assert that a spring by np.interp has the branch of the same spring by our interp, kinks and all."""
    line = ([-2.0, -0.5, 0.5, 2.0], [-4.0, -0.5, 0.5, 4.0])

    def branch(interp: Callable[..., Any]) -> per.Branch:
        def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
            return {"x": x.v, "v": -interp(x.x, *line) - 0.2 * x.v + 0.5 * wave.cos}

        states = {"x": 0.0, "v": 0.0}
        return per.trace(
            sym.compile(sym.Equations(rates, states, {"Omega": 1.0}, frequency="Omega")),
            "Omega",
            (0.8, 1.0),
            at=[0.9],
        )

    numpy, ours = branch(np.interp), branch(F.interp)
    (point,), (other,) = numpy.labelled("UZ"), ours.labelled("UZ")
    assert point.peak_to_peak("x") == pytest.approx(other.peak_to_peak("x"), rel=1e-6)
    assert point.multipliers == pytest.approx(other.multipliers, rel=1e-5)


F_MAX, F_MIN, IF_ELSE = (f"; it must use symbolic.functions.{name}" for name in ("fmax", "fmin", "if_else"))
DECIDES, MAKES = "function decides by a symbol in ", "function makes "
UNABLE = " of a symbol, which has no such operation; it must use arithmetic and the functions of "
STEPS = "the equations use floor of what moves, as % does; they must say where it jumps by if_else of "
WRONG: list[tuple[Term, str]] = [
    (lambda x: max(x.x, 0), f"{DECIDES}`max(x.x, 0)`{F_MAX}"),
    (lambda x: min(x.x, 0), f"{DECIDES}`min(x.x, 0)`{F_MIN}"),
    (lambda x: 1 if x.x > 0 else 0, f"{DECIDES}`x.x > 0`{IF_ELSE}"),
    (lambda x: np.max([x.x, x.v]), f"{DECIDES}`np.max([x.x, x.v])`{F_MAX}"),
    (lambda x: int(x.x), f"{MAKES}`int(x.x)`{UNABLE}"),
    (lambda x: np.polyval([1, 2], x.x), f"{MAKES}`np.polyval([1, 2], x.x)`{UNABLE}"),
    (lambda x: x.x + "a", f'{MAKES}`x.x + "a"`{UNABLE}'),
    (lambda x: x.x % 1, STEPS),
]


@pytest.mark.parametrize("case", range(len(WRONG)))
def test_what_does_not_work_is_quoted(case: int) -> None:
    """Assert the sentence, on one line, without a path of CasADi's."""
    term, said = WRONG[case]
    with pytest.raises(ValueError) as caught:
        compiled(term)
    assert str(caught.value).startswith(said)
    assert "\n" not in str(caught.value) and ".cpp" not in str(caught.value)


def test_source_that_is_not_there() -> None:
    """Assert a sentence also for what was typed where nothing is kept of it."""
    term = eval("lambda x: max(x.x, 0)")
    with pytest.raises(ValueError, match="decides by a symbol, as if, and, or, max and min do; it must"):
        compiled(term)


def test_mistakes_of_other_kinds_are_left_alone() -> None:
    """Assert that an error that has nothing to do with symbols is the user's own."""
    with pytest.raises(TypeError, match="unsupported operand"):
        compiled(lambda x: 1 + "a")  # type: ignore[operator]


@dataclass(frozen=True)
class Limited(sym.Part):
    """A part whose author decides by a symbol."""

    q: sym.Coordinate
    kind: str

    def contribute(self, assembly: sym.Assembly) -> None:
        """Add a force."""
        motion = assembly.motion(self.q)
        x = motion.position.symbol
        motion.force -= {
            "max": lambda: max(x, 0),
            "numpy": lambda: np.maximum(x, 0),
            "nan": lambda: x + np.nan,
        }[self.kind]()


def test_parts_of_ones_own() -> None:
    """Assert that parts have the same sentences under their own name, and NumPy's functions too."""
    x = sym.coordinate("x")
    assert sym.compile(sym.Mass(x, 1.0) + Limited(x, "numpy")).switches
    with pytest.raises(
        ValueError, match=r"^Limited decides by a symbol in `max\(x, 0\)`; it must use symbolic.f"
    ):
        sym.compile(sym.Mass(x, 1.0) + Limited(x, "max"))
    with pytest.raises(
        ValueError, match="the equations have NaN in them; they must use the functions of symbolic"
    ):
        sym.compile(sym.Mass(x, 1.0) + Limited(x, "nan"))
