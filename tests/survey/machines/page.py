"""The page of the survey of machines."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from support.drawn.machines.drawn import FAMILIES

from survey.machines.rows import JUDGED, OTHERS, SECONDS, SEEDS, TOL, models, parts
from survey.page import FATES, _engines, _told
from survey.rows import Row

NEARLY = 0.9
"""Part of the seconds allowed that a trace has taken at least when it is cut short."""

INTRODUCTION = """# Machines drawn at random

{count} of {all} traces: {seeds} machines of each of {families} families, drawn from what catalogues and
books hold, in real units (`tests/support/drawn/machines`; a seed is a machine), each through its whole
range of speeds from both ends, at tol {tol:g}, a tenth of them at {others} too, in at most {seconds:g} s of
CPU. Up to {judged} points of each, drawn at random, are judged by DOP853 and accelerations written out by
hand (`tests/survey/machines/judge.py`): an orbit is wrong where it is off by more than ten times what it
claims, and more than 1e-5 of its peaks to peak; multipliers, which differences know to three digits, where
they are off by more than 1e-3 and ten times what they claim; and a stability that is not so. What seems
wrong is looked at again, with more steps and with smaller differences, as beside a grazing; 1e-10 of a
state, which is more than some preloaded bearings move, is the integration's own. An end is that of the
range, or where the response grows without bound. Shafts, friction dampers and beams are traced and not
judged here: the [random contacts](../README.md) judge such.
`make survey-machines` runs them.

Engine at {engines}.
"""


def page(rows: Sequence[Row]) -> str:
    """Return the page in Markdown."""
    begun = INTRODUCTION.format(
        count=len(rows),
        all=len(list(models())),
        others=" and ".join(end.removeprefix(" at ") for end in OTHERS),
        seeds=SEEDS,
        families=len(FAMILIES),
        tol=TOL,
        seconds=SECONDS,
        judged=JUDGED,
        engines=_engines(rows),
    )
    parts = [begun, _summary(rows), _table(rows)]
    parts += [_told("Wrong", ((row, said) for row in rows for said in row.wrong))]
    parts += [_told("Left open by the ledger", ((row, said) for row in rows for said in row.gaps))]
    parts += [_told("Not judged", ((row, said) for row in rows for said in row.unjudged))]
    ended = [row for row in rows if row.fate != FATES[0]]
    parts += [
        _told(
            "Not traced to the end", ((r, f"{r.told} ({r.points} points, {r.seconds:.0f} s)") for r in ended)
        )
    ]
    parts += [_told("Claimed less well than asked", ((r, r.shortfall) for r in rows if r.shortfall))]
    return "\n".join(parts)


def _summary(rows: Sequence[Row]) -> str:
    judged, wrong = sum(row.judged for row in rows), sum(len(row.wrong) for row in rows)
    ends = sum(row.fate == FATES[0] for row in rows)
    less = sum(row.reason == "INTERRUPTED" and row.seconds < NEARLY * SECONDS for row in rows)
    more = f"{less} that ran out of time were allowed less than those traced today.\n" if less else ""
    return (
        f"**{ends} of {len(rows)} ({100 * ends / max(len(rows), 1):.1f} %) are traced to the end; "
        f"{wrong or 'none'} of the {judged} points judged {'are' if wrong > 1 else 'is'} wrong.**\n{more}"
    )


def _table(rows: Sequence[Row]) -> str:
    heads = ["family", "traces", "to the end", "limit of work", "other", "points", "CPU s", "GB"]
    heads += ["judged", "wrong", "worst error / claim"]
    lines = [f"| {' | '.join(heads)} |", "|" + "---|" * len(heads)]
    usual = [row for row in rows if parts(row.kind)[2] == TOL]
    families = [(name, [row for row in usual if parts(row.kind)[0] == name]) for name in FAMILIES]
    each = [(name, own) for name, own in families if own]
    each += [(f"all{end}", [row for row in rows if parts(row.kind)[2] == tol]) for end, tol in OTHERS.items()]
    for name, own in [*((name, own) for name, own in each if own), ("**all**", list(rows))]:
        fates = [row.fate for row in own]
        cells: list[object] = [name, len(own), fates.count("to the end"), fates.count("limit of work")]
        cells += [fates.count("other") + fates.count("friction holds")]
        cells += [f"{median(r.points for r in own):.0f}", f"{median(r.seconds for r in own):.1f}"]
        known = [row.memory for row in own if row.memory]
        cells.append(f"{median(known):.2f}" if known else "")
        cells += [sum(r.judged for r in own), sum(len(r.wrong) for r in own)]
        cells.append(f"{max((r.ratio for r in own), default=0.0):.2g}")
        lines.append(f"| {' | '.join(map(str, cells))} |")
    return "\n".join(
        [
            *lines,
            "",
            "Points, CPU seconds and memory (the whole process, of rows since it is measured) are medians.",
            "",
        ]
    )
