"""How often intervals of fits hold the truth, over many made-up sets of data."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.stats import binomtest

import periodic as per
from reports.studies.decide.truths import TRUTHS, Truth
from reports.studies.pages.content import Found, Kept, Section, Tell

SETS = 200
"""Sets of data for the smooth machine; those with events, whose fits take longer, have 30."""

NOISE = 0.01
"""Relative standard deviation of amplitudes."""

CHUNK = 10
"""Sets that a process does at a time."""


def fitted(key: str, seed: int) -> dict[str, Any]:
    """Return what a fit to one set of data comes to, from a start that is some per cent off."""
    truth = next(each for each in TRUTHS if each.key == key)
    rng = np.random.default_rng(seed)
    data = truth.measured(NOISE, rng)
    begin = {name: value * (1 + 0.05 * rng.standard_normal()) for name, value in truth.hidden.items()}
    clock = time.process_time()
    try:
        found = per.fit(truth.system, data, truth.free, start=begin)
    except ValueError as error:
        return {"seed": seed, "reason": str(error), "seconds": time.process_time() - clock}
    row: dict[str, Any] = {"seed": seed, "reason": found.reason, "seconds": time.process_time() - clock}
    for name, value in truth.hidden.items():
        low, high = found.interval(name)
        row[name] = (found[name] - value) / found.errors[name]
        row[f"{name} held"] = bool(low <= value <= high)
    return row


def several(key: str, seeds: list[int]) -> list[dict[str, Any]]:
    """Return the rows of several sets."""
    return [fitted(key, seed) for seed in seeds]


@dataclass(frozen=True, kw_only=True)
class Coverage:
    """Fits to sets of data of one machine."""

    truth: Truth
    sets: int = SETS

    @property
    def key(self) -> str:
        """The section's name."""
        return self.truth.key

    @cached_property
    def section(self) -> Section:
        """The section of the page."""
        return Section(
            title=f"Intervals of fits: {self.truth.scene}",
            compute=self._compute,
            context=self._context,
            template="coverage.md.j2",
        )

    def _compute(self, tell: Tell) -> Found:
        chunks = [list(range(k, min(k + CHUNK, self.sets))) for k in range(0, self.sets, CHUNK)]
        rows: list[dict[str, Any]] = []
        with ProcessPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
            for found in pool.map(several, [self.key] * len(chunks), chunks):
                rows += found
                tell(f"{self.truth.scene}: {len(rows)} of {self.sets} sets")
        names = list(self.truth.hidden)
        done = [row for row in rows if not row["reason"]]
        numbers = {f"{name}_held": sum(row[f"{name} held"] for row in done) / len(done) for name in names}
        return Found(numbers={"fits": float(len(done)), **numbers}, rows=rows)

    def _context(self, kept: Kept) -> Mapping[str, Any]:
        done = [row for row in kept.rows if not row["reason"]]
        table = []
        for name, value in self.truth.hidden.items():
            held = sum(row[f"{name} held"] for row in done)
            ends = binomtest(held, len(done)).proportion_ci(0.95, method="wilson")
            scores = np.array([row[name] for row in done])
            table.append(
                [
                    f"`{name}`",
                    f"{value:g}",
                    f"{held / len(done):.1%}",
                    f"{ends.low:.1%} to {ends.high:.1%}",
                    f"{scores.mean():+.2f}",
                    f"{scores.std():.2f}",
                ]
            )
        seconds = sorted(row["seconds"] for row in kept.rows)
        return {
            "table": table,
            "done": len(done),
            "asked": len(kept.rows),
            "failed": [(row["seed"], row["reason"]) for row in kept.rows if row["reason"]],
            "median": seconds[len(seconds) // 2],
            "slowest": seconds[-1],
            "numbers": len(self.truth.rising) + len(self.truth.falling),
            "jump": self.truth.jump is not None,
        }


COVERAGE = tuple(Coverage(truth=truth, sets=sets) for truth, sets in zip(TRUTHS, (SETS, 30, 30), strict=True))
"""In the order of the page."""
