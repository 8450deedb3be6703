"""Are curves and peaks of machines' branches right between the points? Each is traced again with short steps.

    python -m survey.machines.curves [--share 0/2] [--seeds 3] [--seconds 60]

A line tells of a machine how far the curves of its coordinates are from orbits of a branch of short steps, in
parts of their ranges; how many turns of those have no peak (PK); the CPU time in that without peaks; and the
part of it until the first orbit.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass

import numpy as np
from scipy.signal import find_peaks
from support.drawn.machines.drawn import FAMILIES, machine

import periodic as per
import symbolic as sym
from periodic.results.peaks import PEAK_OF
from reports.studies.extremes.survey import within

SHORT = 0.01
"""Arclength of the steps that the curves are compared with."""

HIGH = 1e-3
"""Least height of a turn that is to have a peak, in parts of the range of its coordinate."""

NEAR = 2.0
"""Largest distance of a peak from the turn, in the distances of neighbours there."""


@dataclass(frozen=True)
class Compared:
    """What is told of a machine: see above."""

    points: int
    off: float
    lacking: int
    time: float
    first: float

    def __str__(self) -> str:
        told = f"{self.points} points, curve off by {self.off:.1e}, {self.lacking} peaks lacking"
        return f"{told}, {self.time:.2f} of the time without, first orbit {self.first:.3f} of it"


def away(fine: per.Branch, branch: per.Branch, name: str) -> float:
    """Return the largest distance of points from the curve of another branch, in ranges of a coordinate."""
    x, y = branch.curve(f"{name} p-p", each=64)
    spans = np.ptp(x), max(float(np.ptp(y)), 1e-6 * float(y.max()))
    line, points = _plane(x, y, spans), _plane(fine.values, fine.peak_to_peak(name), spans)
    begin, way = line[:-1], np.diff(line, axis=0)
    size = np.maximum(np.sum(way**2, axis=1), 1e-300)
    return max(_distance(point, begin, way, size) for point in points)


def _plane(x: np.ndarray, y: np.ndarray, spans: tuple[float, float]) -> np.ndarray:
    return np.column_stack([x / spans[0], y / spans[1]])


def _distance(point: np.ndarray, begin: np.ndarray, way: np.ndarray, size: np.ndarray) -> float:
    place = np.clip(np.sum((point - begin) * way, axis=1) / size, 0, 1)
    return float(np.hypot(*(begin + place[:, None] * way - point).T).min())


def lacking(fine: per.Branch, branch: per.Branch, name: str) -> list[float]:
    """Return where a coordinate's peak to peak turns on a branch of short steps, and another has no peak."""
    x, y = fine.values, fine.peak_to_peak(name)
    least = HIGH * float(np.ptp(y))
    if not least > 1e-6 * float(y.max()):
        return []
    places = np.array([p.parameter for p in branch.peaks[PEAK_OF + name]])
    turns = sorted(k for sign in (1, -1) for k in find_peaks(sign * y, prominence=least)[0])
    reach = [NEAR * float(np.ptp(x[k - 1 : k + 2])) for k in turns]
    near = [np.abs(places - x[k]).min(initial=np.inf) <= far for k, far in zip(turns, reach, strict=True)]
    return [float(x[k]) for k, found in zip(turns, near, strict=True) if not found]


def compared(family: str, seed: int) -> Compared | per.Stop:
    """Return what is told of a machine of the survey; of one without a branch why it has none."""
    drawn = machine(family, seed)
    system = sym.compile(drawn.model)

    def traced(**settings: object) -> tuple[per.Branch, float]:
        begun = time.process_time()
        branch = per.trace(system, drawn.parameter, drawn.bounds, **settings)
        return branch, time.process_time() - begun

    none = per.Watch(peaks={})
    branch, _ = traced()  # expressions are made here, too
    if not branch.points:
        return branch.stop
    _, first = traced(control=per.ArclengthControl(max_points=1))
    _, whole = traced()
    _, without = traced(watch=none)
    fine, _ = traced(watch=none, control=per.ArclengthControl(ds=SHORT, ds_max=SHORT, max_points=20000))
    names = [name.removeprefix(PEAK_OF) for name in branch.peaks]
    off = max(away(fine, branch, name) for name in names)
    gone = sum(len(lacking(fine, branch, name)) for name in names)
    return Compared(len(branch), off, gone, whole / without, first / whole)


def main() -> int:
    """Print a line a machine; of one that takes too long or is not traced, that it is so."""
    raw = argparse.RawDescriptionHelpFormatter
    name = "python -m survey.machines.curves"
    parser = argparse.ArgumentParser(name, description=__doc__, formatter_class=raw)
    parser.add_argument("--share", default="0/1", help="which part of the machines: 0/2 and 1/2 are all")
    parser.add_argument("--seeds", type=int, default=3, help="machines of a family")
    parser.add_argument("--seconds", type=float, default=60.0, help="CPU time that a machine may take")
    given = parser.parse_args()
    part, parts = map(int, given.share.split("/"))
    machines = [(family, seed) for seed in range(given.seeds) for family in FAMILIES]
    for family, seed in machines[part::parts]:
        try:
            with within(given.seconds):
                told = str(compared(family, seed))
        except (KeyboardInterrupt, per.Interrupted):
            told = f"more than {given.seconds:g} s"
        print(f"{family} {seed}: {told}", flush=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
