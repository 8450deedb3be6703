"""Ways beyond the begin of an excursion: sizes, sites and what keeps it, of words that are given."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import along

from periodic.events.rewrites import rewrite, table
from periodic.events.rewrites.rewrite import Begins
from periodic.events.sideconditions import Length, Speed
from periodic.orbit.mesh import Mesh


class Sited:
    """A site that tells where its excursion begins."""

    def __init__(self, name: str, row: table.Row) -> None:
        self.name, self.row, self.switch = name, row, 0

    def begin(self, orbit: Any, size: float) -> tuple[str, float]:
        """The first node."""
        return self.name, size


ROW = table.Row(name="row", grazes=False, power=1.0, sizes=(0.1, 0.01), spare=(0.001,))
LAST = table.Row(name="last", grazes=False, power=1.0, sizes=(0.1,), last=True)
ORBIT = along(lambda tau: np.sin(tau)[:, None])


@pytest.fixture
def words(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Sites that begin at once, which words are wrong or lack the first node, and which were asked for."""
    given: dict[str, Any] = {"sites": [], "wrong": set(), "lacks": set(), "asked": []}

    def rewritten(system: Any, orbit: Any, sites: Any, size: float) -> Any:
        key = (size, len(sites))
        given["asked"].append(key)
        return (key,), np.array([size])

    monkeypatch.setattr(rewrite, "at_once", lambda system, orbit, site: given["sites"])
    monkeypatch.setattr(rewrite, "rewritten", rewritten)
    monkeypatch.setattr(
        rewrite, "inconsistency", lambda system, events: "wrong" if events[0] in given["wrong"] else ""
    )
    monkeypatch.setattr(rewrite, "has", lambda events, phases, node, orbit: events[0] not in given["lacks"])
    monkeypatch.setattr(rewrite, "redistribute", lambda orbit, ntst, events, phases, shortest: ORBIT.mesh)
    monkeypatch.setattr(rewrite, "still", lambda system, modes, events: ((7, 1),))
    monkeypatch.setattr(rewrite, "index_of", lambda events, phases, node, orbit: 3)
    return given


def found(site: Sited) -> list[tuple[float, Any, bool]]:
    """Size, condition and whether it is spare, of each way."""
    own = Begins(None, site, 0.5, 0.1)  # type: ignore[arg-type]
    ways = list(own.beyond(None, ORBIT))  # type: ignore[arg-type]
    assert all(isinstance(way.mesh, Mesh) and way.mesh.modes == ((7, 1),) and not way.grazes for way in ways)
    return [(float(way.phases[0]), way.condition, way.spare) for way in ways]


def test_sizes_are_tried_in_order(words: dict[str, Any]) -> None:
    """Assert those of the row, then its spare ones, each kept by the length of the segment."""
    one = Sited("one", ROW)
    words["sites"] = [one]
    assert found(one) == [
        (0.1, Length(3, 0.1), False),
        (0.01, Length(3, 0.01), False),
        (0.001, Length(3, 0.001), True),
    ]
    assert words["asked"] == [(0.1, 1), (0.01, 1), (0.001, 1)]


def test_sites_by_symmetry_are_tried_together_first(words: dict[str, Any]) -> None:
    """Assert both, then the first alone, for each size."""
    one = Sited("one", ROW)
    words["sites"] = [one, Sited("other", ROW)]
    assert len(found(one)) == 6
    assert words["asked"] == [(size, count) for size in (0.1, 0.01, 0.001) for count in (2, 1)]


def test_words_that_are_none_are_left_out(words: dict[str, Any]) -> None:
    """Assert that the next one is tried after one that is no sequence, or has lost the first node."""
    one = Sited("one", ROW)
    words["sites"] = [one, Sited("other", ROW)]
    words["wrong"], words["lacks"] = {(0.1, 2), (0.01, 1)}, {(0.01, 2)}
    assert [size for size, *_ in found(one)] == [0.1, 0.001, 0.001]


def test_last_of_a_branch_has_nothing_beyond(words: dict[str, Any]) -> None:
    """Assert no way, nor where the site is no longer there."""
    words["sites"] = [Sited("one", LAST)]
    assert found(words["sites"][0]) == []
    words["sites"] = []
    assert found(Sited("one", ROW)) == []


def test_impacts_are_kept_by_their_speed(words: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the size as a part of the largest value of the switch."""
    knots = np.zeros((2, 3, 1))
    knots[1, 2, 0] = -4.0
    monkeypatch.setattr(rewrite, "SwitchPolynomials", lambda system, orbit: SimpleNamespace(knots=knots))
    impact = Sited("one", table.IMPACT)
    words["sites"] = [impact]
    each = found(impact)
    assert [condition for _, condition, _ in each] == [Speed(3, 4.0 * size) for size, *_ in each] and each
