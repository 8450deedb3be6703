"""The page of the survey."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from support.drawn.jointcases import DOWN, UP

from survey.rows import FEW, JUDGED, MANY, SEEDS, TOL, Row

FATES = ("to the end", "limit of work", "friction holds", "other")

NEARLY = 0.9
"""Part of its time at which a trace may be interrupted, as what it does then is finished first."""

INTRODUCTION = """# Models with contact drawn at random

{count} of {all} models: one to three masses with one to five clearances of stiffness 1 to 1e5, gears
with backlash under load, masses that strike a rigid stop, dry friction beside clearances, chains of 2
to 10 masses, each before a stop, and contacts whose force jumps, damped or preloaded
(`tests/support/drawn/contact.py`; a seed is a model); and two to six masses or a beam with two to eight
joints, dry friction, exact sliders, stops, some with cubic springs, each from both ends of its range
(`tests/support/drawn/joints.py`). Each is traced through a resonance at tol {tol:g}, at most {points}
points, {newton} Newton iterations and {seconds:g} s of CPU; those with several joints at most
{many_points}, {many_newton} and {many_seconds:g} s, limits of work and none of accuracy. Up to
{judged} points of each, drawn at random, are judged: orbit and multipliers by an event-exact solution in
closed form or by Taylor's series, that shares nothing with the packages (`tests/reference/contact.py` with
`closer.py` in extended precision, `tests/reference/joints`). A point is wrong where an error is more
than ten times what the point claims and more than 1e-5, or where its stability is not so. At every
point the modes of all joints are looked at on samples as well (`tests/survey/sampled.py`). `make survey`
runs them, in the time of the last column.

Engine at {engines}.
"""


def page(rows: Sequence[Row]) -> str:
    """Return the page in Markdown."""
    begun = INTRODUCTION.format(
        count=len(rows),
        all=sum(SEEDS.values()),
        engines=_engines(rows),
        tol=TOL,
        points=FEW.points,
        newton=FEW.newton,
        seconds=FEW.seconds,
        many_points=MANY.points,
        many_newton=MANY.newton,
        many_seconds=MANY.seconds,
        judged=JUDGED,
    )
    parts = [begun, _summary(rows), _table(rows)]
    parts += [_told("Wrong", ((row, said) for row in rows for said in row.wrong))]
    parts += [_told("Outside their words on samples", ((row, said) for row in rows for said in row.strays))]
    parts += [_told("Left open by the ledger", ((row, said) for row in rows for said in row.gaps))]
    parts += [_told("Not judged", ((row, said) for row in rows for said in row.unjudged))]
    parts += [_told("Not traced to the end", ((r, _ended(r)) for r in rows if r.fate != FATES[0]))]
    parts += [_told("Claimed less well than asked", ((r, r.shortfall) for r in rows if r.shortfall))]
    return "\n".join(parts)


def _engines(rows: Sequence[Row]) -> str:
    """The commits whose engines have traced them, with how many each has where there are several."""
    count = Counter(row.engine for row in rows)
    names = {engine: f"commit `{engine}`" if engine else "commits not recorded" for engine in count}
    if len(names) == 1:
        return next(iter(names.values()))
    return ", ".join(f"{names[engine]} ({number} models)" for engine, number in count.most_common())


def _summary(rows: Sequence[Row]) -> str:
    judged, wrong = sum(row.judged for row in rows), sum(len(row.wrong) for row in rows)
    worst = max((row.ratio for row in rows), default=0.0)
    ends = sum(row.fate == FATES[0] for row in rows)
    return (
        f"**{ends} of {len(rows)} are traced to the end; {wrong or 'none'} of the {judged} points judged "
        f"{'are' if wrong > 1 else 'is'} wrong.** The largest error is {worst:.2g} times what is claimed."
        f"{_both(rows)}{_earlier(rows)}\n"
    )


def _both(rows: Sequence[Row]) -> str:
    """How many models with several joints are traced to their ends from both."""
    fates = {(row.kind, row.seed): row.fate == FATES[0] for row in rows if row.kind in (UP, DOWN)}
    seeds = [seed for kind, seed in fates if kind == UP and (DOWN, seed) in fates]
    both = sum(fates[UP, seed] and fates[DOWN, seed] for seed in seeds)
    traced = f"Of {len(seeds)} models with several joints traced from both ends"
    return f" **{traced} {both} are so from both.**" if seeds else ""


def _earlier(rows: Sequence[Row]) -> str:
    """How many ended at limits of work that were narrower when they were traced."""
    several = [row for row in rows if row.kind in (UP, DOWN)]
    fewer = sum(
        (row.reason == "INTERRUPTED" and row.seconds < NEARLY * MANY.seconds)
        or (row.reason == "MAX_NEWTON" and row.newton < MANY.newton)
        or (row.reason == "MAX_POINTS" and row.points < MANY.points)
        for row in several
    )
    return (
        f" {fewer} that ended at a limit of work were allowed less than those traced today." if fewer else ""
    )


def _table(rows: Sequence[Row]) -> str:
    heads = ["family", "models", *FATES, "points", "judged", "wrong", "ledger open", "worst error / claim"]
    heads.append("CPU s")
    lines = [f"| {' | '.join(heads)} |", "|" + "---|" * len(heads)]
    kinds = [(kind, [row for row in rows if row.kind == kind]) for kind in SEEDS]
    for name, own in [*((kind, own) for kind, own in kinds if own), ("**all**", list(rows))]:
        cells: list[object] = [name, len(own), *(sum(r.fate == fate for r in own) for fate in FATES)]
        cells += [sum(r.points for r in own), sum(r.judged for r in own), sum(len(r.wrong) for r in own)]
        cells += [sum(len(r.gaps) for r in own), f"{max((r.ratio for r in own), default=0.0):.2g}"]
        cells.append(f"{sum(r.seconds for r in own):.0f}")
        lines.append(f"| {' | '.join(map(str, cells))} |")
    return "\n".join([*lines, ""])


def _ended(row: Row) -> str:
    return f"{row.told} ({row.points} points, {row.seconds:.0f} s)"


def _told(head: str, found: Iterable[tuple[Row, str]]) -> str:
    listed = [f"| {row.kind} {row.seed} | {said.replace('|', '/')} |" for row, said in found]
    if not listed:
        return f"## {head}\n\nNone.\n"
    return "\n".join([f"## {head}\n", "| model | |", "|---|---|", *listed, ""])
