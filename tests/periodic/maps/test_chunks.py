"""What becomes of the cells of a chunk: reasons, and numbers that users' functions give."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.maps import chunks


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ValueError("k is -1;\n it must be positive"), "k is -1; it must be positive"),
        (ValueError(), "ValueError: "),
        (RuntimeError("lost"), "RuntimeError: lost"),
        (ZeroDivisionError("division by  zero"), "ZeroDivisionError: division by zero"),
    ],
)
def test_exceptions_as_reasons(error: Exception, said: str) -> None:
    """Assert one line, with the name of those whose sentence is none of ours."""
    assert chunks._said(error) == said


@pytest.mark.parametrize(
    ("given", "number"),
    [(2, 2.0), (np.float32(0.5), 0.5), ([1, 2], [1.0, 2.0]), (np.array([]), []), (True, 1.0)],
)
def test_numbers(given: Any, number: Any) -> None:
    """Assert floats, or lists of them."""
    found = chunks._number("amplitude", given)
    assert found == number and type(found) is type(number)


@pytest.mark.parametrize("given", ["high", [[1.0, 2.0]], [1.0, [2.0]], {"a": 1.0}])
def test_what_is_no_number(given: Any) -> None:
    """Assert the sentence that quotes it."""
    with pytest.raises(TypeError, match="^number amplitude gave .*; it must give a number or a sequence of"):
        chunks._number("amplitude", given)


def task(**numbers: Any) -> Any:
    """A task with numbers of branches."""
    return SimpleNamespace(numbers=numbers)


def test_numbers_of_a_branch() -> None:
    """Assert the names of those that come as a mapping, and why there are none where one fails."""
    parts = {"low": 1, "high": [2]}
    given = task(peak=lambda task, branch: branch + 1, width=lambda task, branch: parts)
    assert chunks._read(given, 3) == ({"peak": 4.0, "width low": 1.0, "width high": [2.0]}, "")  # type: ignore[arg-type]

    def fails(task: Any, branch: Any) -> float:
        raise ArithmeticError("no peak")

    given = task(peak=lambda task, branch: 1.0, width=fails)
    assert chunks._read(given, 3) == ({}, "width: ArithmeticError: no peak")  # type: ignore[arg-type]


class Traced:
    """A task whose branches begin where they are told to; from a neighbour they may end early."""

    begin = 0.5

    def __init__(self, near: Any) -> None:
        self.near, self.asked = near, list[Any]()

    def traced(self, values: Any, near: Any) -> Any:
        """The branch of a cell."""
        self.asked.append(near)
        found = self.near if near is not None else ("own", 0.5, ())
        if isinstance(found, Exception):
            raise found
        name, begin, reasons = found
        stops = [SimpleNamespace(reason=SimpleNamespace(numerical=bad)) for bad in reasons]
        return SimpleNamespace(name=name, parameter=begin, stops=stops)


@pytest.mark.parametrize(
    ("near", "name"),
    [
        (("near", 0.5, ()), "near"),
        (("near", 0.5, (False,)), "near"),
        (("near", 0.5, (False, True)), "own"),
        (("near", 0.5 + 1e-9, ()), "own"),
        (ValueError("lost"), "own"),
    ],
    ids=["whole", "ended", "failed", "begun elsewhere", "none"],
)
def test_branch_from_a_neighbour(near: Any, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it is taken where it is whole and begins where the map's branches do."""
    monkeypatch.setattr(chunks, "start_of", lambda branch: branch)
    given: Any = Traced(near)
    branch, reason = chunks._attempted(given, {}, "orbit")  # type: ignore[arg-type]
    assert branch is not None and (branch.name, reason) == (name, "")  # type: ignore[attr-defined]
    assert given.asked == (["orbit"] if name == "near" else ["orbit", None])


def test_branch_without_a_neighbour() -> None:
    """Assert that it begins as the task does, and that what an engine raises is its reason."""
    given: Any = Traced(None)
    assert chunks._attempted(given, {}, None)[0].name == "own" and given.asked == [None]  # type: ignore[union-attr]

    def traced(values: Any, near: Any) -> Any:
        raise MemoryError("too large")

    given.traced = traced
    assert chunks._attempted(given, {}, None) == (None, "MemoryError: too large")
