"""Section of the report: the aims for speed, measured in one run beside other tools."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from reports import benchmarks
from reports.benchmarks import others
from reports.benchmarks.others import ONE_THREAD
from reports.benchmarks.work import NTST
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.trade import aims_figures
from reports.studies.trade.aims_figures import TOOLS, Numbers
from reports.studies.trade.methods.names import power
from reports.studies.trade.words import seconds

AUTO = "AUTO-07p by bifpy, ntst 50"
DISC, CHAIN = "disc iteration", "chain iteration"
STANDARD, DUFFING = "disc branch, standard", "Duffing A branch"
ITSELF, WHOLE = "AUTO-07p itself, ", "oscillators"
CHAINS = (WHOLE, "with clearances")
ALIKE = 1e-10
"""Error of the folds up to which Duffing A counts as accurate as AUTO has it."""

MACHINE = "machine"
PACKAGES = tuple(others.PACKAGES.values())

FILES = tuple(
    str(Path(benchmarks.__file__).with_name(f"bench_{name}.py"))
    for name in ("branches", "iterations", "processes", "peers")
)
"""The benchmarks that the aims are about."""

STATED = {"per point ms": 1.0, "s": 0.24}
"""AUTO's times where it is not installed, from a run of its own Fortran driver."""


@dataclass(frozen=True, kw_only=True)
class Result:
    """What a benchmark gave, or in words why it was left out."""

    name: str
    numbers: Numbers = field(default_factory=dict)
    skipped: str = ""

    def kept(self) -> dict[str, Any]:
        """Return what is kept of it."""
        return asdict(self)


@dataclass(frozen=True)
class Aim:
    """A number that is to be at most `limit`; `shown` puts both in words."""

    what: str
    found: float
    limit: float
    shown: Callable[[float], str]

    @property
    def cells(self) -> tuple[str, ...]:
        """A row of the table."""
        ratio = f"{self.found / self.limit:.2f}"
        met = "yes" if self.found <= self.limit else "**no**"
        return self.what, self.shown(self.limit), self.shown(self.found), ratio, met


def compute(tell: Tell) -> Found:
    """Run all benchmarks, one after the other."""
    tell("the benchmarks")
    rows = results(benchmarked())
    numbers = {f"{r.name}: {quantity}": value for r in rows for quantity, value in r.numbers.items()}
    figures = {"aims": aims_figures.growth(by_name(rows)), "peers": aims_figures.peers(compared(rows))}
    return Found(numbers=numbers, rows=[row.kept() for row in rows], figures=figures)


def benchmarked() -> dict[str, Any]:
    """Return the record of a run of the benchmarks, in a process of its own."""
    with TemporaryDirectory() as folder:
        record = Path(folder) / "record.json"
        options = ("--benchmark-timer=time.process_time", f"--benchmark-json={record}")
        command = [sys.executable, "-m", "pytest", "-q", *FILES, *options]
        subprocess.run(command, check=True, stdout=sys.stderr, env=os.environ | ONE_THREAD)
        read: dict[str, Any] = json.loads(record.read_text("utf-8"))
        return read


def results(record: Mapping[str, Any]) -> list[Result]:
    """Return what a record has: machine, results by name, what was left out, the peers' versions."""
    cpu, found = record["machine_info"]["cpu"], dict[str, Numbers]()
    for benchmark in record["benchmarks"]:
        name, numbers = _numbers(benchmark)
        found[name] = found.get(name, {}) | numbers
    place = f"{cpu['brand_raw']}, {cpu['count']} cores, load {record['load']:.1f} when it ended"
    return [
        Result(name=MACHINE, skipped=place),
        *(Result(name=name, numbers=numbers) for name, numbers in found.items()),
        *(Result(name=name, skipped=why) for name, why in record["skipped"].items()),
        *(Result(name=f"version of {name}", skipped=record["versions"][name]) for name in PACKAGES),
    ]


def _numbers(benchmark: Mapping[str, Any]) -> tuple[str, Numbers]:
    """Return the name and numbers of a benchmark: of a branch, of iterations, of a process, of memory."""
    group, what, told = benchmark["group"], benchmark["param"], benchmark["extra_info"]
    time = benchmark["stats"]["median"]
    if "points" in told:
        return what or group, {"s": time, **told, "per point ms": 1e3 * time / told["points"]}
    if "linearised" in told:
        return group, {f"{what} ms": 1e3 * time / told["linearised"]}
    return group, told or {f"{what} s": time}


def by_name(rows: Sequence[Result]) -> dict[str, Numbers]:
    """Return the numbers of what was run."""
    return {r.name: r.numbers for r in rows if r.numbers}


def aims(n: Mapping[str, Numbers]) -> list[Aim]:
    """Return the aims with what was found."""
    auto = n.get(f"{ITSELF}ntst 50", n.get(AUTO, STATED))
    own = alike(n)
    disc, chain, start = n[DISC], n[CHAIN], n["start"]
    return [
        Aim(f"{own}, per point; AUTO's time at ntst 50", n[own]["per point ms"], auto["per point ms"], _ms),
        Aim(f"{own}, whole; half of AUTO's", n[own]["s"], auto["s"] / 2, seconds),
        Aim("disc branch, 500 to 100 rev/min, `standard`", n[STANDARD]["s"], 0.3, seconds),
        Aim("disc, Newton iteration at ntst 100, ncol 4", disc["ntst 100 ms"], 0.7, _ms),
        Aim("chain of 50 (n = 100), iteration at ntst 20", chain["50 oscillators ms"], 60.0, _ms),
        Aim("power of ntst that the cost grows with", in_ntst(disc), 1.0, _power),
        Aim("power of n that the cost grows with", in_states(chain), 3.0, _power),
        Aim("`import periodic, symbolic`", start["import s"], 0.6, seconds),
        Aim("`orbitrace --help`", start["help s"], 0.4, seconds),
        Aim(
            "first `orbitrace trace` of a disc, process and files included",
            start["first trace s"],
            3.0,
            seconds,
        ),
    ]


def alike(n: Mapping[str, Numbers]) -> str:
    """Return the quickest branch of Duffing A whose folds are as accurate as AUTO's."""
    own = [name for name in n if name.startswith(DUFFING) and n[name]["fold error"] <= ALIKE]
    return min(own, key=lambda name: n[name]["s"])


def in_ntst(disc: Numbers) -> float:
    """Return the power of ntst that the cost of an iteration grows with from 100 intervals on."""
    counts = [c for c in NTST if c >= 100]
    return _exponent(counts, [disc[f"ntst {c} ms"] for c in counts])


def in_states(chain: Numbers) -> float:
    """Return the power of n that it grows with between the two longest chains."""
    counts = [50, 100]
    return _exponent(counts, [chain[f"{c} oscillators ms"] for c in counts])


def _exponent(counts: Sequence[float], times: Sequence[float]) -> float:
    return float(np.polyfit(np.log(counts), np.log(times), 1)[0])


def compared(rows: Sequence[Result]) -> dict[str, Numbers]:
    """Return who traced Duffing A, both folds included."""
    return {name: numbers for name, numbers in by_name(rows).items() if name.startswith(TOOLS)}


def chains(n: Mapping[str, Numbers]) -> list[tuple[str, ...]]:
    """Return a row for each chain: points and times of AUTO, measured or as recorded, and of ours."""
    found: list[tuple[str, ...]] = []
    for name, own in n.items():
        if not name.endswith(CHAINS) or name.startswith(ITSELF):
            continue
        auto = n.get(f"{ITSELF}{name}", {key: own.get(f"AUTO {key}", np.nan) for key in ("points", "s")})
        known = not np.isnan(auto["s"])
        theirs = f"{auto['points']:.0f}, {seconds(auto['s'])}" if known else "not run"
        ratio = f"{own['s'] / auto['s']:.2f}" if known and name.endswith(WHOLE) else "-"
        found.append((name, theirs, f"{own['points']:.0f}, {seconds(own['s'])}", ratio))
    return found


def context(kept: Kept) -> Mapping[str, Any]:
    """Return what the template is given."""
    rows = [Result(**row) for row in kept.rows]
    numbers, said = by_name(rows), {r.name: r.skipped for r in rows if r.skipped}
    return {
        "aims": [aim.cells for aim in aims(numbers)],
        "memory": numbers["memory"],
        "chains": chains(numbers),
        "machine": said.get(MACHINE, "not known"),
        "beside": [_cells(name, own, said) for name, own in compared(rows).items()],
        "missing": {name: why for name, why in said.items() if name.startswith(TOOLS)},
    }


def _cells(name: str, n: Numbers, said: Mapping[str, str]) -> tuple[str, ...]:
    package = next((p for p in PACKAGES if p.partition("-")[0].lower() in name.lower()), None)
    version = said.get(f"version of {package}", "not known")
    label = name.replace(DUFFING, "orbitrace") if package is None else f"{name} ({package} {version})"
    error = power(n["fold error"]) if "fold error" in n else "not reached"
    multipliers = "no" if package in ("pyHarm-os", "bice") else "yes"
    whole = seconds(n["s"]) if "fold error" in n else "-"
    return label, f"{n['points']:.0f}", whole, _ms(n["per point ms"]), error, multipliers


def _ms(value: float) -> str:
    return seconds(value / 1e3)


def _power(value: float) -> str:
    return f"{value:.2f}"


SECTION = Section(title="Aims, beside other tools", compute=compute, context=context)
