"""Section of the report: what leaving parts of the disc's model out costs and saves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import periodic as per
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.pages.figures import panels
from reports.studies.paper.common.scenes import system
from reports.studies.trade.methods.measure import timed
from reports.studies.trade.words import seconds
from symbolic.scenes.axes import RPM

FULL = "vitrea79-810N"
MODELS = {
    FULL: "squeeze film (the full model)",
    "quasistatic-film-810N": "rigid film: it follows the load, no squeeze",
    "dry-810N": "no film, viscous damping",
}
COLOURS = {FULL: "black", "quasistatic-film-810N": "tab:blue", "dry-810N": "tab:red"}

SPEEDS = tuple(float(v) for v in range(110, 500, 10))
"""rev/min at which models are compared."""

ADMISSIBLE_ERROR = 0.05
"""Error in x up to which a smaller model will do."""


@dataclass(frozen=True, kw_only=True)
class Model:
    """A model: x p-p (m) of the largest stable orbit at each of SPEEDS, its folds (rev/min), states, time."""

    name: str
    swing: tuple[float, ...]
    folds: tuple[float, ...]
    size: int
    seconds: float
    iterations: int
    points: int

    def kept(self) -> dict[str, Any]:
        """Return what is kept of it."""
        return asdict(self)


@cache
def branch(name: str, *, compared: bool = True) -> per.Branch:
    """Return the branch of a model, with points at SPEEDS or without."""
    at = [rpm * RPM for rpm in SPEEDS] if compared else []
    return per.trace(system(name), "speed", (100 * RPM, 500 * RPM), start=500 * RPM, at=at)


def model(name: str) -> Model:
    """Trace a model; the time is that of the branch alone."""
    compared = branch(name)
    plain, spent = timed(lambda: branch.__wrapped__(name, compared=False))
    return Model(
        name=name,
        swing=tuple(swing(compared, rpm) for rpm in SPEEDS),
        folds=tuple(p.parameter / RPM for p in plain.labelled(per.Label.FOLD)),
        size=len(system(name).states) + len(system(name).algebraics),
        seconds=spent,
        iterations=plain.newton_iterations,
        points=len(plain),
    )


def swing(found: per.Branch, rpm: float) -> float:
    """Return x p-p (m) of the largest stable orbit at a speed; not a number where there is none."""
    here = [p for p in found.labelled(per.Label.USER) if abs(p.parameter / (rpm * RPM) - 1) < 1e-9]
    return max((p.peak_to_peak("x") for p in here if p.stable), default=float("nan"))


def compute(tell: Tell) -> Found:
    """Compare the models."""
    rows = []
    for name in MODELS:
        tell(name)
        rows.append(model(name))
    kept = [row.kept() for row in rows]
    return Found(numbers=key_numbers(rows), rows=kept, figures={"parts": picture(rows)})


def errors(rows: Sequence[Model], name: str) -> np.ndarray:
    """Return the relative error of x p-p at each speed."""
    full, own = (np.array(next(r.swing for r in rows if r.name == key)) for key in (FULL, name))
    return np.asarray(np.abs(own / full - 1))


def key_numbers(rows: Sequence[Model]) -> dict[str, float]:
    """Return the errors of the smaller models over ranges of speed."""
    speeds, numbers = np.array(SPEEDS), dict[str, float]()
    for row in rows:
        numbers |= {f"{row.name} fold {i + 1} rpm": fold for i, fold in enumerate(row.folds)}
        if row.name == FULL:
            continue
        wrong = errors(rows, row.name)
        for key, part in {
            "below": speeds <= 200,
            "around": (speeds > 200) & (speeds < 330),
            "above": speeds >= 330,
        }.items():
            numbers[f"{row.name} {key}"] = float(np.nanmax(wrong[part]))
        numbers[f"{row.name} wrong speeds"] = float(np.sum(~(wrong <= ADMISSIBLE_ERROR)))
    return numbers


def context(kept: Kept) -> Mapping[str, Any]:
    """Return what the template is given."""
    rows = read(kept)
    full, film, dry = rows
    each = [_each(row) for row in rows]
    shifts = [_shift(full, film), _shift(full, dry)]
    told = {"models": MODELS, "full": FULL, "speeds": SPEEDS, "enough": ADMISSIBLE_ERROR, "seconds": seconds}
    return told | {"film": film, "dry": dry, "each": each, "whole": full, "shifts": shifts}


def read(kept: Kept) -> list[Model]:
    """Return the models as they were kept."""
    return [Model(**row | {"swing": tuple(row["swing"]), "folds": tuple(row["folds"])}) for row in kept.rows]


def _each(row: Model) -> float:
    return row.seconds / row.iterations


def _shift(full: Model, other: Model) -> float:
    """How much further down another model's large sheet reaches, in rev/min."""
    return min(full.folds) - min(other.folds)


def picture(rows: Sequence[Model]) -> Figure:
    """Return x p-p over speed, and the errors under it."""
    figure, axes = panels(2, 2, width=9.0, height=2.6, gridspec_kw={"width_ratios": (3, 1)}, sharex="col")
    above, below = axes[:, 0]
    for row in rows:
        above.plot(SPEEDS, 1e6 * np.array(row.swing), ".-", color=COLOURS[row.name], label=MODELS[row.name])
        if row.name != FULL:
            below.semilogy(SPEEDS, errors(rows, row.name), ".-", color=COLOURS[row.name])
    below.axhline(ADMISSIBLE_ERROR, color="gray", linestyle=":")
    above.set_ylabel("x peak to peak (µm)")
    below.set_ylabel("relative error")
    below.set_xlabel("speed (rev/min)")
    above.legend()
    _bars(axes[0, 1], [row.seconds for row in rows], "time of the branch (s)")
    _bars(axes[1, 1], [1e3 * _each(row) for row in rows], "time per iteration (ms)")
    axes[1, 1].set_xticks(range(len(rows)), ["squeeze", "rigid", "dry"])
    return figure


def _bars(axes: Any, values: Sequence[float], label: str) -> None:
    axes.bar(range(len(values)), values, color=list(COLOURS.values()))
    axes.set_ylabel(label)


SECTION = Section(title="Parts left out", compute=compute, context=context)
