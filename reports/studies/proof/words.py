"""Cycles of Lorenz' equations by their words: which lobe they go round, turn by turn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.proof.cycles import Cycle, lorenz
from reports.studies.proof.proving import row

HEIGHT = 27.0
"""Of the section z = rho - 1, which a motion passes once a turn, upward."""

LONG = 4000.0
"""Time of the motion that cycles are looked for on."""


LEFT = 0.1
"""Time after which a motion has left the section."""

STEP = 1e-6
"""Of difference quotients."""

CLOSED, ITERATIONS = 1e-8, 20
"""Last change of Newton's method, and iterations at the most."""


FAR = 30.0
"""Change at which it has lost its way: as far as the attractor reaches."""


def rising(_: float, y: np.ndarray) -> float:
    """What vanishes at the section."""
    return float(y[2] - HEIGHT)


def returns(_: float, y: np.ndarray) -> float:
    """The same, for a motion that ends there."""
    return float(y[2] - HEIGHT)


rising.direction = returns.direction = 1.0  # type: ignore[attr-defined]
returns.terminal = True  # type: ignore[attr-defined]


def turns() -> np.ndarray:
    """Return where a long motion passes the section."""
    begin = solve_ivp(lorenz, (0, 50), [1.0, 1.0, 20.0], rtol=1e-9, atol=1e-9).y[:, -1]
    found = solve_ivp(lorenz, (0, LONG), begin, method="DOP853", rtol=1e-9, atol=1e-9, events=rising)
    return np.array(found.y_events)[0]


def words(longest: int) -> Iterator[tuple[int, ...]]:
    """Yield words of both lobes, by length: one of each cycle and its mirror image, none a repetition."""
    seen: set[tuple[int, ...]] = set()
    for length in range(2, longest + 1):
        for word in product((-1, 1), repeat=length):
            ways = [word[k:] + word[:k] for k in range(length)]
            alike = {*ways, *(tuple(-a for a in way) for way in ways)}
            if len({*word}) == 2 and len({*ways}) == length and not alike & seen:
                seen.add(word)
                yield word


def near(word: tuple[int, ...], states: np.ndarray) -> np.ndarray:
    """Return where a long motion turns as a word begins and has turned as it ends, for as long as it does."""
    side, length = np.sign(states[:, 0]).astype(int), len(word)
    most = 3 * length
    cyclic = np.array([word[(k - length) % length] for k in range(most)])
    count = len(side) - most
    alike = np.array([side[k : k + count] == cyclic[k] for k in range(most)])
    after = np.cumprod(alike[length:], axis=0).sum(axis=0)
    before = np.cumprod(alike[:length][::-1], axis=0).sum(axis=0)
    return states[int((after + np.minimum(before, after)).argmax()) + length, :2]


def turned(place: np.ndarray) -> np.ndarray:
    """Return where a motion from a place (x, y) of the section is after a turn, and how long it takes."""
    begin = solve_ivp(lorenz, (0, LEFT), [*place, HEIGHT], method="DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    found = solve_ivp(lorenz, (0, 5), begin, method="DOP853", rtol=1e-11, atol=1e-12, events=returns)
    return np.array([*np.array(found.y_events)[0][0][:2], np.array(found.t_events)[0][0] + LEFT])


def closed(word: tuple[int, ...], states: np.ndarray) -> tuple[tuple[float, ...], float] | None:
    """Return a cycle by Newton's method on its turns, a state and the period; None without one."""
    length = len(word)
    places = np.array([near(word[k:] + word[:k], states) for k in range(length)])
    for _ in range(ITERATIONS):
        ends = np.array([turned(place) for place in places])
        matrix = np.zeros((2 * length, 2 * length))
        for k, place in enumerate(places):
            after = (k + 1) % length
            matrix[2 * k : 2 * k + 2, 2 * after : 2 * after + 2] -= np.eye(2)
            for j in range(2):
                moved = turned(place + STEP * np.eye(2)[j])
                matrix[2 * k : 2 * k + 2, 2 * k + j] += (moved - ends[k])[:2] / STEP
        change = np.linalg.solve(matrix, -(ends[:, :2] - np.roll(places, -1, axis=0)).ravel())
        if not np.abs(change).max() < FAR:
            return None
        places = places + change.reshape(length, 2)
        if np.abs(change).max() < CLOSED:
            same = (np.sign(places[:, 0]) == word).all()
            return ((*map(float, places[0]), HEIGHT), float(ends[:, 2].sum())) if same else None
    return None


@dataclass(frozen=True, kw_only=True)
class Words:
    """Cycles of all words up to a length, the shortest first."""

    key: str
    cycle: Cycle
    longest: int

    @cached_property
    def section(self) -> Section:
        """The section of the page."""
        return Section(
            title=f"Lorenz' equations: all cycles of at most {self.longest} turns",
            compute=self._compute,
            context=self._context,
            template="words.md.j2",
        )

    def _compute(self, tell: Tell) -> Found:
        states = turns()
        rows: list[dict[str, Any]] = []
        for word in words(self.longest):
            text = "".join("L" if side < 0 else "R" for side in word)
            tell(text)
            cycle = closed(word, states)
            if cycle is None:
                rows.append({"word": text, "proven": False, "says": "no cycle was found by shooting"})
                continue
            system = sym.compile(self.cycle.equations)
            rows.append({**row(system, self.cycle.traced(system, *cycle), None), "word": text})
        return Found(numbers={"proven": sum(each["proven"] for each in rows)}, rows=rows)

    def _context(self, kept: Kept) -> Mapping[str, Any]:
        proven = [each for each in kept.rows if each["proven"]]
        lengths = sorted({len(each["word"]) for each in kept.rows})
        every = [[each for each in kept.rows if len(each["word"]) == length] for length in lengths]
        return {
            "count": len(proven),
            "asked": len(kept.rows),
            "left": [(each["word"], each["says"]) for each in kept.rows if not each["proven"]],
            "table": [_shown(some) for some in every],
        }


def _shown(some: Sequence[Mapping[str, Any]]) -> list[str]:
    proven = [each for each in some if each["proven"]]
    if not proven:
        return [str(len(some[0]["word"])), str(len(some)), "0", "", "", "", "", ""]
    return [
        str(len(some[0]["word"])),
        str(len(some)),
        str(len(proven)),
        str(sum(each["accepted"] for each in proven)),
        f"{max(each['largest'] for each in proven):.3g}",
        f"{max(each['radius'] for each in proven):.0e}",
        f"{max(each['distance'] / each['estimate'] for each in proven):.2g}",
        f"{np.median([each['seconds'] for each in proven]):.1f}",
    ]
