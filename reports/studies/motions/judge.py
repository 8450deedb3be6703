"""A judge of motions that shares nothing with the engine: an integrator of its own, from very many starts."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import periodic as per
import symbolic as sym

NAMES = ("c", "k", "k3", "kg", "gap", "low", "F", "Omega")
"""Parameters of an oscillator, in the order of judge.c."""

PERIODS, STEPS, KEPT = 432, 200, 48
"""Periods that motions are followed, steps in each, and the last ones that are looked at, as in judge.c."""

SAME = 1e-3
"""Distance of two motions' states that are one, in the size of the box."""

SETTLED = 1e-5
"""The same of a motion's states some periods later, where it has come back."""

MOST = 6
"""Most periods after which a motion comes back."""

BOX = 3.0
"""Motions start at positions and speeds up to so much."""


@dataclass(frozen=True)
class Oscillator:
    """One of the random oscillators, by its seed."""

    seed: int

    @property
    def values(self) -> dict[str, float]:
        """Its parameters: stiff or soft or with two wells, with gaps or without."""
        random = np.random.default_rng(self.seed)
        wells = random.random() < 0.3
        return {
            "c": float(random.uniform(0.03, 0.25)),
            "k": -1.0 if wells else 1.0,
            "k3": 1.0 if wells or random.random() < 0.4 else 0.0,
            "kg": float(random.uniform(0.5, 20.0)) if random.random() < 0.7 else 0.0,
            "gap": float(random.uniform(0.3, 1.5)),
            "low": float(random.uniform(0.3, 1.5)),
            "F": float(random.uniform(0.05, 0.8)),
            "Omega": float(random.uniform(0.4, 2.5)),
        }

    def system(self) -> sym.CompiledSystem:
        """Its equations."""
        x, v = sym.coordinate("x"), self.values
        parts = [
            sym.Mass(x, 1.0),
            sym.Damper(x, v["c"]),
            sym.Spring(x, v["k"]),
            sym.CubicSpring(x, v["k3"]),
            sym.Gap(x, v["kg"], -v["low"], v["gap"]),
            sym.HarmonicForce(x, v["F"], v["Omega"]),
        ]
        return sym.compile(sym.combine(parts))

    def judged(self, starts: int, steps: int = STEPS) -> list[Attractor]:
        """What the judge finds from a number of random starts, the largest basins first."""
        random = np.random.default_rng(1000 + self.seed)
        y = random.uniform(-BOX, BOX, (starts, 2))
        sections = _followed(np.array([self.values[name] for name in NAMES]), y, steps)
        return _sorted(sections)


@dataclass(frozen=True)
class Attractor:
    """Where some of the starts lead: states (p, 2), p = 0 for what does not come back; their share."""

    periods: int
    states: Any
    share: float


def found(oscillator: Oscillator, starts: int = 256) -> per.phasespace.Motions:
    """What the engine finds."""
    box = {"x": (-BOX, BOX), "x'": (-BOX, BOX)}
    return per.motions(oscillator.system(), box=box, periods=MOST, starts=starts, places=32)


def missed(
    oscillator: Oscillator, motions: per.phasespace.Motions, judged: list[Attractor]
) -> list[Attractor]:
    """Attractors of the judge that are not among the motions found."""
    omega = oscillator.values["Omega"]
    units = np.array([1.0, omega])
    own = [(m.periods, m.sections * units) for m in motions.stable]
    return [each for each in judged if not any(_alike(each, *other) for other in own)]


def _alike(judged: Attractor, periods: int, sections: Any) -> bool:
    """Whether an attractor is a motion that was found."""
    if (judged.periods == 0) != (periods == 0):
        return False
    if periods == 0:
        apart = np.abs(judged.states[:, None] - sections[:2000]).max(axis=2).min(axis=1)
        return bool(np.quantile(apart, 0.9) < 0.1 * np.ptp(sections, axis=0).max())
    apart = np.abs(judged.states[:, None] - sections).max(axis=2).min(axis=1)
    return bool(judged.periods == periods and apart.max() < SAME * 2 * BOX)


def _sorted(sections: Any) -> list[Attractor]:
    """The attractors of motions (S, KEPT, 2) by what they are at the end; what does not come back is one."""
    total, left = len(sections), sections[np.isfinite(sections).all(axis=(1, 2))]
    found: list[Attractor] = []
    for periods in range(1, MOST + 1):
        back = np.abs(left[:, periods:] - left[:, :-periods]).max(axis=(1, 2)) < SETTLED
        found += _grouped(left[back, -periods:], total)
        left = left[~back]
    if len(left):
        found.append(Attractor(0, left[0], len(left) / total))
    return sorted(found, key=lambda attractor: -attractor.share)


def _grouped(states: Any, total: int) -> list[Attractor]:
    """The attractors of motions by their states (S, p, 2) of the last p periods."""
    found: list[Attractor] = []
    while len(states):
        known = states[0]
        apart = np.abs(states[:, :, None] - known).max(axis=3).min(axis=2).max(axis=1)
        own = apart < SAME * 2 * BOX
        found.append(Attractor(len(known), known, float(own.sum()) / total))
        states = states[~own]
    return found


def _followed(parameters: Any, y: Any, steps: int) -> Any:
    """Sections (S, KEPT, 2) of motions from y (S, 2), on two cores."""
    parts = np.array_split(y, 16)
    force = parameters[6] * np.cos(np.pi / steps * np.arange(2 * steps + 1))

    def one(part: Any) -> Any:
        part, sections = np.ascontiguousarray(part), np.empty((len(part), KEPT, 2))
        given = [a.ctypes.data_as(ctypes.c_void_p) for a in (parameters, force, part, sections)]
        _judge().settle(len(part), PERIODS, steps, *given)
        return sections

    with ThreadPoolExecutor(2) as pool:
        return np.concatenate(list(pool.map(one, parts)))


@cache
def _judge() -> Any:
    """The judge's integrator, compiled."""
    source = Path(__file__).with_name("judge.c")
    library = Path(tempfile.mkdtemp()) / "judge.so"
    subprocess.run(
        ["cc", "-O3", "-march=native", "-fPIC", "-shared", "-o", library, source, "-lm"], check=True
    )
    made = ctypes.CDLL(str(library))
    made.settle.argtypes, made.settle.restype = [ctypes.c_long] * 3 + [ctypes.c_void_p] * 4, None
    return made
