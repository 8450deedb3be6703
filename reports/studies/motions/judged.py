"""Random oscillators: what is found beside what a judge of its own finds from very many starts."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from reports.studies.motions.judge import STEPS, Oscillator, found, missed
from reports.studies.pages.content import Found, Kept, Section, Tell

OSCILLATORS, STARTS = range(50), 100_000
"""Seeds of the oscillators, and starts of the judge for each."""

FINER = 6
"""How many times as many steps the judge takes on a second look: at a kink its method is of low order."""

LEAST = 0.005
"""Share of the box from which an attractor must not be missed."""


def judged(tell: Tell) -> Found:
    """Compute what is found of each oscillator, and what the judge finds."""
    rows: list[dict[str, Any]] = []
    for seed in OSCILLATORS:
        tell(f"oscillator {seed}")
        oscillator, begun = Oscillator(seed), time.perf_counter()
        motions = found(oscillator)
        seconds = time.perf_counter() - begun
        attractors = oscillator.judged(STARTS)
        first = missed(oscillator, motions, attractors)
        if first:
            attractors = oscillator.judged(STARTS, FINER * STEPS)
        rows.append(
            {
                "seed": seed,
                "stable": [[motion.periods, motion.share] for motion in motions.stable],
                "unstable": len(motions.unstable),
                "undecided": motions.undecided,
                "seconds": seconds,
                "first": len(first),
                "judge": [[each.periods, each.share] for each in attractors],
                "missed": [[each.periods, each.share] for each in missed(oscillator, motions, attractors)],
            }
        )
    numbers = {
        "oscillators": len(rows),
        "attractors": sum(sum(share > LEAST for _, share in row["judge"]) for row in rows),
        "missed": sum(sum(share > LEAST for _, share in row["missed"]) for row in rows),
        "missed_smaller": sum(sum(share <= LEAST for _, share in row["missed"]) for row in rows),
        "most_seconds": max(row["seconds"] for row in rows),
        "median_seconds": sorted(row["seconds"] for row in rows)[len(rows) // 2],
    }
    return Found(numbers=numbers, rows=rows)


def _context(kept: Kept) -> Mapping[str, Any]:
    several = [row for row in kept.rows if len(row["judge"]) > 1 or row["missed"]]
    return {
        "starts": STARTS,
        "again": [row["seed"] for row in kept.rows if row["first"]],
        "finer": FINER,
        "table": [
            [
                row["seed"],
                _listed(row["stable"]),
                _listed(row["judge"]),
                _listed(row["missed"]) or "nothing",
                row["unstable"],
                f"{row['seconds']:.1f}",
            ]
            for row in several
        ],
    }


def _listed(each: list[list[float]]) -> str:
    """Attractors by their periods and shares."""
    return ", ".join(f"{_name(int(periods))} {100 * share:.1f}" for periods, share in each)


def _name(periods: int) -> str:
    return f"p{periods}" if periods else "aperiodic"


JUDGED = Section(title="Beside a judge of its own", compute=judged, context=_context)
