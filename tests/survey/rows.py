"""What becomes of a model: how far its branch is traced, and whether what it claims is so."""

from __future__ import annotations

import json
import time
import warnings
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from reference.joints.judging import judged as judged_joints
from reference.judging import Verdict, judged
from support.drawn import contact
from support.drawn.contact import Case
from support.drawn.jointcases import DOWN, UP, JointCase, drawn_joints

import periodic as per
from reports.studies.extremes.survey import within
from reports.studies.pages.engine import current
from survey.sampled import strays

TOL = 1e-6


@dataclass(frozen=True)
class Limits:
    """Points, Newton iterations and CPU seconds that a branch may take."""

    points: int
    newton: int
    seconds: float

    @property
    def control(self) -> per.ArclengthControl:
        """As the trace takes them."""
        return per.ArclengthControl(max_points=self.points, max_newton=self.newton)


FEW = Limits(400, 4000, 40.0)

MANY = Limits(20000, 400000, 3600.0)
"""Of models with several joints: a period has tens of events, and each two that change places are a point."""

JUDGED = 8
"""Points of a branch that are judged, drawn at random."""

SEEDS = {
    "clearances": 200,
    "gears": 100,
    "impacts": 100,
    "friction": 100,
    "chains": 100,
    "jumps": 100,
    UP: 100,
    DOWN: 100,
}
"""How many models of a kind, from seed 100 on; those with several joints are traced from either end."""

BACK = "turned back"
"""What a branch says that came back to the end of the range where it began."""

APART = 1e-3
"""By which part peaks to peak of states differ at least, where it came back at another orbit, past folds."""

PHYSICAL = ("BOUND", "UNBOUNDED", "VANISHED")
"""Ends that are the range's, or the machine's: there is no motion of the kind beyond."""

HELD = "holds all along"
"""What a branch says where friction holds the motion for good: it is at rest, anywhere."""


@dataclass(frozen=True)
class Row:
    """A model. `wrong` lists what its branch claims that is not so, `gaps` what its ledger leaves open.

    retraced: whether one that came back did so at the orbit where it began, as far as peaks to peak say.
    shortfall: its points whose estimates exceed the tolerance, as the branch says. unjudged: points that
    the reference does not follow. strays: points, of all, that do not keep their words on samples.
    ratio: the largest error over what is claimed, at least the tolerance. engine: the last commit that
    changed the engine that traced it, with a + where there were changes besides. memory: the most that its
    process had, in GB, where it had one of its own.
    """

    kind: str
    seed: int
    reason: str
    told: str
    points: int = 0
    newton: int = 0
    seconds: float = 0.0
    shortfall: str = ""
    judged: int = 0
    ratio: float = 0.0
    wrong: tuple[str, ...] = ()
    gaps: tuple[str, ...] = ()
    unjudged: tuple[str, ...] = ()
    engine: str = ""
    retraced: bool = True
    strays: tuple[str, ...] = ()
    memory: float = 0.0

    @property
    def fate(self) -> str:
        """The column of the page that it is counted in."""
        if self.reason in PHYSICAL and not (BACK in self.told and self.retraced):
            return "to the end"
        if HELD in self.told:
            return "friction holds"
        return "limit of work" if self.reason in ("MAX_POINTS", "MAX_NEWTON", "INTERRUPTED") else "other"


def models() -> Iterator[tuple[str, int]]:
    """Yield kind and seed of all, the kinds in turn, so that a part of them is a sample."""
    for k in range(max(SEEDS.values())):
        yield from ((kind, 100 + k) for kind, count in SEEDS.items() if k < count)


def drawn(kind: str, seed: int) -> Case | JointCase:
    """Return the case of a seed."""
    return drawn_joints(kind, seed) if kind in (UP, DOWN) else contact.drawn(kind, seed)


def traced(case: Case | JointCase) -> per.Branch:
    """Return the branch of a model."""
    control = limits(case).control
    return per.trace(case.system, "Omega", case.bounds, start=case.start, tol=TOL, control=control)


def limits(case: Case | JointCase) -> Limits:
    """Return how much work the branch of a model may be."""
    return FEW if isinstance(case, Case) else MANY


def _as_far(case: Case | JointCase) -> per.Branch:
    """Return the same, or what there is of it where its time is up."""
    try:
        return traced(case)
    except per.Interrupted as interrupted:
        return interrupted.branch


@cache
def engine() -> str:
    """Return the commit of the engine as it was first asked for: what this process has imported."""
    found = current()
    return found.commit + "+" * found.changed


def row(kind: str, seed: int, count: int = JUDGED) -> Row:
    """Trace a model and judge as many points. Any warning or exception is recorded as wrong."""
    return replace(_row(kind, seed, count), engine=engine())


def _row(kind: str, seed: int, count: int) -> Row:
    begun, most = time.process_time(), FEW.seconds
    try:
        case = drawn(kind, seed)
        most = limits(case).seconds
        with warnings.catch_warnings(), within(most):
            warnings.simplefilter("error")
            branch = _as_far(case)
    except KeyboardInterrupt:
        return Row(kind, seed, "INTERRUPTED", "time is up before there is a branch", seconds=most)
    except Exception as error:
        return Row(kind, seed, "RAISED", str(error), wrong=(f"{type(error).__name__}: {error}",))
    seconds = time.process_time() - begun
    verdict = verdicts(case, branch, seed, count)
    return Row(
        kind,
        seed,
        branch.stop.reason.name,
        str(branch.stop),
        len(branch),
        branch.newton_iterations,
        round(seconds, 2),
        branch.shortfall,
        verdict.judged,
        verdict.ratio,
        tuple(verdict.wrong),
        tuple(map(str, branch.unaccounted)),
        tuple(verdict.unjudged),
        retraced=_retraced(branch, [output.name for output in case.system.outputs]),
        strays=tuple(strays(case.system, branch)),
    )


def _retraced(branch: per.Branch, outputs: list[str]) -> bool:
    """Whether a branch ends at an orbit with the peaks to peak of the one where it began."""
    if not len(branch):
        return True
    first, last = ([branch[k].peak_to_peak(name) for name in outputs] for k in (0, -1))
    return all(abs(b - a) <= APART * max(a, b) for a, b in zip(first, last, strict=True))


@dataclass
class Verdicts:
    """What came of the points judged."""

    judged: int
    ratio: float
    wrong: list[str]
    unjudged: list[str]


def verdicts(case: Case | JointCase, branch: per.Branch, seed: int, count: int = JUDGED) -> Verdicts:
    """Judge points of a branch in closed form; at grazing itself multipliers have two values."""
    grazings = {point.parameter for point in branch.labelled(per.Label.GRAZING)}
    points = [point for point in branch if point.parameter not in grazings]
    found = Verdicts(0, 0.0, [], [])
    for k in np.random.default_rng(seed).permutation(len(points))[:count]:
        point = points[int(k)]
        place = f"Omega {point.parameter!r} {point.label.value}".strip()
        try:
            verdict = _verdict(case, point)
        except ArithmeticError as error:
            found.unjudged.append(f"{place}: {error}")
            continue
        claims = max(TOL, point.error.orbit), max(TOL, point.error.multiplier)
        found.judged += 1
        found.ratio = max(found.ratio, verdict.orbit / claims[0], verdict.multipliers / claims[1])
        said = verdict.wrong(point, TOL)
        if said:
            found.wrong.append(f"{place}: {said}")
    return found


def _verdict(case: Case | JointCase, point: per.Point) -> Verdict:
    if isinstance(case, Case):
        return judged(case.exact, point, case.names)
    return judged_joints(case.exact, point, case.states)


def read(files: list[Path]) -> dict[tuple[str, int], Row]:
    """Return the rows that files have, by kind and seed; later ones replace earlier ones."""
    lines = [line for file in files if file.exists() for line in file.read_text("utf-8").splitlines()]
    rows = [
        Row(**{k: tuple(v) if isinstance(v, list) else v for k, v in json.loads(n).items()}) for n in lines
    ]
    return {(row.kind, row.seed): row for row in rows}


def write(file: Path, row: Row) -> None:
    """Append a row to a file."""
    with file.open("a", encoding="utf-8") as rows:
        rows.write(json.dumps(asdict(row)) + "\n")
