"""The page of a sample of mutants: how many of each room are noticed, and each with the test."""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from trial import LATE, Outcome

JUDGED = Path(__file__).with_name("judged.toml")
NOTICED, SURVIVED, SAME = "noticed", "survived", "changes no result"


def reasons(kind: str = "mutant") -> dict[tuple[str, str, str], str]:
    """Return why a mutant changes no result, by its file and what the line was and is.

    Of the kind "written" those whose test was written because they were drawn.
    """
    listed = tomllib.loads(JUDGED.read_text("utf-8"))[kind]
    return {(entry["path"], entry["before"], entry["after"]): entry.get("why", "") for entry in listed}


def fate(outcome: Outcome) -> str:
    """Return what has become of a mutant; one that the tests ran out of time for has survived."""
    if outcome.test not in ("", LATE):
        return NOTICED
    return SAME if (outcome.path, outcome.before, outcome.after) in reasons() else SURVIVED


def said(outcome: Outcome) -> str:
    """Return a mutant in two lines of text."""
    told = outcome.test if fate(outcome) == NOTICED else f"{fate(outcome).upper()} {outcome.test}".strip()
    place = f"{outcome.path}:{outcome.line}  {outcome.before}\n        -> {outcome.after}"
    return f"{place}\n        {told}  ({outcome.seconds:.0f} s, {outcome.asked} tests execute it)"


def page(outcomes: Sequence[Outcome], seed: int, commit: str, limit: float) -> tuple[str, bool]:
    """Return the page in Markdown, and whether every mutant that changes a result is noticed."""
    fates = Counter(map(fate, outcomes))
    changing = fates[NOTICED] + fates[SURVIVED]
    own = reasons("written")
    found = sum(fate(o) == NOTICED and (o.path, o.before, o.after) not in own for o in outcomes)
    lines = [
        "# Mutants: tests that would notice",
        "",
        f"{len(outcomes)} small changes of `symbolic/` and `periodic/`, drawn at random (seed {seed}) from",
        f"commit `{commit}`, each held against the tests that execute the changed line, for",
        f"about {limit:.0f} s of the processor at the most (`make mutants`).",
        f"{fates[SAME]} change no result. **Of the {changing} others {found} were noticed as they were",
        f"drawn ({found / max(changing, 1):.0%}), {fates[NOTICED]} with tests written for the others**;",
        "how many of other mutants are noticed is for another seed to tell (`make mutants SEED=1`,",
        "with `LIMIT=25` in so many seconds for each).",
        "",
        "| room | drawn | change no result | noticed | not noticed |",
        "|---|---|---|---|---|",
        *_rooms(outcomes),
        *_listed("Not noticed", [o for o in outcomes if fate(o) == SURVIVED]),
        *_listed("Change no result", [o for o in outcomes if fate(o) == SAME]),
        *_listed("Noticed", [o for o in outcomes if fate(o) == NOTICED]),
    ]
    return "\n".join(lines) + "\n", not fates[SURVIVED]


def _rooms(outcomes: Sequence[Outcome]) -> list[str]:
    rooms = Counter(("/".join(Path(o.path).parts[:2]), fate(o)) for o in outcomes)
    names = sorted({room for room, _ in rooms})
    counts = [[rooms[name, kind] for kind in (SAME, NOTICED, SURVIVED)] for name in names]
    rows = [
        *zip(names, counts, strict=True),
        ("**all**", [sum(column) for column in zip(*counts, strict=True)]),
    ]
    return [f"| {name} | {sum(count)} | {' | '.join(map(str, count))} |" for name, count in rows]


def _listed(title: str, outcomes: Sequence[Outcome]) -> list[str]:
    if not outcomes:
        return []
    why, written, rows = reasons(), reasons("written"), []
    for o in outcomes:
        place = (o.path, o.before, o.after)
        told = why.get(place) or f"{_code(o.test)} ({o.seconds:.0f} s)"
        told += ", written for it" if place in written else ""
        rows.append(f"| {o.path}:{o.line} | {_code(o.before)} | {_code(o.after)} | {told} |")
    return ["", f"## {title}", "", "| place | line | instead | |", "|---|---|---|---|", *rows]


def _code(text: str) -> str:
    return f"`` {text.replace('|', chr(92) + '|')} ``" if text else ""
